#pragma once
// MerlTable: MERL files, isotropic f tabulated over the half-vector and the difference vector.
//
// Matusik et al. 2003, "A data-driven reflectance model": theta_h is the half vector's angle from the normal; theta_d and phi_d
// are the coordinates of one of the directions in a frame around the half vector (Rusinkiewicz 1998, "A new change of variables
// for efficient BRDF representation"). f is reciprocal, so phi_d + pi is the same as phi_d and only half a turn is stored. A
// file holds three 32-bit integers, the numbers of cells in theta_h, theta_d and phi_d (90, 90 and 180), then for each of red,
// green and blue a 64-bit number for each cell, phi_d running fastest. Cell i of theta_h spans (pi/2) (i/90)^2 to (pi/2)
// ((i+1)/90)^2; the others are even. f is the number times 1/1500, 1.15/1500 or 1.66/1500 [1/sr]; a negative number marks a
// cell without a measurement.

#include <string>
#include <vector>

#include "etendue/core/vector.h"

namespace etendue {

struct Rgb {
  float r = 0, g = 0, b = 0;
};

class MerlTable {
 public:
  /// Throws Error with a description of what is wrong with the file.
  explicit MerlTable(const std::string& path);

  /// f [1/sr] for two directions above the surface (z > 0), interpolated between the cells' centres. Bitwise the same when a
  /// and b are exchanged.
  Rgb evaluate(const Vector3& a, const Vector3& b) const;

 private:
  struct Value {
    float c[4];  // red, green, blue, padding: read at once
  };
  void fill_unmeasured(int channel, const std::vector<bool>& measured);
  size_t index(int h, int d, int p) const {
    return (size_t(h) * size_t(difference_) + size_t(d)) * size_t(azimuth_) + size_t(p);
  }

  int half_ = 0, difference_ = 0, azimuth_ = 0;  // numbers of cells
  std::vector<Value> values_;
};

}  // namespace etendue
