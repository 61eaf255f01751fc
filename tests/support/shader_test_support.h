#pragma once
// Shared by tests of shaders.

#include "etendue/core/vector.h"

namespace etendue::test {

/// The direction at a polar angle [deg] and an azimuth [rad] in a frame.
inline Vector3 at_angle(const Frame& frame, double angle, double azimuth = 0.7) {
  const double t = angle * M_PI / 180;
  return frame.to_world({float(std::sin(t) * std::cos(azimuth)), float(std::sin(t) * std::sin(azimuth)), float(std::cos(t))});
}

}  // namespace etendue::test
