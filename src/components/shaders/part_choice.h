#pragma once
// Helpers of shaders that combine other shaders: choosing one of the parts, and null scattering.

#include "etendue/shader.h"

namespace etendue {

/// The unnormalized probability with which a part is chosen for sampling: its share times its albedo, which is raised by 0.01
/// because it is an estimate, and a part of estimated albedo 0 may still scatter. 0 if the part is null or has none of the
/// lobes.
inline float promise(const Scatter* part, float share, const Vector3& out, Lobes lobes) {
  if (!part || !part->has(lobes)) return 0;
  constexpr float unforeseen = 0.01f;
  return share * (part->albedo(out, lobes).average() + unforeseen);
}

/// `choice` rescaled to [0, 1) for reuse, after it has selected one of the intervals [0, split) and [split, 1).
inline float left_of_choice(float choice, float split) {
  const float rest = choice < split ? choice / split : (choice - split) / (1 - split);
  return clamp(rest, 0, one_minus_epsilon);
}

/// A sample of null scattering, which keeps the direction.
inline ScatterSample straight_on(const Vector3& out, const Spectrum& weight, float probability) {
  return {-out, weight, probability, null_scattering, 1, false};
}

/// The fraction of light that a part transmits by null scattering.
inline Spectrum straight_fraction(const Scatter* part, const Vector3& out, Transport transport) {
  if (!part || !part->has(null_scattering)) return {};
  const auto straight = part->sample(out, 0, {}, {transport, null_scattering});
  return straight ? straight->weight : Spectrum();
}

/// The interior index of a body whose boundary combines two shaders: that of the first one that refracts.
inline Spectrum interior_index_of(const Shader& first, const Shader& second, const Wavelengths& w) {
  const Spectrum index = first.interior_index(w);
  return index.minimum() == 1 && index.maximum() == 1 ? second.interior_index(w) : index;
}

}  // namespace etendue
