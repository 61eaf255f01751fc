#pragma once
// The closures that shaders can make: their signatures, for the compiler, and how nodes are made as a shader runs. What a
// renderer does with a closure is said elsewhere.

#include <span>

#include "call.h"
#include "osl/values/closure.h"

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

/// Runs a constructor. The call's arguments are those of the shape in order, with each keyword's string before its value. The
/// node lives in Services::allocate's memory, and refers to the shape.
const ClosureNode* make_component(const Call&, const ClosureShape&);
/// a + b; either may be null.
const ClosureNode* make_sum(Services&, const ClosureNode* a, const ClosureNode* b);
/// weight * closure; null if either is zero.
const ClosureNode* make_product(Services&, const Triple& weight, const ClosureNode* closure);
const ClosureNode* make_product(Services&, const Spectrum& weight, const ClosureNode* closure);

}  // namespace etendue::osl
