#pragma once
// ImageTile: accumulates the samples of a part of the image, in one thread and without locks (FilmTile in pbrt-v3, ImageBlock
// in Mitsuba).

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "etendue/core/spectrum.h"
#include "etendue/core/vector.h"
#include "etendue/film/image_buffer.h"

namespace etendue {

/// A sample that was not a finite non-negative spectrum; it counts as black.
struct BadSample {
  int x = 0, y = 0;
  std::uint32_t sample = 0;
  enum class Kind : std::uint8_t { not_a_number, infinite, negative } kind = Kind::not_a_number;
  /// By row, pixel, sample.
  bool operator<(const BadSample&) const;
};

/// A sample of large luminance: possibly a firefly.
struct LargeSample {
  double luminance = 0;  ///< Y of the sample's contribution
  int x = 0, y = 0;      ///< the pixel it belongs to
  std::uint32_t sample = 0;
  Point2 film;         ///< the film point of the contribution
  bool splat = false;  ///< the contribution is a splat of a light subpath
};

/// Used in a cycle: begin, add samples, merge into a Film (film.h).
class ImageTile {
 public:
  /// Empties the tile for samples of the pixels in an area (empty: for splats only); reuses its memory. `block` is 0, except in
  /// the default step of camera paths: a step of a crop covers many steps of the whole image, which are numbered as blocks and
  /// summed one after the other, so that the pixels of the crop equal those of the whole image to the bit.
  void begin(const ImageBuffer&, const PixelArea&, std::uint32_t block = 0);
  /// From now on keeps the n samples of largest luminance.
  void keep_largest(size_t count) { largest_wanted_ = count; }

  /// Adds a sample at a film point (in pixels; pixel centres are at half-integers) that belongs to the pixel (px, py). Bad
  /// values are noted and count as zero. `weight` is the number of samples that it counts for, apart from the filter f: a
  /// pixel's value is sum f weight value / E[sum f weight] (decision 013). `parts`, if given, holds the parts of the value for
  /// the image's layers: by path length, then by light group, in the order of PictureFormat.
  void contribute(Point2 film, int px, int py, std::uint32_t sample, const Spectrum&, const Wavelengths&, float weight = 1,
                  std::span<const Spectrum> parts = {});
  /// Adds a splat: a contribution at an arbitrary film point (light tracing), given as the contribution of one path to the mean
  /// radiance over the whole image. It adds f value W H / N to a pixel, where f is the filter at the pixel, W H the number of
  /// pixels of the whole image (also for a crop), and N the number of all counted paths (count_path). (px, py) and `sample`
  /// identify the sample (the splats of one sample must be added consecutively), `length` is the SplatLabel: the number of
  /// segments of the path, and its light group.
  void splat(Point2 film, int px, int py, std::uint32_t sample, const Spectrum&, const Wavelengths&, int length);
  /// Counts a sample path for splats. Must be called once for each path, including those without contribution.
  void count_path() { ++paths_; }

  /// Appends what it holds to the bytes, for the film of another process (Film::unpack).
  void pack(std::vector<std::byte>&) const;

 private:
  friend class Film;
  struct Splat {
    Point2 film;
    Xyz value;
    int length;
    bool same_path;  // of the same sample as the splat before
  };
  void note(const BadSample&);
  void note_large(const LargeSample&);
  static void keep_larger(std::vector<LargeSample>&, const LargeSample&, size_t most);
  void add_light(Point2 film, int px, int py, const Xyz&, float weight);
  void add_parts(Point2 film, int px, int py, const Wavelengths&, float weight, std::span<const Spectrum> parts);
  size_t own_pixel(int px, int py) const { return size_t(py - area_.y0) * size_t(area_.width()) + size_t(px - area_.x0); }

  std::shared_ptr<const PictureFormat> format_;
  std::uint32_t block_ = 0;
  PixelArea sampled_;          // the sampled pixels,
  PixelArea area_, extent_;    // those of them in the image, and all pixels of the image that the samples contribute to
  std::vector<double> light_;  // X Y Z and Y^2, weighted by the filter, per pixel of the extent
  bool lit_ = false;           // whether any value of light_ is not zero
  std::vector<double> parts_;  // X Y Z per part and the bands, per pixel of the extent; then of each splat (film/tile_values.h)
  std::vector<std::uint32_t> samples_;  // number of samples per pixel of the area
  std::vector<double> weights_;         // sum of (weight - 1) per pixel of the area; empty if all weights are 1
  std::vector<LargeSample> largest_;
  size_t largest_wanted_ = 0;
  std::vector<Splat> splats_;
  BadSample splat_path_;  // the sample of the last splat
  std::vector<BadSample> bad_;
  std::uint64_t bad_count_ = 0, paths_ = 0;
};

}  // namespace etendue
