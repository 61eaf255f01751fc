#pragma once
// The lexer: what a token's text means.

#include "preprocess.h"

namespace etendue::osl {

/// Appends the token, or several, that the preprocessor's token is: it reads C, whose numbers and strings are more than ours.
void append_token(const std::string& text, Location, std::vector<Token>&, Diagnostics&);

/// Adjacent strings become one.
void join_texts(std::vector<Token>&);

}  // namespace etendue::osl
