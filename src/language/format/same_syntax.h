#pragma once
// Whether two texts were read as the same, wherever in them it stands.

#include "language/syntax.h"

namespace etendue::language {

bool same_syntax(const Node&, const Node&);
bool same_syntax(const Document&, const Document&);

}  // namespace etendue::language
