#pragma once
// Tools for BRDF models that are functions of the half-vector h of the two directions.
//
// Notation of these models: v and v' are the cosines of the two directions with the normal, t that of h, and u that of either
// direction with h. If h has pdf p_h, the direction `in` reflected from `out` about h has pdf p_h / (4 u), both per solid angle
// (Torrance & Sparrow 1967). Both directions are taken to lie above the surface: directions below are mirrored at the surface
// plane.

#include <array>

#include "etendue/core/vector.h"

namespace etendue {

struct HalfVector {
  Vector3 h;  ///< unit, z = t > 0
  float u;

  /// The square of the sine of h's angle with the normal, without cancellation.
  float sine_squared() const { return h.x * h.x + h.y * h.y; }
};

inline Vector3 above(const Vector3& v) { return {v.x, v.y, std::abs(v.z)}; }

/// The half-vector of two unit directions on the same side; |out + in| = 2 u.
inline HalfVector half_vector(const Vector3& out, const Vector3& in) {
  const Vector3 sum{out.x + in.x, out.y + in.y, std::abs(out.z) + std::abs(in.z)};
  const float twice_u = std::max(length(sum), 1e-15f);
  return {sum / twice_u, 0.5f * twice_u};
}

/// The unit direction v reflected about h.
inline Vector3 mirrored_at(const Vector3& h, const Vector3& v) { return 2 * dot(h, v) * h - v; }

/// (1 - c)^5: how Fresnel reflection grows towards grazing (Schlick 1994).
inline float schlick_growth(float c) {
  const float x = std::max(1 - c, 0.0f), x2 = x * x;  // a cosine may exceed 1 by rounding
  return x2 * x2 * x;
}

/// A table of a lobe's directional albedo, split into `parts` components, by the cosine of `out` and two shape parameters in
/// [0, 1]; interpolated linearly.
template <size_t parts>
class AlbedoTable {
 public:
  using Value = std::array<float, parts>;

  /// sample(a, b, u) returns a half-vector sampled from the lobe of shape (a, b). weight(a, b, h, cosine) returns the
  /// components of the sampling weight f cos / pdf of `out` reflected about h. The albedo is the mean of the weights.
  template <class Sample, class Weight>
  AlbedoTable(const Sample& sample, const Weight& weight) {
    for (int k = 0; k < shapes; ++k)
      for (int l = 0; l < shapes; ++l) {
        const float a = float(k) / (shapes - 1), b = float(l) / (shapes - 1);
        for (int x = 0; x < steps * steps; ++x) {
          const Vector3 h = sample(a, b, Point2{(float(x / steps) + 0.5f) / steps, (float(x % steps) + 0.5f) / steps});
          for (int i = 0; i < cosines; ++i) {
            const Value part = weight(a, b, h, std::max(square(float(i) / (cosines - 1)), 1e-4f));
            for (size_t j = 0; j < parts; ++j) value_[size_t(i)][size_t(k)][size_t(l)][j] += part[j] / (steps * steps);
          }
        }
      }
  }
  /// The albedo of an anisotropic lobe for `out` at any azimuth, from a table made with `out` in the azimuth of x whose shape
  /// parameters are the square roots of the lobe's widths along x and y. Near the normal, interpolates by the squared cosine of
  /// the azimuth between the values for `out` along x and along y; at grazing angles, uses the extents of the widths' ellipse
  /// along `out` and across it.
  Value turned(const Vector3& out, float a, float b) const {
    if (a == b) return (*this)(out.z, a, b);
    const float s2 = out.x * out.x + out.y * out.y, x2 = s2 > 0 ? out.x * out.x / s2 : 1;
    const float a4 = square(square(a)), b4 = square(square(b));
    const Value along = (*this)(out.z, a, b), across = (*this)(out.z, b, a),
                ellipse = (*this)(out.z, std::sqrt(std::sqrt(lerp(x2, b4, a4))), std::sqrt(std::sqrt(lerp(x2, a4, b4))));
    Value sum;
    for (size_t j = 0; j < parts; ++j) sum[j] = lerp(out.z * out.z, ellipse[j], lerp(x2, across[j], along[j]));
    return sum;
  }
  Value operator()(float cosine, float a, float b) const {
    const Place x(std::sqrt(std::abs(cosine)), cosines), y(a, shapes), z(b, shapes);
    Value sum{};
    for (size_t i = 0; i < 2; ++i)
      for (size_t k = 0; k < 2; ++k)
        for (size_t l = 0; l < 2; ++l) {
          const float share = x.share[i] * y.share[k] * z.share[l];
          const Value& v = value_[x.index + i][y.index + k][z.index + l];
          for (size_t j = 0; j < parts; ++j) sum[j] += share * v[j];
        }
    return sum;
  }

 private:
  static constexpr int cosines = 17, shapes = 9, steps = 12;

  /// The two table entries around a coordinate, and their interpolation weights.
  struct Place {
    Place(float x, int size) {
      const float at = clamp(x, 0, 1) * float(size - 1);
      index = size_t(std::min(int(at), size - 2));
      share[1] = at - float(index);
      share[0] = 1 - share[1];
    }
    size_t index;
    float share[2];
  };
  std::array<std::array<std::array<Value, shapes>, shapes>, cosines> value_{};
};

/// The unit direction of given cosine in the azimuth of x.
inline Vector3 towards_x(float cosine) { return {safe_sqrt(1 - cosine * cosine), 0, cosine}; }

}  // namespace etendue
