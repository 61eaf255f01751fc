#pragma once
// ImageTile: samples of a part of the picture, collected by one thread without locks.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "etendue/core/spectrum.h"
#include "etendue/core/vector.h"
#include "etendue/film/image_buffer.h"

namespace etendue {

/// Auxiliary layers a renderer may fill at the first surface a camera path meets.
struct Features {
  Vector3 albedo;   ///< linear sRGB
  Vector3 normal;   ///< unit, world
  float depth = 0;  ///< distance from the camera [m]; 0: nothing was met
  int object = 0;   ///< 1 + index of the object in the scene; 0: nothing
};

/// A sample that was not a finite non-negative spectrum; it counts as black.
struct BadSample {
  int x = 0, y = 0;
  std::uint32_t sample = 0;
  enum class Kind : std::uint8_t { not_a_number, infinite, negative } kind = Kind::not_a_number;
  /// By row, pixel, sample.
  bool operator<(const BadSample&) const;
};

/// A sample that brought much light to the picture: a firefly, perhaps.
struct LargeSample {
  double luminance = 0;  ///< Y of the radiance it brought
  int x = 0, y = 0;      ///< the pixel it belongs to
  std::uint32_t sample = 0;
  Point2 film;         ///< where the light fell
  bool splat = false;  ///< brought by a path from a luminaire
};

/// How many samples of a pixel had features.
struct FeatureCount {
  std::uint32_t samples = 0, hits = 0;  ///< all of them, and those with a depth
  std::uint32_t first = ~0u;            ///< the least of them,
  std::int32_t object = 0;              ///< and what that met
  void add(const FeatureCount&);
};

/// Begun, filled and merged into a Film (film.h), again and again.
class ImageTile {
 public:
  /// Prepares for samples that fall into an area (empty: for splats alone); keeps its memory. `block`: 0, but for the default
  /// step of camera paths. (A step of a crop covers many steps of the whole picture; they are told apart as blocks and summed
  /// one after the other, so that its pixels are those of the whole picture to the bit.)
  void begin(const ImageBuffer&, const PixelArea&, std::uint32_t block = 0);
  /// From now on keeps the n samples that brought most light.
  void keep_largest(size_t n) { largest_wanted_ = n; }

  /// Adds a sample at a film point (pixels; centres at half-integers), in the pixel (px, py) it belongs to. Bad values
  /// are noted and count as zero.
  /// `weight` says for how many samples it counts, beside the filter: a pixel is sum f weight value / sum f weight.
  /// `parts`, when given, holds the parts of the value for the picture's layers: by path length, then by
  /// light group, as PictureFormat counts them.
  void contribute(Point2 film, int px, int py, std::uint32_t sample, const Spectrum&, const Wavelengths&, float weight = 1,
                  std::span<const Spectrum> parts = {});
  /// Adds light that did not come through a pixel of its own (light tracing): what one path brings to the mean radiance over
  /// the whole picture. To a pixel it brings f value W H / N, with f the filter there, W H the pixels of the whole picture, of
  /// a crop too, and N all the paths that were counted (count_path). May lie anywhere in the picture. (px, py) and sample say
  /// which sample brought it (those of one sample come one after the other), length how many segments its path had.
  void splat(Point2 film, int px, int py, std::uint32_t sample, const Spectrum&, const Wavelengths&, int length);
  /// The auxiliary values of a sample, when the picture wants any.
  void features(int px, int py, std::uint32_t sample, const Features&);
  /// Counts the samples without light as well: call once for each sample path begun.
  void count_path() { ++paths_; }

 private:
  friend class Film;
  static constexpr size_t feature_values = 7;  // sums of albedo (3), normal (3), depth
  struct Splat {
    Point2 film;
    Xyz value;
    int length;
    bool same_path;  // as the splat before
  };
  void note(const BadSample&);
  void note_large(const LargeSample&);
  static void keep_larger(std::vector<LargeSample>&, const LargeSample&, size_t most);
  void add_light(Point2 film, int px, int py, const Xyz&, float weight);
  void add_parts(Point2 film, int px, int py, const Wavelengths&, float weight, std::span<const Spectrum> parts);
  size_t own_pixel(int px, int py) const { return size_t(py - area_.y0) * size_t(area_.width()) + size_t(px - area_.x0); }

  std::shared_ptr<const PictureFormat> format_;
  std::uint32_t block_ = 0;
  PixelArea sampled_;                   // the pixels whose samples these are,
  PixelArea area_, extent_;             // those of them that are in the picture, and all in the picture they count for
  std::vector<double> light_;           // X Y Z and Y^2 by the filter, per pixel of the extent
  bool lit_ = false;                    // whether any of it is not zero
  std::vector<double> parts_;           // X Y Z per part and pixel of the extent
  std::vector<std::uint32_t> samples_;  // in each pixel of the area
  std::vector<double> weights_;         // what they count for beyond their number, when they do
  std::vector<double> features_;        // feature_values per pixel of the area
  std::vector<FeatureCount> feature_counts_;
  std::vector<LargeSample> largest_;
  size_t largest_wanted_ = 0;
  std::vector<Splat> splats_;
  BadSample splat_path_;  // the sample of the last splat
  std::vector<BadSample> bad_;
  std::uint64_t bad_count_ = 0, paths_ = 0;
};

}  // namespace etendue
