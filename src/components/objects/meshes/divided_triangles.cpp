// DividedTriangles: subdivision of triangles by halving edges.

#include <bit>
#include <cmath>

#include "displacement.h"
#include "etendue/core/error.h"

namespace etendue {
namespace {

constexpr size_t most_triangles = size_t(1) << 26;  // about 8 GB during construction

/// A hash table of numbers by pair of vertices, with open addressing.
class EdgeTable {
 public:
  explicit EdgeTable(size_t most) : mask_(std::bit_ceil(2 * most + 2) - 1), keys_(mask_ + 1), values_(mask_ + 1) {}

  /// The entry for an edge; `fresh` is set if the edge is new.
  std::uint32_t& find(std::uint32_t a, std::uint32_t b, bool& fresh) {
    // The two vertices differ, so the key 0 is free to mark empty entries.
    const std::uint64_t key = std::uint64_t(std::max(a, b)) << 32 | std::min(a, b);
    size_t at = mix_bits(key) & mask_;
    while (keys_[at] != 0 && keys_[at] != key) at = (at + 1) & mask_;
    fresh = keys_[at] == 0;
    keys_[at] = key;
    return values_[at];
  }

 private:
  size_t mask_;
  std::vector<std::uint64_t> keys_;
  std::vector<std::uint32_t> values_;
};

[[noreturn]] void too_many(double count) {
  throw Error("there would be about " + std::to_string(std::uint64_t(count)) + " triangles, more than the " +
              std::to_string(most_triangles) + " there may be");
}

}  // namespace

DividedTriangles::DividedTriangles(const TriangleView& view)
    : positions(view.positions.begin(), view.positions.end()), triangles(view.triangles.begin(), view.triangles.end()) {}

DividedTriangles::Place DividedTriangles::place(size_t triangle, float u, float v) const {
  if (within_.empty()) return {std::uint32_t(triangle), u, v};
  const Within& w = within_[triangle];
  const auto blend = [&](size_t k) {
    return (1 - u - v) * float(w.corners[0][k]) + u * float(w.corners[1][k]) + v * float(w.corners[2][k]);
  };
  constexpr float unit = 1.0f / (1 << most_halvings);
  return {w.triangle, unit * blend(0), unit * blend(1)};
}

bool DividedTriangles::divide(int levels, float edge_length) {
  if (const double all = std::ldexp(double(triangles.size()), 2 * levels); all > double(most_triangles)) too_many(all);
  for (int i = 0; i < levels && halvings_ < most_halvings; ++i) halve(0);
  if (!(edge_length > 0)) return true;
  while (halvings_ < most_halvings)
    if (!halve(edge_length)) return true;
  const auto longer = [&](const auto& t) {
    for (size_t i = 0; i < 3; ++i)
      if (distance(positions[t[i]], positions[t[(i + 1) % 3]]) > edge_length) return true;
    return false;
  };
  return std::none_of(triangles.begin(), triangles.end(), longer);
}

bool DividedTriangles::halve(float longer_than) {
  const float limit = longer_than * longer_than;
  // The squared distance is bitwise the same for both directions of an edge.
  const auto marked = [&](std::uint32_t a, std::uint32_t b) { return distance_squared(positions[a], positions[b]) > limit; };
  size_t cuts = 0;
  for (const auto& t : triangles) cuts += size_t(marked(t[0], t[1])) + size_t(marked(t[1], t[2])) + size_t(marked(t[2], t[0]));
  if (cuts == 0) return false;
  if (triangles.size() + cuts > most_triangles) too_many(double(triangles.size() + cuts));
  if (within_.empty()) {
    constexpr std::uint16_t one = 1 << most_halvings;
    within_.reserve(triangles.size() + cuts);
    for (size_t i = 0; i < triangles.size(); ++i) within_.push_back({std::uint32_t(i), {{{0, 0}, {one, 0}, {0, one}}}});
  }
  ++halvings_;

  EdgeTable middles(cuts);
  std::vector<std::array<std::uint32_t, 3>> parts;
  std::vector<Within> parts_within;
  parts.reserve(triangles.size() + cuts);
  parts_within.reserve(triangles.size() + cuts);
  positions.reserve(positions.size() + cuts / 2 + cuts / 64 + 16);
  for (size_t i = 0; i < triangles.size(); ++i) {
    // Corners 0 to 2; 3 + k is the midpoint of the edge that begins at corner k.
    std::array<std::uint32_t, 6> vertex;
    std::array<std::array<std::uint16_t, 2>, 6> place;
    bool cut[3];
    for (size_t k = 0; k < 3; ++k) {
      vertex[k] = triangles[i][k];
      place[k] = within_[i].corners[k];
    }
    for (size_t k = 0; k < 3; ++k) {
      const size_t l = (k + 1) % 3;
      const std::uint32_t a = vertex[k], b = vertex[l];
      cut[k] = marked(a, b);
      if (!cut[k]) continue;
      bool fresh = false;
      std::uint32_t& middle = middles.find(a, b, fresh);
      if (fresh) {
        const Point3 p = positions[a], q = positions[b];
        middle = std::uint32_t(positions.size());
        positions.push_back({0.5f * (p.x + q.x), 0.5f * (p.y + q.y), 0.5f * (p.z + q.z)});
      }
      vertex[3 + k] = middle;
      for (size_t c = 0; c < 2; ++c) place[3 + k][c] = std::uint16_t((int(place[k][c]) + int(place[l][c])) / 2);
    }
    const auto add = [&](size_t a, size_t b, size_t c) {
      parts.push_back({vertex[a], vertex[b], vertex[c]});
      parts_within.push_back({within_[i].triangle, {place[a], place[b], place[c]}});
    };
    const int count = int(cut[0]) + int(cut[1]) + int(cut[2]);
    if (count == 0) {
      add(0, 1, 2);
    } else if (count == 3) {
      add(0, 3, 5);
      add(3, 1, 4);
      add(5, 4, 2);
      add(3, 4, 5);
    } else if (count == 1) {
      const size_t k = cut[0] ? 0 : (cut[1] ? 1 : 2), l = (k + 1) % 3, m = (k + 2) % 3;
      add(k, 3 + k, m);
      add(3 + k, l, m);
    } else {  // all but the edge from corner k: a triangle at the far corner, and a quadrilateral along its shorter diagonal
      const size_t k = !cut[0] ? 0 : (!cut[1] ? 1 : 2), l = (k + 1) % 3, m = (k + 2) % 3;
      add(3 + l, m, 3 + m);
      const auto apart = [&](size_t a, size_t b) { return distance_squared(positions[vertex[a]], positions[vertex[b]]); };
      if (apart(k, 3 + l) < apart(l, 3 + m)) {
        add(k, l, 3 + l);
        add(k, 3 + l, 3 + m);
      } else {
        add(k, l, 3 + m);
        add(l, 3 + l, 3 + m);
      }
    }
  }
  triangles = std::move(parts);
  within_ = std::move(parts_within);
  return true;
}

}  // namespace etendue
