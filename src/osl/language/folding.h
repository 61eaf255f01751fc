#pragma once
// Computes what is constant while the shader is compiled.

#include "tree.h"

namespace etendue::osl {

ExpressionPointer make_constant(Location, const Type&, const void* bytes);
ExpressionPointer make_constant(Location, int);
ExpressionPointer make_constant(Location, float);
ExpressionPointer make_constant(Location, const String*);
/// Zero, the empty string, or the null closure; for arrays and structures in each part.
Constant zero_constant(const Type&);

/// The expression itself, or the constant that it is when its operands are: arithmetic, conversions, aggregates, and functions
/// of the library that are pure.
ExpressionPointer fold(ExpressionPointer);

}  // namespace etendue::osl
