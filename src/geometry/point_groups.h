#pragma once
// Groups vertices of a triangle mesh that have the same position, and lists the triangle corners at each.

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "etendue/core/vector.h"

namespace etendue {

/// A hash of a position; -0 hashes like 0.
inline std::uint64_t place_hash(const Point3& p) {
  std::uint64_t h = std::bit_cast<std::uint32_t>(p.x + 0.0f);
  h = mix_bits((h << 32 | std::bit_cast<std::uint32_t>(p.y + 0.0f)) + 0x9e3779b97f4a7c15ull);
  return mix_bits(h ^ std::bit_cast<std::uint32_t>(p.z + 0.0f));
}

/// For each point, the index of the first point with the same position.
inline std::vector<std::uint32_t> first_in_place(std::span<const Point3> points) {
  constexpr std::uint32_t none = 0xffffffffu;
  const size_t mask = std::bit_ceil(2 * points.size() + 2) - 1;
  std::vector<std::uint32_t> table(mask + 1, none), first(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    size_t at = place_hash(points[i]) & mask;
    while (table[at] != none && !(points[table[at]] == points[i])) at = (at + 1) & mask;
    if (table[at] == none) table[at] = i;
    first[i] = table[at];
  }
  return first;
}

class PointGroups {
 public:
  PointGroups(std::span<const Point3> points, std::span<const std::array<std::uint32_t, 3>> triangles) {
    // Groups are numbered in the order of their first points, without gaps.
    std::vector<std::uint32_t> group = first_in_place(points);
    std::uint32_t groups = 0;
    for (std::uint32_t i = 0; i < group.size(); ++i) group[i] = group[i] == i ? groups++ : group[group[i]];
    start_.assign(groups + 1, 0);
    for (const auto& t : triangles)
      for (const std::uint32_t v : t) ++start_[group[v] + 1];
    for (size_t g = 0; g < groups; ++g) start_[g + 1] += start_[g];
    corners_.resize(start_.back());
    std::vector<std::uint64_t> next(start_.begin(), start_.end() - 1);
    for (std::uint64_t c = 0; c < 3 * triangles.size(); ++c) corners_[next[group[triangles[c / 3][c % 3]]]++] = c;
  }

  size_t size() const { return start_.size() - 1; }
  /// The corners in a group: corner k of triangle i is 3 i + k. Empty for a position that no triangle uses.
  std::span<const std::uint64_t> corners(size_t group) const {
    return {corners_.data() + start_[group], start_[group + 1] - start_[group]};
  }

 private:
  std::vector<std::uint64_t> start_, corners_;
};

}  // namespace etendue
