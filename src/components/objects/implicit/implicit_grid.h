#pragma once
// GridWalk: traverses the cells of a regular grid along a ray (3D DDA).

#include <algorithm>
#include <cmath>

#include "implicit_object.h"

namespace etendue {

/// Visits the cells along a line in order (Amanatides & Woo 1987, "A fast voxel traversal algorithm"), skipping empty blocks of
/// cells (Cohen & Sheffer 1994, "Proximity clouds"). The line must stay in the grid, up to rounding.
class GridWalk {
 public:
  /// Of a grid that begins at `low` and has `scale` cells per unit of length, `count` along each axis.
  GridWalk(const DoubleRay& line, double from, double to, const Place& low, const Place& scale, const int (&count)[3])
      : enter(from), to_(to) {
    for (int k = 0; k < 3; ++k) {
      origin_[k] = (line.origin[k] - low[k]) * scale[k];
      direction_[k] = line.direction[k] * scale[k];
      count_[k] = count[k];
      cell[k] = int(std::clamp(std::floor(at(from, k)), 0.0, double(count[k] - 1)));
      // If the line starts in the plane between two cells and its direction is negative, it starts in the lower cell.
      if (direction_[k] < 0 && cell[k] > 0 && at(from, k) <= cell[k]) --cell[k];
    }
  }

  double at(double t, int k) const { return origin_[k] + t * direction_[k]; }

  /// Computes `leave`, the parameter at which the line leaves the block of all cells at most `reach` cells away from the
  /// current one.
  void measure(int reach = 0) {
    reach_ = reach;
    leave = to_;
    axis_ = -1;
    for (int k = 0; k < 3; ++k) {
      if (direction_[k] == 0) continue;
      const int plane = direction_[k] > 0 ? cell[k] + 1 + reach : cell[k] - reach;
      const double t = (plane - origin_[k]) / direction_[k];
      if (t < leave) {
        leave = t;
        axis_ = k;
      }
    }
    leave = std::max(leave, enter);
  }

  /// Moves to the cell behind the block; returns false at the end of the line.
  bool next() {
    if (axis_ < 0) return false;
    for (int k = 0; k < 3; ++k) {
      if (direction_[k] == 0) continue;
      const bool up = direction_[k] > 0;
      if (k == axis_)
        cell[k] += up ? 1 + reach_ : -1 - reach_;
      else if (reach_ > 0)
        cell[k] = int(std::clamp(std::floor(at(leave, k)), double(up ? cell[k] : cell[k] - reach_),
                                 double(up ? cell[k] + reach_ : cell[k])));
      if (cell[k] < 0 || cell[k] >= count_[k]) {
        if (k == axis_) return false;
        cell[k] = std::clamp(cell[k], 0, count_[k] - 1);
      }
    }
    enter = leave;
    return true;
  }

  int cell[3];
  double enter, leave = 0;

 private:
  Place origin_, direction_;
  double to_;
  int count_[3], reach_ = 0, axis_ = -1;
};

}  // namespace etendue
