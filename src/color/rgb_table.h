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
///  - Cells in which interpolation is too coarse (saturated colours, where S is nearly a step) are marked. What is
///    found there is improved by Gauss-Newton steps.
class RgbTable {
 public:
  RgbCoefficients find(const RgbSpace&, float r, float g, float b);

 private:
  struct alignas(16) Node {
    float c[3];
    float coarse;  // 1: the cell from this node up is marked
  };
  void compute(const RgbSpace&);
  static RgbCoefficients interpolate(const Node* nodes, const float rgb[3], bool& coarse);

  std::once_flag once_;
  std::atomic<const Node*> nodes_{nullptr};
  std::vector<Node> storage_;  // [largest][z][y][x]
  std::unique_ptr<SigmoidFit> fit_;
};

}  // namespace etendue
