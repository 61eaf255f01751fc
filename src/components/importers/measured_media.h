#pragma once
// Measured media, under the names that pbrt and Mitsuba 0.x give them.

#include <array>
#include <span>

namespace etendue {

/// RGB coefficients [1/mm] of an isotropically scattering medium: `scattering` is the reduced coefficient sigma_s (1 - g).
struct MeasuredMedium {
  const char* name;
  std::array<double, 3> scattering, absorption;
};

/// pbrt's default medium.
inline constexpr MeasuredMedium whole_milk{"Wholemilk", {2.55, 3.21, 3.77}, {0.0011, 0.0024, 0.014}};

std::span<const MeasuredMedium> measured_media();

}  // namespace etendue
