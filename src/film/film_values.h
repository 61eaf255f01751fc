#pragma once
// The values that a film stores for each pixel: as plain numbers (of the current step, and for development), and as exact sums.

#include <array>

#include "core/over_range.h"
#include "etendue/film/film.h"
#include "exact_sums.h"
#include "picture_format.h"

namespace etendue {

/// The values of each pixel, in separate lists; lists that a render does not use stay empty.
enum List : std::uint8_t {
  light_list,  ///< filtered X, Y, Z of samples, and filtered Y^2
  splat_list,  ///< filtered X, Y, Z of splats, and the squared Y of all splats of one sample
  part_list,   ///< X, Y, Z for each path length, then for each light group, and then the bands (PictureFormat::triples)
  part_splat_list,
  weight_list,  ///< the weight of samples minus their number
  batch_list,   ///< squares of steps' means, times their samples (Estimator::correlated)
  list_count
};
using Lists = std::array<std::vector<double>, list_count>;

/// Values per pixel in a list.
inline size_t list_stride(List list, const PictureFormat& format) {
  constexpr std::array<size_t, list_count> strides = {4, 4, 3, 3, 1, 1};
  return strides[list] * (list == part_list || list == part_splat_list ? format.triples() : 1);
}

/// Values of a list that are summed as one group of an ExactSums; a list may hold several groups side by side.
struct Plane {
  List list;
  size_t offset, group;
};
inline constexpr std::array<Plane, 8> planes = {{{light_list, 0, 3},
                                                 {light_list, 3, 1},
                                                 {splat_list, 0, 3},
                                                 {splat_list, 3, 1},
                                                 {part_list, 0, 3},
                                                 {part_splat_list, 0, 3},
                                                 {weight_list, 0, 1},
                                                 {batch_list, 0, 1}}};
/// Whether a plane is stored. Squares of correlated samples give no variance, so they are not.
inline bool kept(const Plane& plane, Estimator estimator) {
  return estimator == Estimator::independent || !((plane.list == light_list || plane.list == splat_list) && plane.group == 1);
}
/// Consecutive groups of a pixel: one for each part of the light and for three bands, or one.
inline size_t groups_per_pixel(const Plane& plane, const PictureFormat& format) {
  return plane.list == part_list || plane.list == part_splat_list ? format.triples() : 1;
}

/// Counters, and values that are chosen by the order of pixels and samples: exact in any order of addition.
struct FilmCounts {
  std::vector<std::uint32_t> samples;  ///< per pixel
  std::uint64_t paths = 0, bad_count = 0;
  std::vector<BadSample> bad;  ///< the first ones, sorted
  static constexpr size_t bad_kept = 32;

  void add(const FilmCounts&);
  /// Throws Error if a pixel would have too many samples.
  void require_room_for(const FilmCounts&) const;
  void add_bad(const std::vector<BadSample>&);
};

/// The film's values as plain numbers.
struct FilmSnapshot::Values {
  std::shared_ptr<const PictureFormat> format;
  Estimator estimator = Estimator::independent;
  Lists lists;
  FilmCounts counts;
  std::uint64_t steps = 0;

  /// The sum of the sample weights of a pixel.
  double weight(size_t pixel) const {
    const auto& more = lists[weight_list];
    return double(counts.samples[pixel]) + (more.empty() ? 0 : more[pixel]);
  }
  /// Whether that sum is the same for all pixels, as for all our renderers.
  bool even() const;
  /// The factors by which sums of a pixel are multiplied.
  struct Scales {
    double light = 0, splat = 0;
    PictureFormat::Integral filter;
  };
  Scales scales(int x, int y, bool even) const;
  double luminance(size_t pixel, const Scales&) const;
  /// The variance of the developed luminance.
  double variance(size_t pixel, const Scales&) const;

 private:
  double variance_of_samples(size_t pixel, const Scales&) const;
  double variance_of_splats(size_t pixel, const Scales&) const;
  double variance_of_steps(size_t pixel, const Scales&) const;
};

/// The exact sums of whole steps.
struct Film::Totals {
  std::array<ExactSums, planes.size()> sums;
  FilmCounts counts;
  std::uint32_t steps = 0;

  void add(const Totals&);
  void require_room_for(const Totals&) const;
};

}  // namespace etendue
