#pragma once
// Means of periodic functions over an interval, from their integrals.

#include "etendue/core/math.h"

namespace etendue {

/// The mean of a function of period 1 over [x - width / 2, x + width / 2]. `value` and `integral` (from 0) are called with
/// arguments in [0, 1); `whole` is the integral over a period. Intervals shorter than 1e-4 are evaluated as points, so that
/// differences of integrals do not lose precision.
template <class Value, class Integral>
float periodic_mean(float x, float width, float whole, Value value, Integral integral) {
  x -= std::floor(x);
  if (!(x < 1)) x = 0;  // rounded up, or NaN
  if (!(width > 1e-4f)) return value(x);
  if (!(width < 1e5f)) return whole;
  const auto from_zero = [&](float at) {
    const float periods = std::floor(at);
    return periods * whole + integral(std::min(at - periods, one_minus_epsilon));
  };
  return (from_zero(x + 0.5f * width) - from_zero(x - 0.5f * width)) / width;
}

/// The mean of a wave that is 1 in the first half of each period of length 2, and -1 in the second.
inline float square_wave_mean(float x, float width) {
  return periodic_mean(
      0.5f * x, 0.5f * width, 0, [](float t) { return t < 0.5f ? 1.0f : -1.0f; }, [](float t) { return t < 0.5f ? t : 1 - t; });
}

/// The mean of a pulse that is 1 in [begin, end] of each period of length 1, and else 0.
inline float pulse_mean(float x, float width, float begin, float end) {
  return periodic_mean(
      x, width, end - begin, [=](float t) { return t >= begin && t <= end ? 1.0f : 0.0f; },
      [=](float t) { return clamp(t, begin, end) - begin; });
}

}  // namespace etendue
