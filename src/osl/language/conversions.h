#pragma once
// Which values can stand for which types.

#include "tree.h"

namespace etendue::osl {

/// The same for all purposes of memory: equal, or triples of different kinds.
bool equivalent(const Type&, const Type&);

/// Whether a value can be assigned without a conversion in the text. A closure takes the number 0 besides, which types alone do
/// not tell.
bool assignable(const Type& to, const Type& from);

/// Whether `(to) value` exists.
bool castable(const Type& to, const Type& from);

/// How well an argument fits a parameter, 0 not at all. Of several functions that a call may mean, the one with the highest sum
/// is called: exact types first, then int for float, then an array for one of any length, then other conversions, among them
/// better a point for a vector than a point for a color.
int fit(const Type& parameter, const Type& argument);
inline constexpr int exact_fit = 100, number_fit = 77, array_fit = 44, kind_fit = 24, conversion_fit = 23, any_fit = 1;

/// Where nothing else decides between functions, their results do: float first, then int, color, vector, point, normal, matrix,
/// string, closures, structures, void.
int rank_of_result(const Type&);

}  // namespace etendue::osl
