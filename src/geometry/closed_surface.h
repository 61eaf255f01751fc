#pragma once
// What triangles enclose: whether they form a closed surface, and which volume is inside.

#include <array>
#include <cstdint>
#include <span>

#include "etendue/mesh_facts.h"

namespace etendue {

/// The length [m] up to which the coordinates of an object of this size are taken for 0. Programs that generate a sphere
/// compute its last vertices from sin(2 pi), which is -2e-16 instead of 0, so they do not coincide with the first.
float least_length(const Bounds3&);
/// Continues a hash by a position; `least` is the object's least_length.
std::uint64_t place_hash(std::uint64_t hash, const Point3&, float least);

/// Whether triangles form a closed, consistently oriented surface. `corner` gives the hash of a vertex' place, so that vertices
/// at one place are one corner: seams of texture coordinates are no holes. Every directed edge of such a surface has an
/// opposite, so the sum, in which the terms of an edge and of its opposite cancel, is zero; for an open surface it is zero with
/// probability 2^-64.
template <class Corner>
bool closed_surface(std::span<const std::array<std::uint32_t, 3>> triangles, const Corner& corner) {
  std::uint64_t sum = 0;
  for (const auto& t : triangles) {
    const std::uint64_t h[3] = {corner(t[0]), corner(t[1]), corner(t[2])};
    for (int i = 0; i < 3; ++i) {
      const std::uint64_t a = h[i], b = h[(i + 1) % 3];
      sum += mix_bits(3 * a + b) - mix_bits(3 * b + a);
    }
  }
  return sum == 0 && !triangles.empty();
}

/// The volume that a closed surface encloses [m^3]; negative if its triangles are clockwise as seen from outside.
double enclosed_volume(const TriangleView&);
/// Whether the surface is closed and its triangles are clockwise as seen from outside.
bool inside_out(const TriangleView&);

}  // namespace etendue
