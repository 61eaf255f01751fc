#pragma once
// Boundary: what a closure says of a dielectric boundary.

#include "components/shaders/microfacet/microfacet.h"
#include "osl/values/triple.h"

namespace etendue::osl {

class Gathering;

/// `relative`: the index is that of the back side over that of the front side; else that of the inside, and the medium outside
/// is what the path is in.
struct Boundary {
  Triple normal, tangent, reflection_tint{1}, transmission_tint{1};
  float roughness_x = 0, roughness_y = 0, index = 1.5f;
  MicrofacetDistribution::Kind kind = MicrofacetDistribution::ggx;
  bool relative = false;

  MicrofacetDistribution facets() const { return {kind, roughness_x, roughness_y}; }
  /// Whether both are of the same facets between the same media.
  bool same_place(const Boundary& b) const {
    return normal == b.normal && roughness_x == b.roughness_x && roughness_y == b.roughness_y && kind == b.kind &&
           index == b.index && relative == b.relative && (roughness_x == roughness_y || tangent == b.tangent);
  }
};

/// Adds a boundary, or one side of it where a tint is black. The two sides of one boundary are one part of the mixture, in
/// whatever closures they are named.
void add_boundary(Gathering&, const Boundary&);

}  // namespace etendue::osl
