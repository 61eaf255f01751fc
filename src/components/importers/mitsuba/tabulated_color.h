#pragma once
// What Mitsuba's spectral variants make of an albedo given as red, green and blue.

#include <array>

namespace etendue::mitsuba {

/// The colour of the spectrum that stands there for `rgb`, components in [0, 1].
std::array<double, 3> tabulated_color(const std::array<double, 3>& rgb);

}  // namespace etendue::mitsuba
