#pragma once
// The parser, by recursive descent: tokens to an untyped tree.

#include <span>

#include "preprocess.h"
#include "syntax.h"

namespace etendue::osl {

/// Nested expressions, and nested statements.
inline constexpr int most_nesting = 200;
/// Nodes on a way down an expression: `a + a + ...` nests to the left without brackets. Also branches of one `else if`.
inline constexpr int most_depth = 1000;

/// After an error the parser goes on behind the next semicolon or block, so that several errors are found in one run.
syntax::File parse(std::span<const Token>, Diagnostics&);

/// One declaration of a function: a signature of the library. Throws Error.
std::shared_ptr<syntax::FunctionDeclaration> parse_signature(const std::string&);

}  // namespace etendue::osl
