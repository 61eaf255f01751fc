#pragma once
// Strands as they are described (control points of a spline), and as they are traced (a chain of short straight pieces).

#include <cstdint>
#include <span>
#include <vector>

#include "etendue/core/vector.h"

namespace etendue {

enum class CurveBasis : std::uint8_t { linear, bezier, b_spline, catmull_rom };

/// One strand's control points. Of radii and normals there are as many as points, or one for all; normals may be missing.
struct StrandControl {
  std::span<const Point3> points;
  std::span<const float> radii;
  std::span<const Normal3> normals;
};

/// A place on a strand.
struct StrandPoint {
  double position[3], normal[3];  ///< the normal as interpolated, not normalized
  double radius;
  double u;  ///< along the strand, 0 to 1
};

/// How many control points a strand needs, and by how many more at a time it may grow.
struct StrandSize {
  size_t least, step;
};
StrandSize strand_size(CurveBasis);

/// Appends points along a strand, from its beginning to its end: of a linear one its points, of splines so many that the
/// pieces between them turn by at most about `turn` [rad] each, and the radius between them is linear within 1 % of the
/// largest. A piece is then within turn^2 / 8 of the radius of curvature from the spline. The number of control points is
/// one that strand_size allows.
void flatten(const StrandControl&, CurveBasis, double turn, std::vector<StrandPoint>& out);

}  // namespace etendue
