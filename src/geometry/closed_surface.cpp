#include "closed_surface.h"

#include <bit>
#include <cmath>

namespace etendue {

float least_length(const Bounds3& bounds) {
  constexpr float fraction = 1e-9f;
  return fraction * length(bounds.high - bounds.low);
}

std::uint64_t place_hash(std::uint64_t hash, const Point3& p, float least) {
  const auto bits = [least](float x) { return std::bit_cast<std::uint32_t>(std::abs(x) <= least ? 0.0f : x); };
  hash = mix_bits(hash ^ bits(p.x));
  hash = mix_bits((hash << 32 | bits(p.y)) + 0x9e3779b97f4a7c15ull);
  return mix_bits(hash ^ bits(p.z));
}

// The sum of the signed volumes of the tetrahedra between each triangle and one point.
double enclosed_volume(const TriangleView& view) {
  if (view.triangles.empty()) return 0;
  const DoublePoint3 apex(view.positions[view.triangles.front()[0]]);
  double sum = 0;
  for (const auto& t : view.triangles) {
    const auto edge = [&](std::uint32_t vertex) { return DoublePoint3(view.positions[vertex]) - apex; };
    sum += dot(edge(t[0]), cross(edge(t[1]), edge(t[2])));
  }
  return sum / 6;
}

bool inside_out(const TriangleView& view) {
  if (!(enclosed_volume(view) < 0)) return false;
  Bounds3 bounds;
  for (const auto& t : view.triangles)
    for (const std::uint32_t vertex : t) bounds.add(view.positions[vertex]);
  const float least = least_length(bounds);
  return closed_surface(view.triangles, [&](std::uint32_t vertex) { return place_hash(0, view.positions[vertex], least); });
}

}  // namespace etendue
