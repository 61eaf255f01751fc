#pragma once
// TexelDistribution: sampling of an image's texels, first a row, then a texel within the row.

#include <algorithm>
#include <cstddef>
#include <vector>

#include "etendue/core/math.h"
#include "etendue/core/vector.h"

namespace etendue {

/// Samples texels in proportion to their weight times the measure of their row (a solid angle, an area), by inversion of CDFs,
/// which preserves the stratification of the samples: the second number chooses a row, the first a texel of this row.
class TexelDistribution {
 public:
  /// `weights` are row by row, none negative; `measures` [any unit] are those of a texel of each row.
  void build(const std::vector<float>& weights, size_t width, const std::vector<double>& measures);
  void clear() { *this = {}; }

  /// The sum of weights times measures; 0: no texel can be chosen.
  double total() const { return total_; }
  /// The probability that `choose` returns a texel, over the texel's measure; computed from the rounded CDFs that `choose`
  /// uses.
  float pdf(size_t x, size_t y) const { return rows_.share(0, y) * columns_.share(y, x) / measures_[y]; }
  /// The inverse of `choose`: the point of the unit square that gives this texel and the point within it.
  Point2 place(size_t x, size_t y, Point2 within) const {
    return {columns_.place(y, x, within.x), rows_.place(0, y, within.y)};
  }
  /// Prefetches the memory that `pdf` will read.
  void prefetch(size_t x, size_t y) const { columns_.prefetch(y, x); }

  struct Choice {
    size_t x, y;
    Point2 within;  ///< uniform in the texel
    float pdf;      ///< of the texel, per measure
  };
  Choice choose(Point2 u) const;

 private:
  /// The CDFs of several lists with the same number of entries, in nodes of sixteen entries: a cache line. The nodes of each
  /// upper level hold the last entry of every node below, up to a single root (a B-tree). For a large image only the lowest
  /// level exceeds the cache, so a search has one cache miss, and the search within a node has no branches.
  class Searched {
   public:
    Searched() = default;
    Searched(size_t lists, size_t count);
    /// Sets the CDF at entry i of a list. The entries of a list must be set in increasing order.
    void set(size_t list, size_t i, float cumulative);
    /// The first entry whose CDF exceeds u. u becomes the position within the entry, uniform in [0, 1).
    size_t find(size_t list, float& u) const;
    /// The probability of an entry.
    float share(size_t list, size_t i) const { return at(list, i) - (i == 0 ? 0 : at(list, i - 1)); }
    /// The inverse of `find`.
    float place(size_t list, size_t i, float within) const {
      const float low = i == 0 ? 0 : at(list, i - 1);
      return std::min(low + within * (at(list, i) - low), one_minus_epsilon);
    }
    void prefetch(size_t list, size_t i) const { __builtin_prefetch(&lowest_[list * lowest_nodes_ + i / fanout]); }

   private:
    static constexpr size_t fanout = 16;
    struct alignas(64) Node {
      Node();
      float cumulative[fanout];  ///< infinite beyond the last entry
    };
    float at(size_t list, size_t i) const { return lowest_[list * lowest_nodes_ + i / fanout].cumulative[i % fanout]; }

    size_t count_ = 0, lowest_nodes_ = 0, upper_nodes_ = 0;  ///< of each list: entries, nodes of the lowest level, other nodes
    std::vector<size_t> levels_;                             ///< number of nodes of each level above the lowest, from the root
    std::vector<Node> upper_, lowest_;
  };

  double total_ = 0;
  Searched rows_, columns_;      ///< CDF of the rows, and for each row (a list) the CDF of its texels
  std::vector<float> measures_;  ///< of a texel, by row
};

}  // namespace etendue
