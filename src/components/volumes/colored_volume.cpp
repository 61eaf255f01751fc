#include "colored_volume.h"

#include <fmt/format.h>

#include "components/phasefunctions/henyey_greenstein.h"
#include "etendue/core/warp.h"

namespace etendue {

// A phase function knows h = 1 - cos(theta) alone, theta the angle between the ways light travels before and after. It is found
// from the difference d of the two unit vectors as |d|^2 / 2, so that nothing cancels in a narrow peak. A negative anisotropy
// is the same function of the angle to the opposite way.
float ColoredVolume::phase(const Point3&, const Vector3& out, const Vector3& in) const {
  if (phase_function) return phase_function->value(length_squared(in + out) / 2);
  return henyey_greenstein::value(std::abs(anisotropy), length_squared(in - peak(out)) / 2);
}

Vector3 ColoredVolume::sample_phase(const Point3&, const Vector3& out, Point2 u, float& density) const {
  float h = 0;
  if (phase_function) {
    h = phase_function->sample(u.x);
    density = phase_function->value(h);
  } else {
    h = henyey_greenstein::sample(std::abs(anisotropy), u.x);
    density = henyey_greenstein::value(std::abs(anisotropy), h);
  }
  const float r = safe_sqrt(h * (2 - h));
  float sine = 0, cosine = 0;
  sin_cos_turn(u.y, sine, cosine);
  return Frame(Normal3(phase_function ? -out : peak(out))).to_world({r * cosine, r * sine, 1 - h});
}

void ColoredVolume::prepare_colors() {
  check("absorption", absorption, ColorUse::coefficient);
  check("scattering", scattering, ColorUse::coefficient);
  emits_ = check("emission", emission, ColorUse::radiance);
  if (extinction) {
    check("extinction", extinction, ColorUse::coefficient);
    check("albedo", albedo, ColorUse::reflectance);
    if (const ValueRange range = range_of(*albedo, ColorUse::reflectance); range.most > 1.0001f)
      fail("albedo", fmt::format("lies between 0 and 1, and this is {} at {} nm", range.most, range.most_at));
    const ValueRange a = range_of(*absorption, ColorUse::coefficient), s = range_of(*scattering, ColorUse::coefficient);
    if (a.most > 0 || s.most > 0)
      fail("extinction", "is given besides absorption or scattering; only one way of saying it can count");
  }
  if (!(std::abs(anisotropy) < 1)) fail("anisotropy", "must lie between -1 and 1, both excluded");
  if (phase_function && anisotropy != 0)
    fail("anisotropy", "is given besides a phase function; only one way of saying it can count");
}

/// Whether it is more than 0 anywhere; fails when it is negative.
bool ColoredVolume::check(const char* member, const Color& color, ColorUse use) const {
  if (!color) fail(member, "a number, a colour or a spectrum is needed");
  if (color->imaginary()) fail(member, "must be real; this is a complex index of refraction");
  const ValueRange range = range_of(*color, use);
  const bool low = !(range.least >= 0);
  if (low || !(range.most < infinity))
    fail(member, fmt::format("must be neither negative nor infinite, and is {} at {} nm", low ? range.least : range.most,
                             low ? range.least_at : range.most_at));
  return range.most > 0;
}

}  // namespace etendue
