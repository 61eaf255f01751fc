#pragma once
// The lobes that walks in path space sample at a vertex, and their probabilities.

#include "etendue/transport/light_path.h"

namespace etendue {

/// A walk chooses between all smooth lobes together and each specular lobe.
inline constexpr Lobes lobe_groups[] = {smooth_lobes, specular_reflection, specular_transmission};

/// The probability of a group for a walk that came from `out`: in proportion to its albedo.
inline double lobe_share(const ChainVertex& v, const Vector3& out, Lobes group) {
  if (!v.scatter || !v.scatter->has(group)) return 0;
  if (!v.scatter->has(Lobes(vertex_lobes & ~group))) return 1;
  double sum = 0, own = 0;
  for (const Lobes each : lobe_groups) {
    const auto light = double(v.scatter->albedo(out, each).average());
    sum += light;
    if (each == group) own = light;
  }
  return sum > 0 ? own / sum : 0;
}

/// The direction and weight of a specular lobe. Empty: it scatters nothing, or enters an object with subsurface scattering.
/// Throws Error if the lobe has several directions.
inline std::optional<ScatterSample> follow_specular(const ChainVertex& v, const Vector3& out, Transport transport, Lobe lobe) {
  if (!v.scatter) return {};
  const auto s = v.scatter->sample(out, 0, {}, {transport, lobe});
  if (!s || enters_subsurface(v.point, *s)) return {};
  if (s->pdf < 0.9999f)
    v.point.object->shader->fail({}, "sends light on in several specular directions, which PathSpaceMetropolis cannot follow");
  return s;
}

}  // namespace etendue
