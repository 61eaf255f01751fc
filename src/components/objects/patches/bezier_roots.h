#pragma once
// Intersection of a ray with a cell of a Bézier patch.

#include "bezier_cells.h"
#include "bezier_region.h"

namespace etendue::bezier {

struct Line {
  Vector origin, direction;
};

/// An intersection of a line with a patch.
struct Root {
  double distance = 0;  ///< in units of the direction's length
  double s = 0, t = 0;
  std::uint32_t patch = 0;
};

/// Finds the root in a cell that is nearest to the line's origin, has a distance in (0, maximum) and lies in the region.
/// Returns false if there is none.
bool nearest_root(const Patch&, const Cell&, const Line&, double maximum, const Region&, Root&);

}  // namespace etendue::bezier
