#pragma once
// Affine transforms, and animated transforms given by keys in time.

#include <array>
#include <vector>

#include "etendue/core/vector.h"

namespace etendue {

/// An affine map with its inverse: a 3x4 matrix, row major; the last row (0 0 0 1) is implicit. It is stored in double
/// precision, and in floats for rays and points.
class Transform {
 public:
  using Matrix = std::array<float, 12>;
  using DoubleMatrix = std::array<double, 12>;

  Transform() = default;
  /// From a matrix; a singular one gives a transform that is not valid().
  explicit Transform(const DoubleMatrix& matrix);
  explicit Transform(const Matrix& matrix);

  static Transform translate(const DoubleVector3& by);
  /// By an angle [rad] about an axis through the origin, counter-clockwise seen against the axis.
  static Transform rotate(double angle, const DoubleVector3& axis);
  static Transform scale(const DoubleVector3& by);
  /// Camera convention: +z looks from `from` to `to`, +y is up, +x is to the left of the picture (right-handed frame).
  static Transform look_at(const DoublePoint3& from, const DoublePoint3& to, const DoubleVector3& up);

  const DoubleMatrix& exact() const { return exact_; }
  const Matrix& matrix() const { return m_; }
  bool valid() const { return valid_; }
  bool identity() const { return identity_; }
  /// Whether it is a pure translation.
  bool shifts_only() const { return shifts_only_; }
  /// The translation of the inverse: the preimage of the origin.
  Vector3 shift_back() const { return {inverse_[3], inverse_[7], inverse_[11]}; }
  /// Whether it changes handedness: the determinant is negative.
  bool flips() const { return flips_; }
  /// The determinant of the linear part: the factor by which it enlarges volumes; negative if it mirrors.
  float determinant() const {
    return dot(cross(Vector3{m_[0], m_[4], m_[8]}, Vector3{m_[1], m_[5], m_[9]}), Vector3{m_[2], m_[6], m_[10]});
  }
  /// The factor by which it enlarges area at a surface of unit normal n: |det M| |M^-T n|.
  float area_stretch(const Normal3& n) const { return std::abs(determinant()) * length(Vector3((*this)(n))); }
  Transform inverse() const;
  /// First b, then this.
  Transform operator*(const Transform& b) const;
  bool operator==(const Transform& b) const { return exact_ == b.exact_; }

  Point3 operator()(const Point3& p) const {
    return {m_[0] * p.x + m_[1] * p.y + m_[2] * p.z + m_[3], m_[4] * p.x + m_[5] * p.y + m_[6] * p.z + m_[7],
            m_[8] * p.x + m_[9] * p.y + m_[10] * p.z + m_[11]};
  }
  Vector3 operator()(const Vector3& v) const {
    return {m_[0] * v.x + m_[1] * v.y + m_[2] * v.z, m_[4] * v.x + m_[5] * v.y + m_[6] * v.z,
            m_[8] * v.x + m_[9] * v.y + m_[10] * v.z};
  }
  /// Not normalized; keeps the side the normal points to even under mirroring.
  Normal3 operator()(const Normal3& n) const {
    const auto& i = inverse_;
    return {i[0] * n.x + i[4] * n.y + i[8] * n.z, i[1] * n.x + i[5] * n.y + i[9] * n.z, i[2] * n.x + i[6] * n.y + i[10] * n.z};
  }
  Bounds3 operator()(const Bounds3& b) const;

  // The same in double precision, for precomputation.
  DoublePoint3 operator()(const DoublePoint3& p) const { return times(exact_, p); }
  DoublePoint3 back(const DoublePoint3& p) const { return times(exact_inverse_, p); }

  Point3 back(const Point3& p) const {
    const auto& i = inverse_;
    return {i[0] * p.x + i[1] * p.y + i[2] * p.z + i[3], i[4] * p.x + i[5] * p.y + i[6] * p.z + i[7],
            i[8] * p.x + i[9] * p.y + i[10] * p.z + i[11]};
  }
  Vector3 back(const Vector3& v) const {
    const auto& i = inverse_;
    return {i[0] * v.x + i[1] * v.y + i[2] * v.z, i[4] * v.x + i[5] * v.y + i[6] * v.z, i[8] * v.x + i[9] * v.y + i[10] * v.z};
  }

  /// Upper bounds of the absolute rounding error of transforming p, which itself has the error bound `error`, and of
  /// transforming p by the inverse.
  Vector3 error_bound(const Point3& p, const Vector3& error = {}) const { return bound(m_, p, error); }
  Vector3 error_bound_back(const Point3& p) const { return bound(inverse_, p, {}); }

