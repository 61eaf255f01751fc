#pragma once
// The table of the standard library's functions: their signatures as a shader would declare them, and their code.

#include <span>

#include "call.h"

namespace etendue::osl {

/// How a function treats derivatives.
enum class Derivatives : unsigned char {
  /// The result's derivatives follow from the arguments': to know them, the arguments must have them.
  passed,
  /// The result (and each output argument) is constant over the picture, or no number: its derivatives are zero.
  none,
  /// The value of the result depends on the arguments' derivatives (Dx, filterwidth, area, texture, "gabor" noise ...): float
  /// based
  /// arguments must have derivatives. If the result has to have derivatives, they are those of `passed` where they can be
  /// known,
  /// else zero.
  taken,
};

/// One function, or a family of functions.
///
/// The signature is a declaration in the language, "float dot(vector a, vector b)", `output` before parameters that are
/// written. These words stand for types:
///   TYPE    float, color, point, vector, normal: the same in the whole signature
///   TRIPLE  color, point, vector, normal: the same in the whole signature
///   PTYPE   point, vector, normal: the same in the whole signature
///   ANY     any type, also arrays and closures; a second ANY may be another type
///   `T[]`   an array of any length
///   `...`   at the end: any number of further arguments, of any types; with `output ...` they may be written
/// Where two rows fit a call, the rules of the language choose; of several that fit equally, the first in the table.
struct Row {
  const char* signature;
  /// The code for a call of these types, chosen once, when the shader is compiled. Null for a function that is part of the
  /// language, which the compiler translates itself (isconnected, isconstant, exit): the row gives its signature.
  Evaluate (*choose)(const CallTypes&);
  Derivatives derivatives = Derivatives::passed;
  /// Indices, as bits, of the parameters whose derivatives are `taken`; all if 0.
  unsigned taken = 0;
  /// If not null, calls are an error, and this is the reason.
  const char* refused = nullptr;
  /// Whether the same arguments always give the same result, without any effect, so that a call with constant arguments may be
  /// computed when the shader is compiled.
  bool pure = true;
};

/// All functions except closures' constructors, which closures.h lists. It lives as long as the process.
std::span<const Row> library_rows();

}  // namespace etendue::osl
