#pragma once
// Light that is given as an amount, such as a power.

#include "etendue/scene_object.h"

namespace etendue {

/// Whether an emission is given as an amount of light.
bool has_amount(const Component& emission);
/// What the amount multiplies the emission's radiance by; 1: none is given.
double strength_of(const SceneObject&, const Component& emission);

}  // namespace etendue
