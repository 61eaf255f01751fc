#pragma once
// A choice among the texels of an image: by row, then within the row.

#include <cstdint>
#include <vector>

#include "etendue/core/vector.h"

namespace etendue {

/// Texels in proportion to their weight times the measure of their row (a solid angle, an area), by inverting the cumulative
/// distribution, which keeps neighbouring numbers together: a row by the second number, a texel of it by the first.
class TexelDistribution {
 public:
  /// `weights` row by row, none negative; `measures` [any unit] of a texel of each row.
  void build(const std::vector<float>& weights, size_t width, const std::vector<double>& measures);
  void clear() { *this = {}; }

  /// The sum of weights times measures; 0: there is nothing to choose.
  double total() const { return total_; }
  /// Probability over measure, per texel: that with which `choose` gives it, rounding included.
  float density(size_t x, size_t y) const { return share(rows_.data(), y) * share(&columns_[y * width_], x) / measures_[y]; }

  struct Choice {
    size_t x, y;
    Point2 within;  ///< uniform in the texel
    float density;  ///< the texel's
  };
  Choice choose(Point2 u) const;

 private:
  /// Cumulative probabilities of `count` things, and where to begin looking in them: entry k of the guide is the first that
  /// exceeds k / size (Chen & Asau 1974, "On generating random variates from an empirical distribution"). A search among
  /// thousands waits for memory at most of its steps; from there it is one or two.
  struct Guided {
    const float* cumulative;
    size_t count;
    const std::uint32_t* guide;
    size_t guides;
    size_t find(float& u) const;
  };
  static float share(const float* cumulative, size_t i) { return cumulative[i] - (i == 0 ? 0 : cumulative[i - 1]); }
  static void make_guide(const float* cumulative, size_t count, std::uint32_t* guide, size_t guides);
  static size_t guides_for(size_t count);

  size_t width_ = 0;
  double total_ = 0;
  std::vector<float> rows_, columns_;  ///< cumulative: of rows, and in each row of its texels
  std::vector<float> measures_;        ///< of a texel, by row
  std::vector<std::uint32_t> row_guide_, column_guides_;
};

}  // namespace etendue
