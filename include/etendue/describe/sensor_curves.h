#pragma once
// The measured sensitivities of cameras that are known by name.

#include <array>
#include <string>
#include <vector>

#include "etendue/core/spectral_function.h"

namespace etendue {

/// The channels of a sensor: "red", "green", "blue".
inline constexpr std::array<const char*, 3> sensor_channels = {"red", "green", "blue"};

/// The relative sensitivity of a camera's channel, linear between the published values and 0 outside of them. Throws Error for
/// unknown cameras and channels.
Color sensor_curve(const std::string& camera, const std::string& channel);

/// "Nikon D5100", …
std::vector<std::string> sensor_names();

}  // namespace etendue