 private:
  static Vector3 bound(const Matrix& m, const Point3& p, const Vector3& error) {
    // Three products, three sums and the rounding of the matrix itself: each term has at most five roundings.
    constexpr float g = rounding_bound(5);
    const auto row = [&](size_t r) {
      const float a = std::abs(m[4 * r]), b = std::abs(m[4 * r + 1]), c = std::abs(m[4 * r + 2]);
      return g * (a * std::abs(p.x) + b * std::abs(p.y) + c * std::abs(p.z) + std::abs(m[4 * r + 3])) +
             (1 + g) * (a * error.x + b * error.y + c * error.z);
    };
    return {row(0), row(1), row(2)};
  }
  static DoublePoint3 times(const DoubleMatrix& m, const DoublePoint3& p) {
    return {m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3], m[4] * p.x + m[5] * p.y + m[6] * p.z + m[7],
            m[8] * p.x + m[9] * p.y + m[10] * p.z + m[11]};
  }

  Matrix m_{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  Matrix inverse_{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  DoubleMatrix exact_{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  DoubleMatrix exact_inverse_{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  bool valid_ = true, identity_ = true, shifts_only_ = true, flips_ = false;
};

/// A transform keyed by time [s]. Between keys, translation is interpolated linearly, rotation spherically (slerp) and stretch
/// linearly (polar decomposition, Shoemake & Duff 1992), so a rotating object keeps its size. Outside the range of the keys the
/// nearest key holds.
///
/// The keys are as written in the description. The transforms for points and rays, still() and at(), have a shifted origin on
/// either side, which is chosen when a scene is prepared (rendering space, see docs/decisions/020-rendering-space.md): they map
/// p - inner to M p - outer. Their matrix is computed in double precision and then rounded. By default both points are the
/// origin.
class AnimatedTransform {
 public:
  struct Key {
    float time = 0;
    Transform transform;
    bool operator==(const Key&) const = default;
  };

  AnimatedTransform() : keys_{{}} {}
  AnimatedTransform(const Transform& still) : keys_{{0, still}}, still_(still) {}  // NOLINT: a still transform is one
  /// Keys in increasing time; at least one.
  explicit AnimatedTransform(std::vector<Key> keys);
  /// First b, then this. Each factor is interpolated between its own keys; the product has keys at the times of both. Its
  /// `outer` is that of this transform, its `inner` that of b.
  AnimatedTransform operator*(const AnimatedTransform& b) const;

  /// Sets the shifted origins: `outer` for the space that the transform maps to, `inner` for the space that it maps from.
  void set_origins(const DoublePoint3& outer, const DoublePoint3& inner);
  void set_inner_origin(const DoublePoint3& inner) { set_origins(outer_, inner); }
  const DoublePoint3& outer_origin() const { return outer_; }
  const DoublePoint3& inner_origin() const { return inner_; }

  bool animated() const { return keys_.end() > keys_.begin() + 1; }  // size() would need a division
  /// The transform of the first key: the only one when not animated.
  const Transform& still() const { return still_; }
  Transform at(float time) const { return shifted(written(time)); }
  /// The same with `inner` at the true origin.
  Transform from_origin(float time) const { return shifted(written(time), {}); }
  /// As written in the description, with both origins unshifted.
  Transform written(float time) const;
  const std::vector<Key>& keys() const { return keys_; }
  bool valid() const;
  bool operator==(const AnimatedTransform& b) const { return keys_ == b.keys_ && factors_ == b.factors_; }

  /// Bounding box of a moving box over the times [begin, end], computed by sampling the motion finely and enlarging the result
  /// by the largest step.
  Bounds3 sweep(const Bounds3& box, float begin, float end) const;

 private:
  struct Parts {
    std::array<double, 3> translation{};
    std::array<double, 4> rotation{};  // quaternion x y z w
    std::array<double, 9> stretch{};   // 3x3, row major
  };
  static Parts decompose(const Transform&);
  /// A transform as written, between the shifted origins.
  Transform shifted(const Transform& written) const { return shifted(written, inner_); }
  Transform shifted(const Transform& written, const DoublePoint3& inner) const;

  std::vector<Key> keys_;                   // as written
  std::vector<Parts> parts_;                // one for each key if animated
  std::vector<AnimatedTransform> factors_;  // the two factors of an animated product; factors_[1] is applied first
  DoublePoint3 outer_, inner_;
  Transform still_;
};

}  // namespace etendue
