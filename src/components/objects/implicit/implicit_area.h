#pragma once
// Data for the area and the area sampling of an implicit surface; see implicit_area.cpp.

#include "implicit_object.h"

namespace etendue {

/// A stratum of samples: lines along an axis through a cell, or points of a cell's face at the border of the box.
struct ImplicitObject::Patch {
  Cell cell;
  std::uint8_t axis = 0;  ///< axis of the lines, or 3 + face
  float bound = 1;        ///< upper bound of the sum of |n_axis| over the crossings of one line
  double until = 0;       ///< cumulative sum of bound * cross section [m^2]
};

struct ImplicitObject::Table {
  double area = 0, error = 0;  ///< [m^2]; relative error
  std::vector<Patch> patches;
  /// Normals with the area [m^2] facing along each (an extended Gaussian image, Horn 1984), for the area after a transform.
  std::vector<std::pair<Normal3, float>> facing;
};

struct ImplicitObject::Lazy {
  std::once_flag once;
  Table table;
};

/// Calls visit(position, unit normal) for each crossing of a line along an axis through a cell; a and b in [0, 1] give the
/// line's position along the next two axes.
template <class F>
void ImplicitObject::visit_line(const Cell& cell, int axis, double a, double b, const F& visit) const {
  Place low, high;
  cell_box(cell, low, high);
  DoubleRay r{Ray{}};
  for (int k = 0; k < 3; ++k) {
    const double across = k == (axis + 1) % 3 ? a : b;
    r.origin[k] = k == axis ? low[k] : low[k] + across * (high[k] - low[k]);
    r.direction[k] = k == axis ? high[k] - low[k] : 0;
  }
  bool inside = field({r.origin[0], r.origin[1], r.origin[2]}) < 0;
  double begin = 0, t = 0;
  for (int i = 0; i < 1000 && begin < 1 && next_crossing(r, begin, 1, inside, t); ++i) {
    const Place x{r.at(t, 0), r.at(t, 1), r.at(t, 2)};
    Place n = gradient(x);
    const double norm = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (double& component : n) component /= norm;
    if (norm > 0 && std::isfinite(norm)) visit(x, n);
    begin = t + 1e-9;
  }
}

}  // namespace etendue
