#pragma once
// Vectors, points and normals. They are distinct types, as they transform differently, and the sum of two points is
// meaningless.

#include <cmath>
#include <cstddef>

#include "etendue/core/math.h"

namespace etendue {

struct Vector2 {
  float x = 0, y = 0;
  bool operator==(const Vector2&) const = default;
};

struct Point2 {
  float x = 0, y = 0;
  bool operator==(const Point2&) const = default;
};

constexpr Point2 operator+(Point2 p, Vector2 v) { return {p.x + v.x, p.y + v.y}; }
constexpr Vector2 operator-(Point2 a, Point2 b) { return {a.x - b.x, a.y - b.y}; }
constexpr Vector2 operator+(Vector2 a, Vector2 b) { return {a.x + b.x, a.y + b.y}; }
constexpr Vector2 operator*(float s, Vector2 v) { return {s * v.x, s * v.y}; }

struct Vector3 {
  float x = 0, y = 0, z = 0;
  constexpr float operator[](int axis) const { return axis == 0 ? x : (axis == 1 ? y : z); }
  constexpr float& operator[](int axis) { return axis == 0 ? x : (axis == 1 ? y : z); }
  bool operator==(const Vector3&) const = default;
};

struct Point3 {
  float x = 0, y = 0, z = 0;
  constexpr float operator[](int axis) const { return axis == 0 ? x : (axis == 1 ? y : z); }
  constexpr float& operator[](int axis) { return axis == 0 ? x : (axis == 1 ? y : z); }
  bool operator==(const Point3&) const = default;
};

/// A surface normal: transforms by the inverse transpose.
struct Normal3 {
  float x = 0, y = 0, z = 0;
  constexpr Normal3() = default;
  constexpr Normal3(float x_, float y_, float z_) : x(x_), y(y_), z(z_) {}
  constexpr explicit Normal3(const Vector3& v) : x(v.x), y(v.y), z(v.z) {}
  constexpr explicit operator Vector3() const { return {x, y, z}; }
  constexpr float operator[](int axis) const { return axis == 0 ? x : (axis == 1 ? y : z); }
  constexpr Normal3 operator-() const { return {-x, -y, -z}; }
  bool operator==(const Normal3&) const = default;
};

constexpr Vector3 operator+(const Vector3& a, const Vector3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr Vector3 operator-(const Vector3& a, const Vector3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr Vector3 operator-(const Vector3& v) { return {-v.x, -v.y, -v.z}; }
constexpr Vector3 operator*(float s, const Vector3& v) { return {s * v.x, s * v.y, s * v.z}; }
constexpr Vector3 operator*(const Vector3& v, float s) { return s * v; }
constexpr Vector3 operator/(const Vector3& v, float s) { return (1 / s) * v; }
constexpr Vector3& operator+=(Vector3& a, const Vector3& b) { return a = a + b; }

constexpr Vector3 operator-(const Point3& a, const Point3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr Point3 operator+(const Point3& p, const Vector3& v) { return {p.x + v.x, p.y + v.y, p.z + v.z}; }
constexpr Point3 operator-(const Point3& p, const Vector3& v) { return {p.x - v.x, p.y - v.y, p.z - v.z}; }
constexpr Point3 lerp(float t, const Point3& a, const Point3& b) {
  return {lerp(t, a.x, b.x), lerp(t, a.y, b.y), lerp(t, a.z, b.z)};
}

constexpr float dot(const Vector3& a, const Vector3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr float dot(const Normal3& a, const Vector3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr float dot(const Vector3& a, const Normal3& b) { return dot(b, a); }
constexpr float dot(const Normal3& a, const Normal3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

constexpr float length_squared(const Vector3& v) { return dot(v, v); }
inline float length(const Vector3& v) { return std::sqrt(dot(v, v)); }
/// The unit vector along v; v must not be zero.
inline Vector3 normalize(const Vector3& v) { return (1 / length(v)) * v; }
inline Normal3 normalize(const Normal3& n) { return Normal3(normalize(Vector3(n))); }
constexpr float distance_squared(const Point3& a, const Point3& b) { return length_squared(a - b); }
inline float distance(const Point3& a, const Point3& b) { return length(a - b); }
inline Vector3 abs(const Vector3& v) { return {std::abs(v.x), std::abs(v.y), std::abs(v.z)}; }
constexpr float max_component(const Vector3& v) { return v.x > v.y ? (v.x > v.z ? v.x : v.z) : (v.y > v.z ? v.y : v.z); }
inline bool is_finite(const Vector3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
inline bool is_finite(const Point3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// A displacement in double precision, between points of a description.
struct DoubleVector3 {
  double x = 0, y = 0, z = 0;
  constexpr DoubleVector3() = default;
  constexpr DoubleVector3(double x_, double y_, double z_) : x(x_), y(y_), z(z_) {}
  constexpr DoubleVector3(const Vector3& v) : x(double(v.x)), y(double(v.y)), z(double(v.z)) {}  // NOLINT: loses nothing
  constexpr explicit operator Vector3() const { return {float(x), float(y), float(z)}; }
  bool operator==(const DoubleVector3&) const = default;
};

/// A point of a description, in double precision, as floats are too coarse far from the origin. Rendering uses float
/// coordinates relative to a point near the objects in view (rendering space); the difference is computed in double precision.
struct DoublePoint3 {
  double x = 0, y = 0, z = 0;
  constexpr DoublePoint3() = default;
  constexpr DoublePoint3(double x_, double y_, double z_) : x(x_), y(y_), z(z_) {}
  constexpr DoublePoint3(const Point3& p) : x(double(p.x)), y(double(p.y)), z(double(p.z)) {}  // NOLINT: loses nothing
  constexpr explicit operator Point3() const { return {float(x), float(y), float(z)}; }
  constexpr double operator[](int axis) const { return axis == 0 ? x : (axis == 1 ? y : z); }
  constexpr double& operator[](int axis) { return axis == 0 ? x : (axis == 1 ? y : z); }
  bool operator==(const DoublePoint3&) const = default;
};

constexpr DoubleVector3 operator-(const DoublePoint3& a, const DoublePoint3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr DoublePoint3 operator+(const DoublePoint3& p, const DoubleVector3& v) { return {p.x + v.x, p.y + v.y, p.z + v.z}; }
constexpr DoublePoint3 operator-(const DoublePoint3& p, const DoubleVector3& v) { return {p.x - v.x, p.y - v.y, p.z - v.z}; }
constexpr DoubleVector3 operator+(const DoubleVector3& a, const DoubleVector3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr DoubleVector3 operator-(const DoubleVector3& a, const DoubleVector3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr DoubleVector3 operator*(double s, const DoubleVector3& v) { return {s * v.x, s * v.y, s * v.z}; }
constexpr double dot(const DoubleVector3& a, const DoubleVector3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr DoubleVector3 cross(const DoubleVector3& a, const DoubleVector3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(const DoubleVector3& v) { return std::sqrt(dot(v, v)); }
inline bool is_finite(const DoublePoint3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// An orthonormal right-handed basis; local z is the normal.
struct Frame {
  Vector3 s, t;
  Normal3 n;

  Frame() = default;
  Frame(const Vector3& s_, const Vector3& t_, const Normal3& n_) : s(s_), t(t_), n(n_) {}

  /// Any basis around a unit normal (Duff et al. 2017, "Building an orthonormal basis, revisited").
  explicit Frame(const Normal3& normal) : n(normal) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1 / (sign + n.z);
    const float b = n.x * n.y * a;
    s = {1 + sign * n.x * n.x * a, sign * b, -sign * n.x};
    t = {b, sign + n.y * n.y * a, -n.y};
  }

  Vector3 to_local(const Vector3& v) const { return {dot(s, v), dot(t, v), dot(n, v)}; }
  Vector3 to_world(const Vector3& v) const { return v.x * s + v.y * t + v.z * Vector3(n); }
};

/// An axis-aligned box; empty when constructed.
struct Bounds3 {
  Point3 low{infinity, infinity, infinity};
  Point3 high{-infinity, -infinity, -infinity};

  bool empty() const { return !(low.x <= high.x && low.y <= high.y && low.z <= high.z); }
  void add(const Point3& p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  void add(const Bounds3& b) {
    if (b.empty()) return;
    add(b.low);
    add(b.high);
  }
  bool contains(const Point3& p) const {
    return p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y && p.z >= low.z && p.z <= high.z;
  }
  Vector3 diagonal() const { return empty() ? Vector3{} : high - low; }
  Point3 centre() const { return lerp(0.5f, low, high); }
  Point3 corner(int i) const { return {(i & 1) ? high.x : low.x, (i & 2) ? high.y : low.y, (i & 4) ? high.z : low.z}; }
};

}  // namespace etendue
