#pragma once
// EnvironmentGuide: which parts of an environment are seen from where, as it was learned (Atanasov, Soldado et al. 2018,
// "Adaptive environment sampling on CPU and GPU").
//
// Next event estimation samples an environment's directions in proportion to its radiance, by a map w(u) from the unit square
// with the pdf p_0(w) [1/sr]. Indoors nearly all of these directions are hidden, but for those through a window. So the unit
// square is divided into n x n tiles, and in each region of space the tiles have learned probabilities P_t:
//     u = (t + r) / n,  r uniform in the unit square:    n^2 P_t p_0(w),  with the tile t that contains u(w).
// All tiles have the same probability by p_0, so they are small where the environment is bright, and P_t need only know what is
// hidden, and what the surface's own normal makes dark. A part d of the samples is by p_0 itself:
//     p(w) = R_t p_0(w),    R_t = d + (1 - d) n^2 P_t.
// So each estimate stays unbiased, whatever was learned, and none exceeds 1 / d of what it would be by p_0: in a patch of
// sunlight that nothing in its region saw while it learned, too.
//
// The variance of an estimate is least if P_t is proportional to the root of the mean square of f |cos| L V / p_0 over the
// tile. A region learns it for diffuse surfaces, from cosines and shadow rays.
//
// Regions are the leaves of a complete binary tree over places on surfaces, points in the six dimensions of a position and a
// normal: each node divides the places of its part in halves, across the dimension in which they are spread furthest.

#include <array>
#include <cstdint>
#include <vector>

#include "etendue/core/vector.h"

namespace etendue {

class EnvironmentGuide {
 public:
  static constexpr int side = 16;  ///< n
  static constexpr int tiles = side * side;

  /// A point of a surface, or in a medium, where the normal is zero.
  struct Place {
    Point3 position;
    Normal3 normal;
  };

  /// Divides space into regions that hold about `each` of these places or more; at most 2^deepest. What was learned is lost.
  void divide(const std::vector<Place>& places, int each, int deepest);
  std::uint32_t regions() const { return std::uint32_t(tables_.size()); }
  /// The region of a place.
  std::uint32_t region(const Point3& position, const Normal3& normal) const {
    const float at[] = {position.x, position.y, position.z, stretch_ * normal.x, stretch_ * normal.y, stretch_ * normal.z};
    std::uint32_t node = 1;
    for (int level = 0; level < depth_; ++level) node = 2 * node + (at[nodes_[node].dimension] > nodes_[node].border);
    return node - (std::uint32_t(1) << depth_);
  }

  /// The mean square, of each tile row by row, of what a sample in it contributes by p_0.
  using Squares = std::array<float, tiles>;
  /// Sets the probabilities P_t in a region. They are rounded, and at least a sixteenth of those of equal tiles, in each
  /// dimension.
  void learn(std::uint32_t region, const Squares&);

  /// The point u that replaces the uniform `r`, and R_t.
  struct Guided {
    Point2 place;
    float ratio;
  };
  Guided sample(std::uint32_t region, Point2 r) const;
  /// R_t of the tile that contains a point of the unit square.
  float ratio(std::uint32_t region, Point2 place) const;

 private:
  struct Node {
    float border;
    std::uint32_t dimension;
  };
  /// CDFs of the rows of tiles, and of the tiles in each row: the sums of the entries before each, in parts of 256. Most of
  /// what a sample costs is that its tables are not in the nearest cache, so they are small.
  using Sums = std::array<std::uint8_t, side>;
  struct Table {
    Sums rows;
    std::array<Sums, side> columns;
  };

  std::vector<Node> nodes_;  ///< of node i the halves are 2 i and 2 i + 1; the root is 1
  std::vector<Table> tables_;
  int depth_ = 0;
  float stretch_ = 1;  ///< the length that stands for a unit of normals [m]
};

}  // namespace etendue
