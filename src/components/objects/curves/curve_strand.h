#pragma once
// Flattens strands: from control points of a spline, as in the description, to a chain of short straight pieces, as traced.

#include <cstdint>
#include <span>
#include <vector>

#include "etendue/core/vector.h"

namespace etendue {

enum class CurveBasis : std::uint8_t { linear, bezier, b_spline, catmull_rom };

/// One strand's control points. There are as many radii and normals as points, or one for all points; normals may be missing.
struct StrandControl {
  std::span<const Point3> points;
  std::span<const float> radii;
  std::span<const Normal3> normals;
};

/// A point on a strand.
struct StrandPoint {
  double position[3], normal[3];  ///< the normal as interpolated, not normalized
  double radius;
  double u;  ///< along the strand, 0 to 1
};

/// The least number of control points of a strand, and the step by which it may be larger.
struct StrandSize {
  size_t least, step;
};
StrandSize strand_size(CurveBasis);

/// Appends points along a strand, from its beginning to its end: the control points of a linear strand, or so many points of a
/// spline that each piece between them turns by at most about `turn` [rad], and that linear interpolation of the radius is off
/// by at most 1 % of the largest radius. A piece then deviates from the spline by at most turn^2 / 8 of the radius of
/// curvature. The number of control points must be one that strand_size allows.
void flatten(const StrandControl&, CurveBasis, double turn, std::vector<StrandPoint>& out);

}  // namespace etendue
