#pragma once
// Regular expressions, by PCRE2: it needs no recursion, and gives up a match whose work explodes.

#include <string>

#include "osl/values/interned_string.h"

namespace etendue::osl {

/// Whether the pattern occurs in the subject, or matches it as a whole. `places` (may be null) gets pairs of the beginning and
/// end of the match and of its groups; where there is no group, the length of the pattern, as in the reference implementation.
/// A pattern that is wrong or takes too long sets `fault` and is not found.
bool find_regular_expression(const String& subject, const String& pattern, bool whole, int* places, int count,
                             std::string& fault);

}  // namespace etendue::osl
