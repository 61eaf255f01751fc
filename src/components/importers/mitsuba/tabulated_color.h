#pragma once
// The albedo that Mitsuba's spectral variants obtain from red, green and blue.

#include <array>

namespace etendue::mitsuba {

/// The colour of the spectrum that Mitsuba looks up for `rgb`, components in [0, 1].
std::array<double, 3> tabulated_color(const std::array<double, 3>& rgb);

}  // namespace etendue::mitsuba
