#pragma once
// Sampling of triangles and rectangles, uniform in the solid angle they subtend.

#include "etendue/core/vector.h"

namespace etendue {

/// Sampling by solid angle pays only near a luminaire. Further away, where area / distance^2 is below this [sr], the
/// factor cos / distance^2 hardly varies over the luminaire and sampling by area is as good and five times faster.
inline constexpr float worthwhile_solid_angle = 0.5f;
/// Outside this range [sr] the formulas below lose too many digits (the point lies almost in the luminaire's plane, or the
/// luminaire fills almost a hemisphere).
inline constexpr float least_solid_angle = 0.01f, greatest_solid_angle = 6.2f;

/// A triangle projected onto the unit sphere around a point.
class SphericalTriangle {
 public:
  SphericalTriangle(const Point3& from, const Point3& p0, const Point3& p1, const Point3& p2)
      : a_(normalize(p0 - from)), b_(normalize(p1 - from)), c_(normalize(p2 - from)) {
    // van Oosterom & Strackee 1983: tan(omega / 2) = |a . (b x c)| / (1 + a.b + b.c + c.a).
    volume_ = std::abs(dot(a_, cross(b_, c_)));
    solid_angle_ = 2 * std::atan2(volume_, 1 + dot(a_, b_) + dot(b_, c_) + dot(c_, a_));
  }

  float solid_angle() const { return solid_angle_; }
  bool usable() const { return solid_angle_ > least_solid_angle && solid_angle_ < greatest_solid_angle; }

  /// Samples a direction uniformly over the triangle, with pdf 1 / solid_angle() [1/sr]. Arvo 1995, "Stratified sampling of
  /// spherical triangles": the first number cuts off, by a vertex c' on the edge ac, a sub-triangle of that fraction of the
  /// area; the second chooses a point on the arc from b to c'. With the interior angle alpha at a and the area S of the
  /// sub-triangle, spherical trigonometry gives for the arc from a to c'
  ///   cos(ac') = ((v t - u s) cos(alpha) - v) / ((v s + u t) sin(alpha)),
  ///   s = sin(S - alpha), t = cos(S - alpha), u = t - cos(alpha), v = s + sin(alpha) cos(ab).
  Vector3 sample(Point2 u) const {
    const Vector3 ab = cross(a_, b_), ac = cross(a_, c_);
    const float scale = 1 / std::sqrt(length_squared(ab) * length_squared(ac));
    const float cos_alpha = dot(ab, ac) * scale, sin_alpha = volume_ * scale;
    const float phi = u.x * solid_angle_ - std::atan2(sin_alpha, cos_alpha);
    const float s = std::sin(phi), t = std::cos(phi);
    const float p = t - cos_alpha, v = s + sin_alpha * dot(a_, b_);
    const float denominator = (v * s + p * t) * sin_alpha;
    const float q = denominator != 0 ? clamp(((v * t - p * s) * cos_alpha - v) / denominator, -1, 1) : 1;
    const Vector3 cut = q * a_ + safe_sqrt(1 - q * q) * normalize(c_ - dot(c_, a_) * a_);
    const float z = 1 - u.y * (1 - dot(cut, b_));
    const Vector3 across = cut - dot(cut, b_) * b_;
    const float l = length(across);
    return l > 0 ? z * b_ + (safe_sqrt(1 - z * z) / l) * across : b_;
  }

 private:
  Vector3 a_, b_, c_;
  float volume_ = 0, solid_angle_ = 0;
};

/// A rectangle projected onto the unit sphere around a point. Urena, Fajardo & King 2013, "An area-preserving
/// parametrization for spherical rectangles". Coordinates are along the rectangle's edges with the point as origin: the
/// rectangle is [x0, x1] x [y0, y1] at height z0.
class SphericalRectangle {
 public:
  SphericalRectangle(float x0, float x1, float y0, float y1, float z0)
      : x0_(x0), x1_(x1), y0_(y0), y1_(y1), z0_(-std::abs(z0)) {
    // The planes through the origin and the four edges have normals whose z components are n0 .. n3; the interior angle
    // between planes i and j is pi/2 + asin(ni nj), since their normals agree in no other component. The solid angle is
    // the sum of the interior angles minus 2 pi: the sum of the arcsines alone.
    const float zz = z0 * z0;
    n0_ = -y0 / std::sqrt(y0 * y0 + zz);
    const float n1 = x1 / std::sqrt(x1 * x1 + zz);
    n2_ = y1 / std::sqrt(y1 * y1 + zz);
    const float n3 = -x0 / std::sqrt(x0 * x0 + zz);
    const float low = std::asin(n2_ * n3) + std::asin(n3 * n0_);
    k_ = pi - low;
    solid_angle_ = std::asin(n0_ * n1) + std::asin(n1 * n2_) + low;
  }

  float solid_angle() const { return solid_angle_; }
  bool usable() const { return solid_angle_ > least_solid_angle && solid_angle_ < greatest_solid_angle; }

  /// Samples a point (x, y) of the rectangle uniformly in solid angle, with pdf 1 / solid_angle() [1/sr]. The first number
  /// finds the x below which that fraction of the solid angle lies (their equations 6 to 8, with b0 = n0, b1 = n2); on the arc
  /// of that x, solid angle is proportional to the height on the sphere, which the second number divides evenly.
  Point2 sample(Point2 u) const {
    const float au = u.x * solid_angle_ + k_;
    const float fu = (std::cos(au) * n0_ - n2_) / std::sin(au);
    const float cu = clamp(std::copysign(1.0f, fu) / std::sqrt(fu * fu + n0_ * n0_), -1, 1);
    const float x = clamp(-(cu * z0_) / std::max(safe_sqrt(1 - cu * cu), 1e-7f), x0_, x1_);
    const float d2 = x * x + z0_ * z0_;
    const float h0 = y0_ / std::sqrt(d2 + y0_ * y0_), h1 = y1_ / std::sqrt(d2 + y1_ * y1_);
    const float h = lerp(u.y, h0, h1);
    const float rest = 1 - h * h;
    return {x, rest > 1e-6f ? clamp(h * std::sqrt(d2 / rest), y0_, y1_) : (h > 0 ? y1_ : y0_)};
  }

 private:
  float x0_, x1_, y0_, y1_, z0_;
  float n0_ = 0, n2_ = 0, k_ = 0, solid_angle_ = 0;
};

}  // namespace etendue
