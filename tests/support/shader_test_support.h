#pragma once
// What tests of shaders share.

#include "etendue/core/vector.h"

namespace etendue::test {

/// Towards the front of a frame, by polar angle [deg] and azimuth [rad].
inline Vector3 at_angle(const Frame& frame, double angle, double azimuth = 0.7) {
  const double t = angle * M_PI / 180;
  return frame.to_world({float(std::sin(t) * std::cos(azimuth)), float(std::sin(t) * std::sin(azimuth)), float(std::cos(t))});
}

}  // namespace etendue::test
