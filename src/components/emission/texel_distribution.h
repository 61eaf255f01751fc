#pragma once
// A choice among the texels of an image: by row, then within the row.

#include <cstddef>
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
  float pdf(size_t x, size_t y) const { return rows_.share(0, y) * columns_.share(y, x) / measures_[y]; }
  /// Asks the processor to fetch what `density` will look at.
  void prefetch(size_t x, size_t y) const { columns_.prefetch(y, x); }

  struct Choice {
    size_t x, y;
    Point2 within;  ///< uniform in the texel
    float pdf;      ///< the texel's
  };
  Choice choose(Point2 u) const;

 private:
  /// Cumulative probabilities of several lists of things, as many in each, in nodes of sixteen: a line of memory. Above them
  /// lie nodes of the last of each sixteen, and so on up to one node (a B-tree). Of a large image only the lowest nodes are too
  /// many to stay near, so a search waits for memory once, and in no node does it branch.
  class Searched {
   public:
    Searched() = default;
    Searched(size_t lists, size_t count);
    /// Of thing i of a list; to be set in order.
    void set(size_t list, size_t i, float cumulative);
    /// The first thing whose cumulative probability exceeds u, which becomes the uniform place in it.
    size_t find(size_t list, float& u) const;
    /// The probability of one.
    float share(size_t list, size_t i) const { return at(list, i) - (i == 0 ? 0 : at(list, i - 1)); }
    void prefetch(size_t list, size_t i) const { __builtin_prefetch(&lowest_[list * lowest_nodes_ + i / fanout]); }

   private:
    static constexpr size_t fanout = 16;
    struct alignas(64) Node {
      Node();
      float cumulative[fanout];  ///< infinite behind the end
    };
    float at(size_t list, size_t i) const { return lowest_[list * lowest_nodes_ + i / fanout].cumulative[i % fanout]; }

    size_t count_ = 0, lowest_nodes_ = 0, upper_nodes_ = 0;  ///< nodes: of each list
    std::vector<size_t> levels_;                             ///< nodes of those above the lowest, from the top
    std::vector<Node> upper_, lowest_;
  };

  double total_ = 0;
  Searched rows_, columns_;      ///< rows, and in each row (a list) its texels
  std::vector<float> measures_;  ///< of a texel, by row
};

}  // namespace etendue
