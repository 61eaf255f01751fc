#pragma once
// Sigmoid coefficients for every RGB of a space, computed at first use.

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

#include "etendue/describe/color.h"
#include "sigmoid_fit.h"

namespace etendue {

/// Thread-safe. The table is a three-fold cube after Jakob & Hanika: for each of the components that can be the
/// largest, its value z and the ratios x, y of the others to it. Three things make a small table do:
///  - The weights of R, G and B each sum to 1 and S(-x) = 1 - S(x), so the coefficients of 1 - rgb are those of rgb with
///    the sign changed. Only colours with largest + smallest component <= 1 are looked up.
///  - Towards black S = 1 / (4 x^2) for large -x, so coefficients grow as z^-1/2; the table holds c sqrt(z), which is
///    smooth and serves all z below the darkest level.
///  - Cells in which interpolation is too coarse (saturated colours, where S is nearly a step: a quarter of them) are divided
///    into 64 when they are first met, which takes 0.1 milliseconds. Of these the few that are still too coarse are marked;
///    what is found there is improved by Gauss-Newton steps, a microsecond for each lookup. (Without the division a textured
///    scene spent a fifth of its time on such steps.)
class RgbTable {
 public:
  RgbTable() = default;
  ~RgbTable();
  RgbTable(const RgbTable&) = delete;
  RgbTable& operator=(const RgbTable&) = delete;

  RgbCoefficients find(const RgbSpace&, float r, float g, float b);

 private:
  struct alignas(16) Node {
    float c[3];
    float coarse;  // 1: the cell from this node up is too coarse
  };
  /// A cell, divided: its nodes, the largest component outermost.
  static constexpr int parts = 4, side = parts + 1, divided_nodes = side * side * side;
  struct Divided {
    Node nodes[divided_nodes];
  };
  /// A place in a cell.
  struct Place;
  static Place place_of(const float rgb[3]);
  static RgbCoefficients between(const Node* corner, size_t row, size_t sheet, float x, float y, float z, float largest);
  void compute(const RgbSpace&);
  RgbCoefficients look_up(const Node* nodes, const float rgb[3]);
  const Divided& divided(const Node* nodes, const Place&);
  std::unique_ptr<Divided> divide(const Node* nodes, const Place&) const;

  std::once_flag once_;
  std::atomic<const Node*> nodes_{nullptr};
  std::vector<Node> storage_;                               // [largest][z][y][x]
  std::unique_ptr<std::atomic<const Divided*>[]> divided_;  // of the cell from each node up; null: not yet
  std::unique_ptr<SigmoidFit> fit_;
};

}  // namespace etendue
