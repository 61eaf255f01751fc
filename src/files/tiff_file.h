#pragma once
// TIFF files of one uncompressed image of 16 bits (TIFF 6.0, Adobe 1992), with any further fields.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace etendue {

/// The fields of an image file directory. A field is a tag, a type and values.
class TiffFields {
 public:
  void add_bytes(std::uint16_t tag, const std::vector<std::uint8_t>& values);
  void add_text(std::uint16_t tag, const std::string& text);
  void add_shorts(std::uint16_t tag, const std::vector<std::uint16_t>& values);
  void add_longs(std::uint16_t tag, const std::vector<std::uint32_t>& values);
  /// With nine digits behind the decimal point, fewer for large numbers; negative ones become 0.
  void add_rationals(std::uint16_t tag, const std::vector<double>& values);
  void add_signed_rationals(std::uint16_t tag, const std::vector<double>& values);
  bool empty() const { return fields_.empty(); }

 private:
  friend class TiffWriter;
  struct Field {
    std::uint16_t tag, type;
    std::uint32_t count;
    std::vector<std::uint8_t> data;  // little endian
  };
  void add(std::uint16_t tag, std::uint16_t type, size_t count, std::vector<std::uint8_t> data);
  std::vector<Field> fields_;
};

/// Writes a file whose rows follow from top to bottom, samples of a pixel side by side. Adds the size, the number of bits and
/// samples, and where the pixels are; the photometric interpretation is left to `fields`. `exif`, if there are any, become the
/// directory for the circumstances of the exposure (Exif). Throws Error as write_whole_file does, and for files above 4 GB.
void write_tiff(const std::string& path, int width, int height, int samples_per_pixel, std::span<const std::uint16_t> samples,
                TiffFields fields, const TiffFields& exif = {});

}  // namespace etendue
