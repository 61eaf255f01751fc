#pragma once
// Formats a render description in the standard layout: lines and comments are kept, indentation and blanks are replaced.

#include <string>

#include "language/source.h"

namespace etendue::language {

/// The text in the layout of docs/language.md. Throws Errors if it cannot be parsed. The result has the same syntax and
/// comments, and formatting it again changes nothing; this is verified, and Error is thrown otherwise.
std::string formatted(const Source&);

}  // namespace etendue::language
