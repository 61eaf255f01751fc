#pragma once
// Emission given as an amount of light, such as a power.

#include "etendue/scene_object.h"

namespace etendue {

/// Whether an emission is given as an amount of light.
bool has_amount(const Component& emission);
/// The factor by which the amount multiplies the emission's radiance; 1 if none is given.
double strength_of(const SceneObject&, const Component& emission);

}  // namespace etendue
