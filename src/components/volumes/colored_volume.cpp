#include "colored_volume.h"

#include <fmt/format.h>

namespace etendue {

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
  check_phase();
}

/// Whether the spectrum is more than 0 anywhere; calls fail() if it is negative or infinite.
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
