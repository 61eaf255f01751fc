#pragma once
// Compares the syntax of two texts, regardless of locations.

#include "language/syntax.h"

namespace etendue::language {

bool same_syntax(const Node&, const Node&);
bool same_syntax(const Document&, const Document&);

}  // namespace etendue::language
