#pragma once
// Warnings about rotations between keys of a transform that are interpolated in another way than they are written.

#include <vector>

#include "syntax.h"

namespace etendue::language {

/// Stores the angle and the axis in the node of an evaluated call of `rotate`.
void note_turn(Node& rotate, const std::vector<Value>& arguments);

/// Warns if two keys of a call of `keyframes` are rotations about the same axis that are more than 180 degrees apart. The
/// interpolation between the two orientations takes the shorter way, since orientations do not contain whole turns.
bool warn_of_long_turns(const Node& keyframes);

}  // namespace etendue::language
