#pragma once
// Strands with a round cross-section: chains of cones, cut by planes so that they join without gaps.

#include <span>
#include <vector>

#include "curve_strand.h"
#include "etendue/placed_object.h"
#include "geometry/double_ray.h"
#include "geometry/geometry.h"

namespace etendue {

/// A vector in double.
struct Double3 {
  double x = 0, y = 0, z = 0;
  Double3() = default;
  Double3(double a, double b, double c) : x(a), y(b), z(c) {}
  explicit Double3(const double (&v)[3]) : x(v[0]), y(v[1]), z(v[2]) {}
  explicit Double3(const Point3& p) : x(double(p.x)), y(double(p.y)), z(double(p.z)) {}
  explicit Double3(const Vector3& v) : x(double(v.x)), y(double(v.y)), z(double(v.z)) {}
  explicit operator Vector3() const { return {float(x), float(y), float(z)}; }
};
inline Double3 operator+(const Double3& a, const Double3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Double3 operator-(const Double3& a, const Double3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Double3 operator*(double s, const Double3& v) { return {s * v.x, s * v.y, s * v.z}; }
inline double dot(const Double3& a, const Double3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Double3 cross(const Double3& a, const Double3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(const Double3& v) { return std::sqrt(dot(v, v)); }
inline Double3 normalize(const Double3& v) { return (1 / length(v)) * v; }

/// A vertex of a strand: the joint of two pieces, or an end.
struct CurveVertex {
  Point3 position;
  float radius = 0;
  /// For a tube: unit normal of the plane that separates the pieces. For a ribbon: unit vector across it.
  Vector3 across;
  float offset = 0;   ///< signed distance of that plane from the position, along its normal
  Vector3 reference;  ///< unit, perpendicular to the axis of the tube's piece that begins here: the direction of v = 0
  float u = 0;        ///< along the strand
  bool flat = false;  ///< a tube's flat end
};

// A sphere that moves from one vertex to the next while its radius changes linearly sweeps a cone. With the axis a, the
// first radius r, its change k per length and c = sqrt(1 - k^2), the sphere at s touches the cone in a circle
//   y = s a + (r + k s) m,  m = -k a + c e   (m the cone's unit normal, e a unit vector across the axis at the angle psi),
// which gives c^2 |y across a|^2 = (r + k y.a)^2, and c^2 (r + k s) ds dpsi of area.
// With L = (y.a + r k) / c it is |y|^2 - r^2 = L^2. Two cones around the same sphere therefore meet where their L are equal
// or opposite, in planes (a case of Monge's theorem on quadrics that touch a third one): cut by the plane
// L_before + L_after = 0, the pieces of a tube fit exactly, though its radius changes.
class TubePiece {
 public:
  enum Face : std::uint32_t { round, begin, end };

  TubePiece(const CurveVertex& from, const CurveVertex& to);

  /// The nearest intersection with a t that is positive as a float and below a maximum; u and v belong to the face.
  bool intersect(const DoubleRay&, float maximum, float& t, Face&, float& u, float& v) const;
  /// u and v in [0, 1]: on the round face along the piece and around it, on flat ends across the disc. With `smooth`, shading
  /// normals are interpolated along the spline, so that the pieces are not visible.
  void point(Face, float u, float v, bool smooth, LocalPoint&) const;
  Bounds3 bounds() const;

  double area(Face) const;
  /// An estimate of the relative error of the round face's area.
  double area_error() const;
  bool has(Face f) const { return f == round || (f == begin ? from_.flat && r_ > 0 : to_.flat && to_.radius > 0); }
  /// Samples u and v by area, and the pdf [1/m^2] of a point at them.
  Point2 sample(Face, Point2) const;
  double pdf(Face, float u, float v) const;

  /// Whether the planes at both ends intersect only outside the tube.
  bool proper() const;
  Double3 axis() const { return a_; }
  /// Change of the radius per length.
  double slope() const { return k_; }

 private:
  /// The line on the cone at the angle psi, from plane to plane.
  struct Line {
    Double3 out, around, normal;  // e, its derivative by psi, m
    double s0, s1, ds0, ds1;      // derivatives by psi
  };
  Line line(double psi) const;
  /// The ranges of s in which the planes cut the cone.
  struct Extent {
    double first0, last0, first1, last1;
  };
  bool extent(Extent&) const;
  /// Integral of (r + k s) ds over the line.
  double integral(const Line& l) const { return (l.s1 - l.s0) * (r_ + 0.5 * k_ * (l.s0 + l.s1)); }
  double round_area(int steps) const;
  double end_radius(Face f) const { return (f == begin ? r_ : double(to_.radius)) / c_; }

  const CurveVertex &from_, &to_;
  Double3 p_, a_, e1_, e2_, n0_, n1_;  // e1, e2, -a are right-handed, so that dpdu x dpdv points outwards
  double length_, r_, k_, c2_, c_;
  double o0_, o1_;  // both planes are n.y = o, with y relative to the piece's beginning
};

/// Appends the vertices of the tube along a chain of points. Where the tube bends too sharply for its pieces to be joined, it
/// is cut, with two flat ends. Consecutive points must be distinct, and their radii must differ by less than their distance.
/// `turned_by` [rad] rotates the direction of v = 0 about the axis. Returns the number of cuts.
size_t append_tube(std::span<const StrandPoint>, double turned_by, std::vector<CurveVertex>& vertices);

}  // namespace etendue
