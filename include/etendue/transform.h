#pragma once
// Affine transforms, and transforms keyed by time.

#include <array>
#include <vector>

#include "etendue/vector.h"

namespace etendue {

/// An affine map with its inverse. Rows of a 3x4 matrix, row major; the last row is (0 0 0 1).
class Transform {
 public:
  using Matrix = std::array<float, 12>;

  Transform() = default;
  /// From a matrix; the inverse is found in double precision. A singular matrix gives one that is not valid().
  explicit Transform(const Matrix& matrix);

  static Transform translate(const Vector3& by);
  /// By an angle [rad] about an axis through the origin, counter-clockwise seen against the axis.
  static Transform rotate(float angle, const Vector3& axis);
  static Transform scale(const Vector3& by);
  /// Camera convention: +z looks from `from` to `to`, +y is up, +x is to the left of the picture (right-handed frame).
  static Transform look_at(const Point3& from, const Point3& to, const Vector3& up);

  const Matrix& matrix() const { return m_; }
  bool valid() const { return valid_; }
  bool identity() const { return identity_; }
  /// Whether it mirrors: the determinant is negative.
  bool flips() const { return flips_; }
  Transform inverse() const;
  /// First b, then this.
  Transform operator*(const Transform& b) const;
  bool operator==(const Transform& b) const { return m_ == b.m_; }

  Point3 operator()(const Point3& p) const {
    return {m_[0] * p.x + m_[1] * p.y + m_[2] * p.z + m_[3], m_[4] * p.x + m_[5] * p.y + m_[6] * p.z + m_[7],
            m_[8] * p.x + m_[9] * p.y + m_[10] * p.z + m_[11]};
  }
  Vector3 operator()(const Vector3& v) const {
    return {m_[0] * v.x + m_[1] * v.y + m_[2] * v.z, m_[4] * v.x + m_[5] * v.y + m_[6] * v.z,
            m_[8] * v.x + m_[9] * v.y + m_[10] * v.z};
  }
  /// Not normalised; keeps the side the normal points to even under mirroring.
  Normal3 operator()(const Normal3& n) const {
    const auto& i = inverse_;
    return {i[0] * n.x + i[4] * n.y + i[8] * n.z, i[1] * n.x + i[5] * n.y + i[9] * n.z, i[2] * n.x + i[6] * n.y + i[10] * n.z};
  }
  Bounds3 operator()(const Bounds3& b) const;

  Point3 back(const Point3& p) const {
    const auto& i = inverse_;
    return {i[0] * p.x + i[1] * p.y + i[2] * p.z + i[3], i[4] * p.x + i[5] * p.y + i[6] * p.z + i[7],
            i[8] * p.x + i[9] * p.y + i[10] * p.z + i[11]};
  }
  Vector3 back(const Vector3& v) const {
    const auto& i = inverse_;
    return {i[0] * v.x + i[1] * v.y + i[2] * v.z, i[4] * v.x + i[5] * v.y + i[6] * v.z, i[8] * v.x + i[9] * v.y + i[10] * v.z};
  }

  /// A bound of the absolute rounding error of transforming p, itself known to within `error`.
  Vector3 error_bound(const Point3& p, const Vector3& error = {}) const;

 private:
  Matrix m_{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  Matrix inverse_{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  bool valid_ = true, identity_ = true, flips_ = false;
};

/// A transform keyed by time [s]. Between keys, translation is interpolated linearly, rotation on the sphere and
/// stretch linearly (polar decomposition, Shoemake & Duff 1992), so a rotating object keeps its size. Outside the
/// keys the nearest key holds.
class AnimatedTransform {
 public:
  struct Key {
    float time = 0;
    Transform transform;
    bool operator==(const Key&) const = default;
  };

  AnimatedTransform() : keys_{{}} {}
  AnimatedTransform(const Transform& still) : keys_{{0, still}} {}  // NOLINT: a still transform is one
  /// Keys in increasing time; at least one.
  explicit AnimatedTransform(std::vector<Key> keys);
  /// First b, then this. Each goes on between its own keys as it does alone; the product's are at the times of both.
  AnimatedTransform operator*(const AnimatedTransform& b) const;

  bool animated() const { return keys_.end() > keys_.begin() + 1; }  // size() would divide
  /// The transform of the first key: the only one when not animated.
  const Transform& still() const { return keys_.front().transform; }
  Transform at(float time) const;
  const std::vector<Key>& keys() const { return keys_; }
  bool valid() const;
  bool operator==(const AnimatedTransform& b) const { return keys_ == b.keys_ && factors_ == b.factors_; }

  /// Bounds of a moving box over [begin, end], found by sampling the motion finely and widened by the largest step.
  Bounds3 sweep(const Bounds3& box, float begin, float end) const;

 private:
  struct Parts {
    Vector3 translation;
    std::array<float, 4> rotation{};  // quaternion x y z w
    std::array<float, 9> stretch{};   // 3x3, row major
  };
  static Parts decompose(const Transform&);

  std::vector<Key> keys_;
  std::vector<Parts> parts_;                // one for each key when animated
  std::vector<AnimatedTransform> factors_;  // of a product that is animated, the last to be applied first
};

}  // namespace etendue
