#pragma once
// A render description in one layout, whatever layout it had: the lines and the comments are the author's, indentation and
// blanks are not.

#include <string>

#include "language/source.h"

namespace etendue::language {

/// The text in the layout of docs/language.md. Throws Errors where it cannot be read. What comes out is read as what went in,
/// has the same comments, and comes out again as it is: this is verified, and Error thrown if it is not so.
std::string formatted(const Source&);

}  // namespace etendue::language
