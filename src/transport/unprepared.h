#pragma once
// Properties of objects that are not prepared, such as those that are imported or exported.

#include "etendue/scene_object.h"

namespace etendue {

/// Whether paths can enter an object (`enterable`, medium_stack.h), found by preparing a copy of it. False if it cannot be
/// prepared.
bool enterable_once_prepared(const SceneObject&);

}  // namespace etendue
