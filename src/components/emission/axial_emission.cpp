// Rotationally symmetric profiles: sampling of directions about an axis, and K (ShapedEmission) of a surface.

#include "axial_emission.h"

#include "at_infinity.h"

namespace etendue {
namespace {

constexpr double pi_exactly = 3.14159265358979323846;

}  // namespace

Spectrum AxialEmission::radiance(const SurfacePoint& p, const Vector3& direction, const Wavelengths& w) const {
  const float f = profile(p, direction);
  return f > 0 && emits(p, direction) ? scaled(p, w, f) : Spectrum();
}

/// h = 1 - cos of the angle to the axis. For profiles about the normal the axis is the normal on the direction's side.
float AxialEmission::height(const SurfacePoint& p, const Vector3& direction) const {
  if (!about_normal(p)) return length_squared(direction - axis_at(p)) / 2;
  const Vector3 n(p.normal);
  return length_squared(direction - (dot(n, direction) > 0 ? n : -n)) / 2;
}

float AxialEmission::profile(const SurfacePoint& p, const Vector3& direction) const { return fall_off(height(p, direction)); }

Vector3 AxialEmission::local(float h, float turn) const {
  const float r = safe_sqrt(h * (2 - h));
  float sine = 0, cosine = 0;
  sin_cos_turn(turn, sine, cosine);
  return {r * cosine, r * sine, 1 - h};
}

DirectionSample AxialEmission::sample(const SurfacePoint& p, Point2 u) const {
  if (p.object && p.object->infinite()) return sample_at_infinity(p);
  if (!about_normal(p)) {
    const float h = draw(u.x, false);
    const Vector3 direction = Frame(Normal3(axis_at(p))).to_world(local(h, u.y));
    return {direction, emits(p, direction) ? drawn(h, false) : 0};
  }
  float side = sides == Sides::back ? -1.0f : 1.0f, probability = 1;
  if (sides == Sides::both) {
    probability = 0.5f;
    side = u.y < 0.5f ? 1.0f : -1.0f;
    u.y = std::min(u.y < 0.5f ? 2 * u.y : 2 * u.y - 1, one_minus_epsilon);
  }
  const float h = draw(u.x, true);
  return {side * Frame(p.normal).to_world(local(h, u.y)), probability * drawn(h, true)};
}

float AxialEmission::pdf(const SurfacePoint& p, const Vector3& direction) const {
  if (p.object && p.object->infinite()) return 1;
  if (!emits(p, direction)) return 0;
  const bool surface = about_normal(p);
  return (surface && sides == Sides::both ? 0.5f : 1.0f) * drawn(height(p, direction), surface);
}

DirectionSample AxialEmission::sample_incident(Point2 u) const {
  const float h = draw(u.x, false);
  return {-Frame(Normal3(axis_)).to_world(local(h, u.y)), drawn(h, false)};
}
float AxialEmission::incident_pdf(const Vector3& towards) const { return drawn(length_squared(towards + axis_) / 2, false); }

/// K of the front side alone, for n . axis = c: the integral over h of f times the integral over the azimuth phi of
/// max(a + b cos(phi), 0), with a = c cos(theta) and b = sqrt(1 - c^2) sin(theta). The azimuthal integral is 2 pi a, 0, or
/// 2 (a phi_0 + b sin(phi_0)) with phi_0 = acos(-a / b). The integrand is smooth in x = sqrt(h) except at the inner h and at
/// the h where the cone touches the horizon, |a| = b. On each interval between these, x is substituted by s^2 (3 - 2s), whose
/// derivative vanishes at both ends, so that the midpoint rule converges fast.
double AxialEmission::front(double c) const {
  constexpr int steps = 32;
  const double rise = std::sqrt(std::max(0.0, 1 - c * c)), horizon = 1 - rise;
  double sum = 0;
  const auto part = [&](double h_from, double h_to) {
    if (!(h_to > h_from)) return;
    const double from = std::sqrt(h_from), width = std::sqrt(h_to) - from;
    for (int i = 0; i < steps; ++i) {
      const double s = (i + 0.5) / steps, x = from + width * s * s * (3 - 2 * s), h = x * x;
      const double a = c * (1 - h), b = rise * std::sqrt(h * (2 - h));
      double around = 0;
      if (a >= b) {
        around = 2 * pi_exactly * a;
      } else if (a > -b) {
        const double phi = std::acos(-a / b);
        around = 2 * (a * phi + b * std::sin(phi));
      }
      sum += double(fall_off(float(h))) * around * 2 * x * width * 6 * s * (1 - s) / steps;
    }
  };
  const double near = inner(), far = outer();
  part(0, std::min(horizon, near));
  part(std::min(horizon, near), near);
  part(near, std::clamp(horizon, near, far));
  part(std::clamp(horizon, near, far), far);
  return sum;
}

double AxialEmission::surface_share(const SurfacePoint& p) const {
  if (about_normal(p)) return (sides == Sides::both ? 2 : 1) * normal_share_;
  const double c = double(dot(p.normal, axis_at(p)));
  return (sides != Sides::back ? front(c) : 0) + (sides != Sides::front ? front(-c) : 0);
}

}  // namespace etendue
