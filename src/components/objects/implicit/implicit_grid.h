#pragma once
// Walking along a ray through the cells of a regular grid.

#include <algorithm>
#include <cmath>

#include "implicit_object.h"

namespace etendue {

/// The cells a line passes, in order (Amanatides & Woo 1987, "A fast voxel traversal algorithm"), or blocks of them where
/// nothing is (Cohen & Sheffer 1994, "Proximity clouds"). Coordinates count cells; the line stays in the grid but for rounding.
class GridWalk {
 public:
  GridWalk(const Place& origin, const Place& direction, double from, double to, const int (&count)[3])
      : enter(from), origin_(origin), direction_(direction), to_(to) {
    for (int k = 0; k < 3; ++k) {
      count_[k] = count[k];
      cell[k] = int(std::clamp(std::floor(at(from, k)), 0.0, double(count[k] - 1)));
      // Where it starts in a plane between two cells and goes down, the lower one is meant.
      if (direction_[k] < 0 && cell[k] > 0 && at(from, k) <= cell[k]) --cell[k];
    }
  }

  double at(double t, int k) const { return origin_[k] + t * direction_[k]; }

  /// Finds `leave`, where the line leaves the block of all cells that are no farther than `reach` from the cell.
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

  /// Goes on to the cell behind the block; false at the end.
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
