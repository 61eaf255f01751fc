#pragma once
// Conversions of attributes' values to what a shader asks for.

#include "osl/values/type.h"

namespace etendue::osl {

/// Stores a value as another type, if the language's getattribute converts so: equal types; int to float; float to int,
/// truncated; int or float to a triple, replicated; any triple to any other, also arrays of them; int or float to float[2],
/// replicated; float[2] to a triple, with 0 as the third; float[3] to a triple and back; float[4] to a triple without the last.
/// Without derivatives of its own (`from_derivatives`), those of the target (`to_derivatives`) are zero. Returns false, and
/// stores nothing, for other types.
bool convert_value(const Type& from, bool from_derivatives, const void* value, const Type& to, bool to_derivatives, void* out);

}  // namespace etendue::osl
