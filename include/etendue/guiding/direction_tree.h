#pragma once
// DirectionTree: a density of directions that is learned, as a quadtree over the sphere.
//
// Directions are points of the unit square by Lambert's map that keeps areas, x = (z + 1) / 2 and y = phi / (2 pi), so a cell
// of area a has the solid angle 4 pi a. Within a cell the density is the same everywhere (Müller, Gross & Novák 2017,
// "Practical path guiding for efficient light-transport simulation", section 3.2).
//
// Samples of a quantity bring a sum S to each cell. What the cell weighs follows from what S estimates: the integral of the
// quantity itself, then the density is to be in proportion to it, w = S; or the integral of its second moment, then to the
// root of that, w = sqrt(S a), which has the least variance (Rath et al. 2020, "Variance-aware path guiding", section 4).

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "etendue/core/math.h"
#include "etendue/core/vector.h"

namespace etendue {

/// What a guide's density of directions is in proportion to.
enum class GuideTarget : std::uint8_t {
  second_moment,  ///< the root of the mean square of scattered light, over all that it may be
  mean,           ///< the mean of scattered light
};

class DirectionTree {
 public:
  /// Cells of this depth are not divided: their sides are 2^-12, far wider than what rounding of directions does.
  static constexpr int deepest = 12;
  /// What a tree takes in memory for each of its nodes [bytes].
  static size_t node_bytes() { return sizeof(Node); }

  DirectionTree() : nodes_(1) {}

  /// [1/sr]
  float density(const Vector3& direction) const;
  /// A direction with that density [1/sr].
  Vector3 sample(Point2 u, float& density) const;

  /// Adds to the sum of a cell. Each sample is moved by chance, by `jitter` in [0, 1)^2, as far as its cell is wide: so a
  /// cell's sum is smooth over its neighbours (Müller 2019, "Path guiding in production", section 10.5.1). Numbers that are not
  /// positive, or not finite, are left out.
  void add(const Vector3& direction, double value, Point2 jitter);

  /// Makes the density from the sums, and begins new ones, of no more than so many nodes: cells with more than `fraction` of
  /// the whole are divided, others joined. A tree to which nothing was added stays as it is; false.
  bool refine(GuideTarget, float fraction, size_t most_nodes);

  size_t size() const { return nodes_.size(); }

  void save(std::vector<std::byte>&) const;
  /// Takes its bytes off the front of others; Error: they are none.
  void load(std::span<const std::byte>&);

 private:
  /// Four cells, numbered by (x in the upper half) + 2 (y in the upper half).
  struct Node {
    float weight[4] = {1, 1, 1, 1};         ///< of a cell, over that of the mean of the four
    std::uint32_t child[4] = {0, 0, 0, 0};  ///< 0: not divided
    double sum[4] = {0, 0, 0, 0};           ///< of cells that are not divided
  };

  std::vector<Node> nodes_;
};

}  // namespace etendue
