#pragma once
// For emission whose radiance is any function of point and direction: directions in proportion to the cosine, and an estimate
// of the power.

#include <array>
#include <cmath>

#include "etendue/core/warp.h"
#include "etendue/emission_shader.h"
#include "etendue/scene_object.h"

namespace etendue::any_radiance {

/// Samples a direction in proportion to the cosine with the normal, on the sides that emit; of a point without a normal, on a
/// delta light, uniformly over the sphere. The pdf is per solid angle [1/sr].
inline DirectionSample sample(const EmissionShader& emission, const SurfacePoint& p, Point2 u) {
  if (p.normal == Normal3{}) return {warp::sphere(u), warp::sphere_pdf};
  float side = emission.sides == Sides::back ? -1.0f : 1.0f, probability = 1;
  if (emission.sides == Sides::both) {
    probability = 0.5f;
    side = u.x < 0.5f ? 1.0f : -1.0f;
    u.x = std::min(u.x < 0.5f ? 2 * u.x : 2 * u.x - 1, one_minus_epsilon);
  }
  const Vector3 local = warp::cosine_hemisphere(u);
  return {side * Frame(p.normal).to_world(local), probability * warp::cosine_hemisphere_pdf(local.z)};
}

/// The pdf [1/sr] of `sample`.
inline float pdf(const EmissionShader& emission, const SurfacePoint& p, const Vector3& direction) {
  if (p.normal == Normal3{}) return warp::sphere_pdf;
  if (!emission.emits(p, direction)) return 0;
  return (emission.sides == Sides::both ? 0.5f : 1.0f) * inverse_pi * std::abs(dot(p.normal, direction));
}

/// Four numbers of the R sequence (Roberts 2018): i times powers of the inverse of the root of x^5 = x + 1, modulo 1.
inline std::array<float, 4> pattern(int i) {
  constexpr double root = 1.1673039782614187;
  std::array<float, 4> u{};
  double step = 1;
  for (float& x : u) {
    step /= root;
    x = std::min(float(std::fmod(0.5 + step * (i + 1), 1.0)), one_minus_epsilon);
  }
  return u;
}

/// EmissionShader::power [W/nm] as the mean of radiance |cos| / pdf over `count` points and directions of a regular pattern,
/// with the emission's own `sample`. Of an object at infinity: parallel light from each direction, radiance times the projected
/// area of the scene's bounding sphere, which is a quarter of its surface area. It only guides the choice among luminaires.
inline Spectrum power(const EmissionShader& emission, const SceneObject& object, const Wavelengths& w, int count) {
  Spectrum sum;
  for (int i = 0; i < count; ++i) {
    const std::array<float, 4> u = pattern(i);
    if (object.infinite()) {
      Ray ray;
      ray.direction = warp::sphere({u[0], u[1]});
      SurfacePoint p;
      object.surface_point(ray, {}, p);
      sum += emission.radiance(p, -ray.direction, w) * (object.area() * pi);
      continue;
    }
    const SurfaceSample at = object.sample_area({u[0], u[1]}, 0);
    const DirectionSample s = emission.sample(at.point, {u[2], u[3]});
    if (!(at.pdf > 0) || !(s.pdf > 0)) continue;
    const float cosine = object.delta() ? 1 : std::abs(dot(at.point.normal, s.direction));
    sum += emission.radiance(at.point, s.direction, w) * (cosine / (at.pdf * s.pdf));
  }
  return sum / float(count);
}

}  // namespace etendue::any_radiance
