#pragma once
// DirectionTable: a density over directions that is constant on each cell of a grid in longitude and latitude.

#include <functional>
#include <vector>

#include "etendue/emission_shader.h"

namespace etendue {

// Directions are in local coordinates, z towards the pole. Rows are bands of h = 1 - cos(theta), theta from the pole (h stays
// exact near it), columns sectors of the longitude phi = atan2(y, x), counted from that of the first border. A cell is chosen
// with probability importance * Omega / total, Omega = (h_1 - h_0) (phi_1 - phi_0), a point in it uniformly in h and phi, which
// is uniform in solid angle: the density is importance / total [1/sr].
class DirectionTable {
 public:
  /// Borders in degrees, increasing: `polar` within [0, 180], `azimuth` over at most 360. `importance` of a row and column need
  /// not be normalized. Beyond the borders the density is 0.
  void build(const std::vector<double>& polar, const std::vector<double>& azimuth,
             const std::function<double(size_t row, size_t column)>& importance);

  bool empty() const { return !(total_ > 0); }
  DirectionSample sample(Point2 u) const;
  float pdf(const Vector3& local) const;

 private:
  size_t columns() const { return azimuth_.size() - 1; }

  double total_ = 0;
  float first_ = 0;                      // longitude of the first border [rad]
  std::vector<float> height_, azimuth_;  // borders of h, and of phi from the first [rad]
  std::vector<float> pdfs_;              // of each cell [1/sr]
  std::vector<float> row_sums_, sums_;   // cumulative probabilities: of rows, and in each row of its cells
};

/// 1 - cos(theta) of a unit vector's angle to z, exact near both poles.
inline float polar_height(const Vector3& v) {
  const float squares = v.x * v.x + v.y * v.y;
  return v.z >= 0 ? squares / (1 + v.z) : 2 - squares / (1 - v.z);
}

/// Steps between borders so that none is longer than `longest`.
std::vector<double> subdivide(const std::vector<double>& borders, double longest);

/// An interval of a cumulative distribution, in which u becomes the uniform place.
size_t choose_interval(const float* cumulative, size_t count, float& u);

}  // namespace etendue
