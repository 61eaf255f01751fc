#pragma once
// What a film keeps for each pixel: as plain numbers (of the step at hand, and to develop), and as exact sums.

#include <array>

#include "core/over_range.h"
#include "etendue/film/film.h"
#include "exact_sums.h"
#include "picture_format.h"

namespace etendue {

/// The numbers of each pixel, in lists of their own: those a render has nothing for stay empty.
enum List : std::uint8_t {
  light_list,    ///< X, Y, Z and Y^2 of samples by the filter
  splat_list,    ///< X, Y, Z of splats by the filter, and the squared Y of all splats of a sample
  feature_list,  ///< albedo, normal, depth
  part_list,     ///< X, Y, Z for each path length, and then for each light group
  part_splat_list,
  weight_list,  ///< what samples count for beyond their number
  batch_list,   ///< squares of steps' means, times their samples (Estimator::correlated)
  list_count
};
using Lists = std::array<std::vector<double>, list_count>;

/// How many numbers a list has for each pixel.
inline size_t list_stride(List list, const PictureFormat& format) {
  constexpr std::array<size_t, list_count> strides = {4, 4, 7, 3, 3, 1, 1};
  return strides[list] * (list == part_list || list == part_splat_list ? format.parts() : 1);
}

/// Numbers of a list that are summed in groups; a list may hold several groups side by side.
struct Plane {
  List list;
  size_t offset, group;
};
inline constexpr std::array<Plane, 11> planes = {{{light_list, 0, 3},
                                                  {light_list, 3, 1},
                                                  {splat_list, 0, 3},
                                                  {splat_list, 3, 1},
                                                  {feature_list, 0, 3},
                                                  {feature_list, 3, 3},
                                                  {feature_list, 6, 1},
                                                  {part_list, 0, 3},
                                                  {part_splat_list, 0, 3},
                                                  {weight_list, 0, 1},
                                                  {batch_list, 0, 1}}};
/// Squares of samples say nothing where samples are correlated.
inline bool kept(const Plane& plane, Estimator estimator) {
  return estimator == Estimator::independent || !((plane.list == light_list || plane.list == splat_list) && plane.group == 1);
}
/// Groups that follow each other in a pixel: one for each part of the light, or one.
inline size_t groups_per_pixel(const Plane& plane, const PictureFormat& format) {
  return plane.list == part_list || plane.list == part_splat_list ? format.parts() : 1;
}

/// What is counted, or chosen by order of pixels and samples: exact in any order of adding.
struct FilmCounts {
  std::vector<std::uint32_t> samples;  ///< per pixel
  std::vector<FeatureCount> features;
  std::uint64_t paths = 0, bad_count = 0;
  std::vector<BadSample> bad;  ///< the first, sorted
  static constexpr size_t bad_kept = 32;

  void add(const FilmCounts&);
  /// Throws Error when a pixel would have too many samples.
  void require_room_for(const FilmCounts&) const;
  void add_bad(const std::vector<BadSample>&);
};

/// The film as plain numbers.
struct FilmSnapshot::Values {
  std::shared_ptr<const PictureFormat> format;
  Estimator estimator = Estimator::independent;
  Lists lists;
  FilmCounts counts;
  std::uint64_t steps = 0;

  /// How many samples a pixel counts for.
  double weight(size_t pixel) const {
    const auto& more = lists[weight_list];
    return double(counts.samples[pixel]) + (more.empty() ? 0 : more[pixel]);
  }
  /// Whether that is the same for all pixels, as all our renderers leave it.
  bool even() const;
  /// What sums of a pixel are multiplied by.
  struct Scales {
    double light = 0, splat = 0;
    PictureFormat::Integral filter;
  };
  Scales scales(int x, int y, bool even) const;
  double luminance(size_t pixel, const Scales&) const;
  /// Of luminance as developed.
  double variance(size_t pixel, const Scales&) const;

 private:
  double variance_of_samples(size_t pixel, const Scales&) const;
  double variance_of_splats(size_t pixel, const Scales&) const;
  double variance_of_steps(size_t pixel, const Scales&) const;
};

/// Exact sums of whole steps.
struct Film::Totals {
  std::array<ExactSums, planes.size()> sums;
  FilmCounts counts;
  std::uint32_t steps = 0;

  void add(const Totals&);
  void require_room_for(const Totals&) const;
};

}  // namespace etendue
