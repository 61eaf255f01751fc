#pragma once
// ImageBuffer (a film): collects samples as CIE XYZ in double precision.

#include <array>
#include <span>

#include "etendue/core/image.h"
#include "etendue/core/spectrum.h"
#include "etendue/core/vector.h"
#include "etendue/describe/component.h"
#include "etendue/describe/description.h"
#include "etendue/filter.h"

namespace etendue {

/// Auxiliary layers a renderer may fill at the first surface a camera path meets.
struct Features {
  Vector3 albedo;   ///< linear sRGB
  Vector3 normal;   ///< unit, world
  float depth = 0;  ///< distance from the camera [m]; 0: nothing was met
  int object = 0;   ///< 1 + index of the object in the scene; 0: nothing
};

/// Pixel rectangle [x0, x1) x [y0, y1).
struct PixelArea {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  bool contains(int x, int y) const { return x >= x0 && x < x1 && y >= y0 && y < y1; }
  bool operator==(const PixelArea&) const = default;
};

/// A sample that was not a finite non-negative spectrum; it counts as black.
struct BadSample {
  int x = 0, y = 0;
  std::uint32_t sample = 0;
  enum class Kind : std::uint8_t { not_a_number, infinite, negative } kind = Kind::not_a_number;
};

/// A sample that brought much light to the picture: a firefly, perhaps.
struct LargeSample {
  double luminance = 0;  ///< Y of the radiance it brought
  int x = 0, y = 0;      ///< the pixel it belongs to
  std::uint32_t sample = 0;
  Point2 film;         ///< where the light fell
  bool splat = false;  ///< brought by a path from a luminaire
};

class ImageBuffer;

/// Samples of a part of the picture, collected by one thread without locks and merged into the buffer in a fixed order,
/// so that results do not depend on threads.
class ImageTile {
 public:
  /// Prepares for samples that fall into an area; keeps its memory.
  void begin(const ImageBuffer&, const PixelArea&);

  /// Adds a sample at a film point (pixels; centres at half-integers), in the pixel (px, py) it belongs to. Bad values
  /// are noted and count as zero.
  /// `weight` says for how many samples it counts, beside the filter.
  /// `by_length`, when given, holds the parts of the value by path length, for `ImageBuffer::path_lengths`.
  void contribute(Point2 film, int px, int py, std::uint32_t sample, const Spectrum&, const Wavelengths&, float weight = 1,
                  std::span<const Spectrum> by_length = {});
  /// Adds light that did not come through a pixel of its own (light tracing): what one path, of as many as there are
  /// samples, brings to the mean radiance over the whole picture. May lie anywhere in the picture. (px, py) and sample say
  /// which sample brought it, length how many segments its path had.
  void splat(Point2 film, int px, int py, std::uint32_t sample, const Spectrum&, const Wavelengths&, int length);
  /// The auxiliary values of a sample, when the buffer wants any.
  void features(int px, int py, const Features&);
  /// Counts the samples without light as well: call once for each sample path begun.
  void count_path() { ++paths_; }

 private:
  friend class ImageBuffer;
  void note(int x, int y, std::uint32_t sample, BadSample::Kind);
  struct Splat {
    Point2 film;
    Xyz value;
    int length;
  };
  void note_large(const LargeSample&);
  static void keep_larger(std::vector<LargeSample>&, const LargeSample&, size_t most);
  void add_lengths(Point2 film, int px, int py, const Wavelengths&, float weight, std::span<const Spectrum> by_length);
  const ImageBuffer* buffer_ = nullptr;
  PixelArea sampled_;        // the pixels whose samples these are,
  PixelArea area_, extent_;  // those of them that are in the picture, and all in the picture they count for
  // X Y Z by the filter, and the weight of the pixel's own samples, per pixel of the extent
  std::vector<double> sums_;
  std::vector<double> moments_;   // count, sum Y, sum Y^2 of the samples in each pixel of the area
  std::vector<double> features_;  // ImageBuffer::feature_values per pixel of the area
  std::vector<double> lengths_;   // X Y Z per path length and pixel of the extent
  std::vector<LargeSample> largest_;
  std::vector<Splat> splats_;
  std::vector<BadSample> bad_;
  std::uint64_t bad_count_ = 0, paths_ = 0;
};

class ImageBuffer : public Component {
 public:
  using Interface = ImageBuffer;
  using Parent = Component;
  static void describe(Description<ImageBuffer>&);
  ImageBuffer();
  ~ImageBuffer() override;

