#include "phased_volume.h"

#include "components/phasefunctions/henyey_greenstein.h"
#include "etendue/core/warp.h"

namespace etendue {

// A phase function is a function of h = 1 - cos(theta) alone, theta the angle between the directions of propagation before and
// after scattering. h is computed from the difference d of the two unit vectors as |d|^2 / 2, so that nothing cancels in a
// narrow peak. A negative anisotropy gives the same function of the angle to the opposite direction.
float PhasedVolume::phase(const Point3&, const Vector3& out, const Vector3& in) const {
  if (phase_function) return phase_function->value(length_squared(in + out) / 2);
  return henyey_greenstein::value(std::abs(anisotropy), length_squared(in - peak(out)) / 2);
}

Vector3 PhasedVolume::sample_phase(const Point3&, const Vector3& out, Point2 u, float& pdf) const {
  float h = 0;
  if (phase_function) {
    h = phase_function->sample(u.x);
    pdf = phase_function->value(h);
  } else {
    h = henyey_greenstein::sample(std::abs(anisotropy), u.x);
    pdf = henyey_greenstein::value(std::abs(anisotropy), h);
  }
  const float r = safe_sqrt(h * (2 - h));
  float sine = 0, cosine = 0;
  sin_cos_turn(u.y, sine, cosine);
  return Frame(Normal3(phase_function ? -out : peak(out))).to_world({r * cosine, r * sine, 1 - h});
}

bool PhasedVolume::polarization(const Vector3& out, const Vector3& in, Polarization& event) const {
  if (!phase_function) return false;
  event.x_in = event.x_out = common_perpendicular(out, in);
  return polarization_of(*phase_function, length_squared(in + out) / 2, event.mueller);
}

void PhasedVolume::check_phase() const {
  if (!(std::abs(anisotropy) < 1)) fail("anisotropy", "must lie between -1 and 1, both excluded");
  if (phase_function && anisotropy != 0)
    fail("anisotropy", "is given besides a phase function; only one way of saying it can count");
}

}  // namespace etendue
