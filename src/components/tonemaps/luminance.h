#pragma once
// Helpers of tone maps: the luminance that becomes white, and changes of luminance that keep the chromaticity.

#include <algorithm>
#include <cmath>
#include <vector>

#include "etendue/core/image.h"

namespace etendue {

/// The positive, finite luminances Y of a picture X Y Z, unordered.
inline std::vector<double> positive_luminances(const Image& xyz) {
  std::vector<double> all;
  all.reserve(xyz.values.size() / 3);
  for (size_t i = 1; i < xyz.values.size(); i += 3)
    if (xyz.values[i] > 0 && std::isfinite(xyz.values[i])) all.push_back(xyz.values[i]);
  return all;
}

/// The index of a percentile among `count` values in increasing order: of the smallest value that at least this percentage of
/// the values do not exceed.
inline size_t rank_of(size_t count, double percent) {
  return size_t(std::clamp(std::ceil(percent / 100 * double(count)) - 1, 0.0, double(count - 1)));
}

/// The smallest of the values that at least this percentage of them do not exceed; 0 for no values. Reorders them.
inline double percentile_of(std::vector<double>& values, double percent) {
  if (values.empty()) return 0;
  const size_t i = rank_of(values.size(), percent);
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(i), values.end());
  return values[i];
}

/// The luminance that becomes white: this percentile of the luminances above zero. 0 for a black picture.
inline double white_luminance(const Image& xyz, double percent) {
  std::vector<double> all = positive_luminances(xyz);
  return percentile_of(all, percent);
}

/// Replaces each luminance Y by f(Y / white) and scales X and Z by the same factor, so that chromaticities are kept. Pixels
/// without positive luminance become black.
template <class F>
void map_luminance(Image& xyz, double white, F&& f) {
  for (size_t i = 0; i + 2 < xyz.values.size(); i += 3) {
    double* v = &xyz.values[i];
    const double scale = white > 0 && v[1] > 0 && std::isfinite(v[1]) ? f(v[1] / white) / v[1] : 0;
    for (int c = 0; c < 3; ++c) v[c] = scale != 0 ? scale * v[c] : 0;
  }
}

}  // namespace etendue
