#pragma once
// The closures that shaders can make: their signatures, for the compiler. What a renderer does with one is said elsewhere.

#include <span>

namespace etendue::osl {

/// A closure's constructor, "closure color diffuse(normal N)". In a call, pairs of a name and a value may follow the arguments:
/// `diffuse(N, "label", "coat")`.
struct ClosureSignature {
  const char* signature;
  /// The names and types of the optional pairs besides "label": "float thinfilm_thickness, float thinfilm_ior". Other names are
  /// accepted and have no effect, as in the reference implementation.
  const char* keywords = "";
};

/// ClosureShape::known is an index of this list.
std::span<const ClosureSignature> closures();

}  // namespace etendue::osl
