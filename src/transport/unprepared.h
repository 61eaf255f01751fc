#pragma once
// Questions about objects that are not prepared, such as those that are imported or exported.

#include "etendue/scene_object.h"

namespace etendue {

/// Whether paths will enter an object (`enterable`, medium_stack.h): a copy of it is prepared and asked. False if it cannot be.
bool enterable_once_prepared(const SceneObject&);

}  // namespace etendue
