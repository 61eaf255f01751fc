#pragma once
// Where a ray meets a cell of a Bézier patch.

#include "bezier_cells.h"
#include "bezier_region.h"

namespace etendue::bezier {

struct Line {
  Vector origin, direction;
};

/// A point of a line on a patch.
struct Root {
  double distance = 0;  ///< in lengths of the direction
  double s = 0, t = 0;
  std::uint32_t patch = 0;
};

/// The root nearest to the origin in a cell with a distance in (0, maximum) that is in the region.
bool nearest_root(const Patch&, const Cell&, const Line&, double maximum, const Region&, Root&);

}  // namespace etendue::bezier
