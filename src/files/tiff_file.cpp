// A file is a header, directories and data, in this order here: the main directory with the values of its fields that need more
// than four bytes, that of the exposure, the pixels.

#include "tiff_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "etendue/core/error.h"
#include "whole_file.h"

namespace etendue {

namespace {

enum Type : std::uint16_t {
  byte_type = 1,
  text_type = 2,
  short_type = 3,
  long_type = 4,
  rational_type = 5,
  signed_rational_type = 10
};

template <class T>
void append(std::vector<std::uint8_t>& bytes, T value) {
  for (size_t i = 0; i < sizeof value; ++i) bytes.push_back(std::uint8_t(std::uint64_t(value) >> (8 * i)));
}

template <class T>
std::vector<std::uint8_t> bytes_of(const std::vector<T>& values) {
  std::vector<std::uint8_t> bytes;
  for (const T value : values) append(bytes, value);
  return bytes;
}

/// Numerators and denominators. The denominator is the largest power of ten for which both have 31 bits.
template <class T>
std::vector<std::uint8_t> fractions_of(const std::vector<double>& values) {
  std::vector<std::uint8_t> bytes;
  constexpr double most = 2147483647;
  for (double x : values) {
    if (!(x == x)) x = 0;
    x = std::clamp(x, std::numeric_limits<T>::is_signed ? -most : 0.0, most);
    double denominator = 1e9;
    while (std::abs(x) * denominator > most) denominator /= 10;
    append(bytes, T(std::llround(x * denominator)));
    append(bytes, T(denominator));
  }
  return bytes;
}

}  // namespace

void TiffFields::add(std::uint16_t tag, std::uint16_t type, size_t count, std::vector<std::uint8_t> data) {
  fields_.push_back({tag, type, std::uint32_t(count), std::move(data)});
}
void TiffFields::add_bytes(std::uint16_t tag, const std::vector<std::uint8_t>& values) {
  add(tag, byte_type, values.size(), values);
}
void TiffFields::add_text(std::uint16_t tag, const std::string& text) {
  std::vector<std::uint8_t> bytes(text.begin(), text.end());
  bytes.push_back(0);
  add(tag, text_type, bytes.size(), bytes);
}
void TiffFields::add_shorts(std::uint16_t tag, const std::vector<std::uint16_t>& values) {
  add(tag, short_type, values.size(), bytes_of(values));
}
void TiffFields::add_longs(std::uint16_t tag, const std::vector<std::uint32_t>& values) {
  add(tag, long_type, values.size(), bytes_of(values));
}
void TiffFields::add_rationals(std::uint16_t tag, const std::vector<double>& values) {
  add(tag, rational_type, values.size(), fractions_of<std::uint32_t>(values));
}
void TiffFields::add_signed_rationals(std::uint16_t tag, const std::vector<double>& values) {
  add(tag, signed_rational_type, values.size(), fractions_of<std::int32_t>(values));
}

class TiffWriter {
 public:
  /// The bytes of a directory that begins at `offset` of the file, and of the values that its fields point to.
  static std::vector<std::uint8_t> directory(TiffFields& given, size_t offset) {
    std::vector<TiffFields::Field>& fields = given.fields_;
    std::ranges::sort(fields, {}, &TiffFields::Field::tag);
    std::vector<std::uint8_t> bytes, values;
    const size_t values_at = offset + 2 + 12 * fields.size() + 4;
    append(bytes, std::uint16_t(fields.size()));
    for (const TiffFields::Field& field : fields) {
      append(bytes, field.tag);
      append(bytes, field.type);
      append(bytes, field.count);
      std::vector<std::uint8_t> inside = field.data;
      if (inside.size() > 4) {
        inside.clear();
        append(inside, std::uint32_t(values_at + values.size()));
        values.insert(values.end(), field.data.begin(), field.data.end());
        if (values.size() % 2) values.push_back(0);  // values begin at even offsets
      }
      inside.resize(4);
      bytes.insert(bytes.end(), inside.begin(), inside.end());
    }
    append(bytes, std::uint32_t(0));  // no further directory
    bytes.insert(bytes.end(), values.begin(), values.end());
    return bytes;
  }
};

void write_tiff(const std::string& path, int width, int height, int samples_per_pixel, std::span<const std::uint16_t> samples,
                TiffFields fields, const TiffFields& exif) {
  constexpr size_t header_size = 8;
  constexpr std::uint16_t exif_tag = 34665, strip_offsets_tag = 273;
  const size_t pixel_bytes = 2 * samples.size();
  fields.add_longs(256, {std::uint32_t(width)});
  fields.add_longs(257, {std::uint32_t(height)});
  fields.add_shorts(258, std::vector<std::uint16_t>(size_t(samples_per_pixel), 16));  // bits
  fields.add_shorts(259, {1});                                                        // no compression
  fields.add_shorts(277, {std::uint16_t(samples_per_pixel)});
  fields.add_longs(278, {std::uint32_t(height)});  // rows of the only strip
  fields.add_longs(279, {std::uint32_t(pixel_bytes)});
  fields.add_shorts(284, {1});  // samples of a pixel side by side

  // The size of the main directory does not depend on the offsets in it: it is made twice.
  const auto laid_out = [&](size_t exif_at, size_t pixels_at) {
    TiffFields all = fields;
    all.add_longs(strip_offsets_tag, {std::uint32_t(pixels_at)});
    if (!exif.empty()) all.add_longs(exif_tag, {std::uint32_t(exif_at)});
    return TiffWriter::directory(all, header_size);
  };
  const size_t exif_at = header_size + laid_out(0, 0).size();
  TiffFields circumstances = exif;
  const std::vector<std::uint8_t> second =
      exif.empty() ? std::vector<std::uint8_t>() : TiffWriter::directory(circumstances, exif_at);
  const size_t pixels_at = exif_at + second.size();
  if (pixels_at + pixel_bytes > std::numeric_limits<std::uint32_t>::max())
    throw Error("cannot write '" + path + "': a TIFF file holds 4 GB at most");

  std::vector<std::uint8_t> start = {'I', 'I', 42, 0};
  append(start, std::uint32_t(header_size));
  const std::vector<std::uint8_t> first = laid_out(exif_at, pixels_at);
  std::vector<std::uint8_t> pixels;
  pixels.reserve(pixel_bytes);
  for (const std::uint16_t sample : samples) append(pixels, sample);
  const std::array<std::span<const std::byte>, 4> pieces = {std::as_bytes(std::span(start)), std::as_bytes(std::span(first)),
                                                            std::as_bytes(std::span(second)), std::as_bytes(std::span(pixels))};
  write_whole_file(path, pieces);
}

}  // namespace etendue
