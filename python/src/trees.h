#pragma once
// Trees of components that Python builds. The language builds them from texts, which are finite and not too deep; assignments
// in Python could make a component a part of itself, or a chain of a million parts, and the library traverses trees
// recursively.

#include "binding.h"

namespace etendue::python {

/// Throws Error if a member's new value would make a component a part of itself. Components that the old value has, too, were
/// checked when they were set.
void refuse_cycle(const Component&, const Value& old, const Value& given);

/// Throws Error if parts are nested too deeply to be written, copied, compared or rendered. Called before that.
void require_shallow(const Component&);

/// Releases a component, and all parts that only it refers to, without recursion.
void release_tree(Ref<Component>);

}  // namespace etendue::python
