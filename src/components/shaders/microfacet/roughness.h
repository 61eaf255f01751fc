#pragma once
// Evaluation and checks of the roughness members of microfacet shaders.

#include "components/shaders/scalar_map.h"
#include "microfacet.h"

namespace etendue {

/// The distribution at a point; `roughness_v` may be null, and then equals `roughness`.
inline MicrofacetDistribution distribution_at(MicrofacetDistribution::Kind kind, const ObjectMap& roughness,
                                              const ObjectMap* roughness_v, const SurfacePoint& p) {
  const float x = roughness.scalar(p);
  return {kind, x, roughness_v ? roughness_v->scalar(p) : x};
}

/// Throws Error at a member whose map is missing (`roughness`), or is constant and outside [0, 1].
inline void require_roughness(const Component& owner, const Ref<ObjectMap>& roughness, const Ref<ObjectMap>& roughness_v) {
  require_scalar(owner, "roughness", roughness);
  if (roughness_v) require_scalar(owner, "roughness_v", roughness_v);
}

/// Whether the map is constant and equal to `value`.
inline bool everywhere(const Ref<ObjectMap>& map, float value) {
  const Color all = map->constant();
  return all && !all->varies() && all->at(550, ColorUse::reflectance) == value;
}

}  // namespace etendue
