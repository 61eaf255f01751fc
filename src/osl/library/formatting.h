#pragma once
// Text by a format in the manner of C's printf.

#include <string>

#include "call.h"

namespace etendue::osl {

/// The text of a call whose argument `format` is the format and whose further ones are the values. A conversion takes one
/// argument: of a triple, matrix or array it is repeated for each number, with spaces between. A conversion that does not suit
/// the argument's type is replaced by one that does: %d for ints, %f for floats, %s for strings and closures. A conversion
/// without an argument is written as it stands. The text is cut at string_limit.
std::string formatted(const Call&, int format);

}  // namespace etendue::osl
