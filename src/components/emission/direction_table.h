#pragma once
// DirectionTable: a pdf over directions that is constant on each cell of a grid in longitude and latitude.

#include <functional>
#include <vector>

#include "etendue/emission_shader.h"

namespace etendue {

// Directions are in local coordinates, z towards the pole. Rows are bands of h = 1 - cos(theta), with theta the angle from the
// pole (h stays exact near the pole). Columns are sectors of the longitude phi = atan2(y, x), measured from the first border. A
// cell is chosen with probability importance * Omega / total, Omega = (h_1 - h_0) (phi_1 - phi_0), and a point in it uniformly
// in h and phi, which is uniform in solid angle: the pdf is importance / total [1/sr].
class DirectionTable {
 public:
  /// The borders are in degrees and increase: `polar` within [0, 180], `azimuth` over at most 360. `importance` of a row and
  /// column need not be normalized. Beyond the borders the pdf is 0.
  void build(const std::vector<double>& polar, const std::vector<double>& azimuth,
             const std::function<double(size_t row, size_t column)>& importance);

  bool empty() const { return !(total_ > 0); }
  DirectionSample sample(Point2 u) const;
  float pdf(const Vector3& local) const;
  /// The inverse of `sample`, where the pdf is not 0.
  Point2 place(const Vector3& local) const;

 private:
  /// The row or column that contains a height or a longitude, by its borders.
  static size_t cell(const std::vector<float>& borders, float x);
  float longitude(const Vector3& local) const;  // from the first border [rad]
  size_t columns() const { return azimuth_.size() - 1; }

  double total_ = 0;
  float first_ = 0;                      // longitude of the first border [rad]
  std::vector<float> height_, azimuth_;  // borders of h, and of phi from the first [rad]
  std::vector<float> pdfs_;              // of each cell [1/sr]
  std::vector<float> row_sums_, sums_;   // CDF of the rows, and in each row the CDF of its cells
};

/// 1 - cos(theta) of a unit vector's angle to z, exact near both poles.
inline float polar_height(const Vector3& v) {
  const float squares = v.x * v.x + v.y * v.y;
  return v.z >= 0 ? squares / (1 + v.z) : 2 - squares / (1 - v.z);
}

/// The borders, with every interval divided into equal steps no longer than `longest`.
std::vector<double> subdivide(const std::vector<double>& borders, double longest);

/// Returns the interval of a CDF that contains u, and replaces u by the position in the interval, uniform in [0, 1).
size_t choose_interval(const float* cumulative, size_t count, float& u);

}  // namespace etendue