  int width = 512, height = 512;
  Ref<Filter> filter;
  std::vector<int> crop;            ///< x0, y0, x1, y1 [pixels]; empty: all
  std::vector<std::string> layers;  ///< of "albedo", "normal", "depth", "object", "variance", "samples"
  int path_lengths = 0;             ///< how many layers to keep by path length; the last holds all longer paths too

  void prepare() override;

  /// Empties the buffer for a new render.
  void clear();
  /// The pixels to be rendered.
  const PixelArea& area() const { return area_; }
  /// The pixels to take samples of: those, and around a crop as many as the filter reaches, so that its pixels are the same as
  /// in the whole picture.
  const PixelArea& sampled_area() const { return sampled_area_; }
  /// How many pixels to each side a sample anywhere in a pixel may count for.
  int reach() const;
  bool wants_features() const { return wants_features_; }
  bool wants(const std::string& layer) const;

  /// Adds a tile; the order of calls is part of the result.
  void merge(const ImageTile&);

  /// The picture as X Y Z, with the wanted layers as further channels.
  Image develop() const;
  /// Mean over pixels of the standard error of the mean of Y, relative to (Y + 1e-3 of the picture's mean): the measure
  /// for stopping at an error. Infinite before two samples a pixel.
  double relative_error() const;
  /// Samples taken so far, bad ones included.
  std::uint64_t samples() const { return samples_; }
  std::uint64_t bad_samples() const { return bad_count_; }
  /// The first bad samples, at most 32.
  const std::vector<BadSample>& first_bad_samples() const { return bad_; }

  /// From now on keeps the n samples that brought most light. Not part of the state.
  void keep_largest(size_t n) { largest_wanted_ = n; }
  /// Those, largest first.
  std::vector<LargeSample> largest_samples() const;

  /// All state, for checkpoints: the same bytes restore the same buffer. `load` throws Error when they do not fit.
  std::vector<std::byte> save_state() const;
  void load_state(std::span<const std::byte>);
  /// Adds what another buffer of the same picture has collected, of other samples.
  void add_state(std::span<const std::byte>);

 private:
  friend class ImageTile;
  // sums of albedo (3), normal (3), depth; how many had a depth; the first object; how many
  static constexpr size_t feature_values = 10, bad_samples_kept = 32;
  void allocate();
  void add_splat(const ImageTile::Splat&);
  void find_filter_shares();
  bool within_reach(int x, int y) const;
  double filter_over_film(int x, int y, bool times_samples) const;
  std::uint64_t filter_hash() const;
  static double variance_of_mean(const double* moment);
  double variance_of_pixel(size_t pixel) const;
  double splat_scale() const;
  double filter_integral() const;
  size_t index(int x, int y) const { return size_t(y - area_.y0) * size_t(area_.width()) + size_t(x - area_.x0); }

  PixelArea area_, sampled_area_;
  bool wants_features_ = false;
  int kept_lengths_ = 0;
  std::vector<double> sums_, moments_, features_;
  std::vector<double> splats_;                   // X Y Z and the sum of Y^2 per pixel
  std::vector<double> lengths_, length_splats_;  // X Y Z per path length and pixel
  std::vector<LargeSample> largest_;
  size_t largest_wanted_ = 0;
  std::uint64_t samples_ = 0, bad_count_ = 0;
  std::vector<BadSample> bad_;
  // the filter tabulated over one quadrant, weight at ((i + 0.5) / table_size * radius)
  static constexpr int table_size = 64;
  std::vector<float> filter_table_;
  // its integrals over the pixels around its own, over one quadrant of (filter_reach_ + 1)^2 pixels [pixel^2]
  std::vector<double> filter_shares_;
  int filter_reach_ = 0;
  float filter_radius_ = 0.5f;
  bool box_ = false;  // radius 0.5, constant: each sample counts for its own pixel alone
};

}  // namespace etendue
