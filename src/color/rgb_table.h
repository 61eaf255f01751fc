#pragma once
// Sigmoid coefficients for every RGB colour of a space, computed on first use.

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

#include "core/huge_pages.h"
#include "etendue/describe/color.h"
#include "sigmoid_fit.h"

namespace etendue {

/// Thread-safe. The table is a three-fold cube after Jakob & Hanika: for each of the components that can be the
/// largest, its value z and the ratios x, y of the others to it. Three properties allow a small table:
///  - The weights of R, G and B each sum to 1 and S(-x) = 1 - S(x), so the coefficients of 1 - rgb are those of rgb with
///    the sign changed. Only colours with largest + smallest component <= 1 are looked up.
///  - Towards black S = 1 / (4 x^2) for large -x, so coefficients grow as z^-1/2; the table stores c sqrt(z), which is
///    smooth and valid for all z below the lowest level.
///  - Cells in which interpolation is too coarse (saturated colours, where S is nearly a step: a quarter of all cells) are
///    divided into 64 on their first use, which takes 0.1 milliseconds. The few of these 64 that are still too coarse are
///    marked; coefficients interpolated in them are improved by Gauss-Newton steps, which take a microsecond per look-up.
///    (Without the division a textured scene spent a fifth of its time on such steps.)
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
    float coarse;  // 1: the cell whose lowest corner is this node is too coarse
  };
  /// The nodes of a divided cell; the index along the largest component varies slowest.
  static constexpr int parts = 4, side = parts + 1, divided_nodes = side * side * side;
  struct Divided {
    Node nodes[divided_nodes];
  };
  /// A position in the table: a cell, and coordinates in it.
  struct Place;
  static Place place_of(const float rgb[3]);
  static RgbCoefficients between(const Node* corner, size_t row, size_t sheet, float x, float y, float z, float largest);
  void compute(const RgbSpace&);
  RgbCoefficients look_up(const Node* nodes, const float rgb[3]);
  const Divided& divided(const Node* nodes, const Place&);
  std::unique_ptr<Divided> divide(const Node* nodes, const Place&) const;

  std::once_flag once_;
  std::atomic<const Node*> nodes_{nullptr};
  HugeVector<Node> storage_;  // [largest][z][y][x]
  std::unique_ptr<std::atomic<const Divided*>[]>
      divided_;  // of the cell whose lowest corner is the node; null: not divided yet
  std::unique_ptr<SigmoidFit> fit_;
};

}  // namespace etendue
