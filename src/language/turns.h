#pragma once
// Turns between keys of a transform that go another way than they are written.

#include <vector>

#include "syntax.h"

namespace etendue::language {

/// Keeps in the node of a call to `rotate`, which was evaluated, how far and about what it turns.
void note_turn(Node& rotate, const std::vector<Value>& arguments);

/// Warns where two keys of a call to `keyframes` are written as turns about one axis that are more than 180 degrees apart: what
/// is interpolated are the rotations, which do not say how often they went round, and goes the shorter way.
bool warn_of_long_turns(const Node& keyframes);

}  // namespace etendue::language
