#pragma once
// Media that were measured, by the names that pbrt and Mitsuba 0.x give them.

#include <array>
#include <span>

namespace etendue {

/// Red, green and blue [1/mm] of a medium that scatters alike in all directions: the scattering is reduced, times 1 - g.
struct MeasuredMedium {
  const char* name;
  std::array<double, 3> scattering, absorption;
};

/// What pbrt takes where nothing is said.
inline constexpr MeasuredMedium whole_milk{"Wholemilk", {2.55, 3.21, 3.77}, {0.0011, 0.0024, 0.014}};

std::span<const MeasuredMedium> measured_media();

}  // namespace etendue
