#pragma once
// What walks in path space choose among at a vertex, and how likely.

#include "etendue/transport/light_path.h"

namespace etendue {

/// All smooth lobes together, or a specular one.
inline constexpr Lobes lobe_groups[] = {smooth_lobes, specular_reflection, specular_transmission};

/// The probability of one of them, for a walk that came from `out`: in proportion to the light that it sends on.
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

/// Where a specular lobe leads.
inline std::optional<ScatterSample> follow_specular(const ChainVertex& v, const Vector3& out, Transport transport, Lobe lobe) {
  if (!v.scatter) return {};
  const auto s = v.scatter->sample(out, 0, {}, transport, lobe);
  if (!s || enters_subsurface(v.point, *s)) return {};
  if (s->pdf < 0.9999f)
    v.point.object->shader->fail({}, "sends light on in several specular directions, which PathSpaceMetropolis cannot follow");
  return s;
}

}  // namespace etendue
