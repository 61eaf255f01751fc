#pragma once
// What shaders made of others share: choosing between parts, and sending light straight on.

#include "etendue/shader.h"

namespace etendue {

/// How much a part promises to bring, in proportion to which it is chosen: its share times its albedo, a little more than
/// that because albedos are estimates, and what is estimated to be nothing may be something. A part that is null or has none
/// of the lobes brings nothing.
inline float promise(const Scatter* part, float share, const Vector3& out, Lobes which) {
  if (!part || !part->has(which)) return 0;
  constexpr float unforeseen = 0.01f;
  return share * (part->albedo(out, which).average() + unforeseen);
}

/// The part of `choice` that is left after choosing between [0, split) and [split, 1), stretched over [0, 1) again.
inline float left_of_choice(float choice, float split) {
  const float rest = choice < split ? choice / split : (choice - split) / (1 - split);
  return clamp(rest, 0, one_minus_epsilon);
}

/// A sample that goes on as if nothing were there.
inline ScatterSample straight_on(const Vector3& out, const Spectrum& weight, float probability) {
  return {-out, weight, probability, null_scattering, 1, false};
}

/// The fraction of light a part lets pass straight on.
inline Spectrum straight_fraction(const Scatter* part, const Vector3& out, Transport transport) {
  if (!part || !part->has(null_scattering)) return {};
  const auto straight = part->sample(out, 0, {}, transport, null_scattering);
  return straight ? straight->weight : Spectrum();
}

/// The index inside of a body whose boundary is made of two shaders: of the first one that refracts.
inline Spectrum interior_index_of(const Shader& first, const Shader& second, const Wavelengths& w) {
  const Spectrum index = first.interior_index(w);
  return index.minimum() == 1 && index.maximum() == 1 ? second.interior_index(w) : index;
}

}  // namespace etendue
