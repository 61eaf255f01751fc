#pragma once
// Flat strands: chains of bilinear patches.

#include "curve_tube.h"

namespace etendue {

// Between two vertices a ribbon is the bilinear patch of its four corners,
//   p(u, v) = (1 - u) (p0 + (2 v - 1) r0 w0) + u (p1 + (2 v - 1) r1 w1)   with w the unit vectors across it.
class RibbonPiece {
 public:
  RibbonPiece(const CurveVertex& from, const CurveVertex& to) : from_(from), to_(to) {
    p_ = Double3(from.position);
    axis_ = Double3(to.position) - p_;
    side0_ = double(from.radius) * Double3(from.across);
    side1_ = double(to.radius) * Double3(to.across);
  }

  /// The nearest intersection with a t that is positive as a float and below a maximum.
  bool intersect(const DoubleRay&, float maximum, float& t, float& u, float& v) const;
  void point(float u, float v, LocalPoint&) const;
  Bounds3 bounds() const;

  /// The area by Gauss-Legendre quadrature with `points` (2 or 3) points along and across.
  double area(int points) const;
  /// Samples u and v, and the pdf [1/m^2] of a point at them: the pdf of u is proportional to the width.
  Point2 sample(Point2) const;
  double pdf(float u, float v) const;

 private:
  Double3 along(double v) const { return axis_ + (2 * v - 1) * (side1_ - side0_); }
  Double3 across(double u) const { return 2 * ((1 - u) * side0_ + u * side1_); }
  double stretch(double u, double v) const { return length(cross(along(v), across(u))); }

  const CurveVertex &from_, &to_;
  Double3 p_, axis_, side0_, side1_;
};

/// Appends the vertices of a ribbon. Its front faces along the points' normals, made orthogonal to the strand. Returns the
/// index of the first point whose normal is parallel to the strand, or points.size() if there is none.
size_t append_ribbon(std::span<const StrandPoint>, std::vector<CurveVertex>& vertices);

}  // namespace etendue
