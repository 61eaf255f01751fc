#include "triangle_pairs.h"

#include <algorithm>

#include "etendue/scene.h"

namespace etendue {
namespace {

using Ints = std::int32_t __attribute__((vector_size(lanes * sizeof(std::int32_t))));

inline bool any_of(const Ints& mask) {
#if defined(__AVX__)
  return _mm256_movemask_ps(std::bit_cast<__m256>(mask)) != 0;
#else
  std::int32_t all = 0;
  for (int i = 0; i < lanes; ++i) all |= mask[i];
  return all != 0;
#endif
}

/// 1/x to about 2e-7: a division of all lanes would take as long as the rest of the test.
inline Floats reciprocal(const Floats& x) {
#if defined(__AVX512VL__)
  const Floats y = lanes_of(_mm256_rcp14_ps(raw(x)));
  return y * (2 - x * y);  // one step of Newton's method
#else
  return 1 / x;
#endif
}

/// The lane of the smallest value, the first of several.
inline int lowest_lane(const Floats& x) {
#if defined(__AVX__)
  const __m256 values = raw(x);
  __m256 low = _mm256_min_ps(values, _mm256_permute2f128_ps(values, values, 1));
  low = _mm256_min_ps(low, _mm256_permute_ps(low, 0b01001110));
  low = _mm256_min_ps(low, _mm256_permute_ps(low, 0b10110001));
  return std::countr_zero(compare<_CMP_EQ_OQ>(x, lanes_of(low)));
#else
  int lane = 0;
  for (int i = 1; i < lanes; ++i)
    if (x[i] < x[lane]) lane = i;
  return lane;
#endif
}

/// The ray in all lanes.
struct WideRay {
  Floats ox, oy, oz, dx, dy, dz;
  explicit WideRay(const Ray& r)
      : ox(Floats{} + r.origin.x),
        oy(Floats{} + r.origin.y),
        oz(Floats{} + r.origin.z),
        dx(Floats{} + r.direction.x),
        dy(Floats{} + r.direction.y),
        dz(Floats{} + r.direction.z) {}
};

// Moeller & Trumbore 1997, with the triangle's normal, as in objects/triangle_test.h. A point of the plane is A + u a + v b with
//     t = N.C / N.D,  u = b.R / N.D,  v = -a.R / N.D,   C = A - O,  R = C x D.
// Where u is negative, beyond the line AC, it is A + x b + y c with (b x c = k N, and the same formulas)
//     x = c.R / (k N.D),  y = -b.R / (k N.D) = -u / k.
// Triangles are taken a little wider than they are: by what the weights may be off, so that no ray slips between two that share
// an edge. The coordinates of C, R and the edges round by half a unit in the last place each, which makes an error of about
// 2 eps |C| |D| |e| / (N.D) of a weight: bounded where |C| is no more than the scene's diameter and the cosine no less than an
// eighth. Two triangles of a pair are told apart by one sign and need nothing between them.
/// Returns which are hit with t in (0, limit); x and y are the weights of B and C, or of C and D where `first` is false.
inline Ints test(const TrianglePairs::Block& s, const WideRay& r, const Floats& limit, Floats& t, Floats& x, Floats& y,
                 Ints& first) {
  const Floats cx = s.vx - r.ox, cy = s.vy - r.oy, cz = s.vz - r.oz;
  const Floats rx = cy * r.dz - cz * r.dy, ry = cz * r.dx - cx * r.dz, rz = cx * r.dy - cy * r.dx;
  const Floats inverse = reciprocal(s.nx * r.dx + s.ny * r.dy + s.nz * r.dz);
  t = (s.nx * cx + s.ny * cy + s.nz * cz) * inverse;
  const Floats u = (rx * s.bx + ry * s.by + rz * s.bz) * inverse;
  first = u >= s.side;
  const Floats v = -(rx * s.ax + ry * s.ay + rz * s.az) * inverse, beyond = (rx * s.cx + ry * s.cy + rz * s.cz) * inverse;
  x = first ? u : beyond;
  y = first ? v : u * s.turn;
  const Floats outer = first ? y : x;  // the other is known to be positive, or as good as that
  return (outer >= s.lowest) & (x + y <= s.most) & (t > 0) & (t < limit);
}

/// Which of `corners` is at p; -1: none.
int corner_at(const std::array<Point3, 3>& corners, const Point3& p) {
  for (int i = 0; i < 3; ++i)
    if (corners[size_t(i)] == p) return i;
  return -1;
}

struct Double3 {
  double x, y, z;
};
Double3 difference(const Point3& a, const Point3& b) {
  return {double(a.x) - double(b.x), double(a.y) - double(b.y), double(a.z) - double(b.z)};
}
Double3 cross(const Double3& a, const Double3& b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
double dot(const Double3& a, const Double3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
double length(const Double3& a) { return std::sqrt(dot(a, a)); }

/// Whether (A, B, C) and (A, C, D) may be tested as a pair. What they are off a common plane must count for nothing beside the
/// rounding of a point's coordinates, which a ray that leaves the surface allows for.
bool in_one_plane(const std::array<Point3, 4>& p) {
  const Double3 a = difference(p[1], p[0]), b = difference(p[2], p[0]), c = difference(p[3], p[0]);
  const Double3 n = cross(a, b), m = cross(b, c);
  if (!(dot(n, m) > 0)) return false;
  double furthest = 0;
  for (const Point3& q : p) furthest = std::max({furthest, std::abs(double(q.x)), std::abs(double(q.y)), std::abs(double(q.z))});
  const double allowed = 0x1p-28 * furthest;
  return std::abs(dot(n, c)) <= allowed * length(n) && std::abs(dot(m, a)) <= allowed * length(m);
}

}  // namespace

void TrianglePairs::clear() {
  blocks_.clear();
  slots_.clear();
}

void TrianglePairs::add(const SceneObject& object, const TriangleView& view, float diameter) {
  const size_t count = view.triangles.size();
  const auto corners_of = [&](size_t i) {
    const auto& t = view.triangles[i];
    return std::array{view.positions[t[0]], view.positions[t[1]], view.positions[t[2]]};
  };
  constexpr size_t nearby = 8;  // partners follow each other in what modellers write
  std::vector<bool> taken(count);
  for (size_t i = 0; i < count; ++i) {
    if (taken[i]) continue;
    const std::array<Point3, 3> mine = corners_of(i);
    bool paired = false;
    for (size_t j = i + 1; j < std::min(i + 1 + nearby, count) && !paired; ++j) {
      if (taken[j]) continue;
      const std::array<Point3, 3> its = corners_of(j);
      // B is the corner of mine that the other lacks, D the one of its.
      for (int b = 0; b < 3 && !paired; ++b) {
        const int c = (b + 1) % 3, a = (b + 2) % 3;
        const int its_a = corner_at(its, mine[size_t(a)]), its_c = corner_at(its, mine[size_t(c)]);
        if (its_a < 0 || its_c < 0 || its_a == its_c) continue;
        const int its_d = 3 - its_a - its_c;
        const std::array corners{mine[size_t(a)], mine[size_t(b)], mine[size_t(c)], its[size_t(its_d)]};
        if (!in_one_plane(corners)) continue;
        // Which weight a corner of theirs has: 0 for A, then 1 and 2.
        const auto mine_is = [&](int corner) { return std::uint8_t(corner == a ? 0 : corner == b ? 1 : 2); };
        const auto its_is = [&](int corner) { return std::uint8_t(corner == its_a ? 0 : corner == its_c ? 1 : 2); };
        add_lane(object, corners, true,
                 {{{std::uint32_t(i), mine_is(1), mine_is(2)}, {std::uint32_t(j), its_is(1), its_is(2)}}}, diameter);
        taken[j] = paired = true;
      }
    }
    if (!paired) add_lane(object, {mine[0], mine[1], mine[2], mine[0]}, false, {{{std::uint32_t(i)}, {}}}, diameter);
  }
}

void TrianglePairs::add_lane(const SceneObject& object, const std::array<Point3, 4>& p, bool pair,
                             const std::array<Part, 2>& parts, float diameter) {
  const size_t lane = slots_.size() % lanes;
  if (lane == 0) blocks_.emplace_back();
  slots_.push_back({&object, parts});
  Block& s = blocks_.back();
  const Double3 a = difference(p[1], p[0]), b = difference(p[2], p[0]), c = difference(p[3], p[0]), n = cross(a, b);
  const double area = length(n), second = length(cross(b, c)), k = pair ? second / area : 1;
  const auto put = [lane](Floats& x, Floats& y, Floats& z, const Double3& v) {
    x[lane] = float(v.x);
    y[lane] = float(v.y);
    z[lane] = float(v.z);
  };
  put(s.vx, s.vy, s.vz, {p[0].x, p[0].y, p[0].z});
  put(s.ax, s.ay, s.az, a);
  put(s.bx, s.by, s.bz, b);
  put(s.cx, s.cy, s.cz, {c.x / k, c.y / k, c.z / k});
  put(s.nx, s.ny, s.nz, n);
  constexpr double greatest = 1e-4;  // of slivers
  const double edge = std::max(std::max(length(a), length(b)) / area, pair ? std::max(length(b), length(c)) / second : 0);
  const float slack = float(std::min(double(rounding_bound(16)) * diameter * edge, greatest));
  s.lowest[lane] = -slack;
  s.most[lane] = 1 + slack;
  // One alone has nothing beyond AC but its slack: y becomes far too large there.
  s.side[lane] = pair ? 0 : -slack;
  s.turn[lane] = pair ? float(-1 / k) : -1e30f;
}

inline void TrianglePairs::set(Hit& hit, size_t block, size_t lane, int part, float t, float x, float y) const {
  const Slot& slot = slots_[block * lanes + lane];
  const Part& triangle = slot.parts[size_t(part)];
  const float weights[3] = {1 - x - y, x, y};
  hit.distance = t;
  hit.object = slot.object;
  hit.primitive = triangle.primitive;
  hit.u = weights[triangle.second];
  hit.v = weights[triangle.third];
  hit.depth = 0;
}

bool TrianglePairs::nearest(const Ray& ray, Hit& hit) const {
  const WideRay wide(ray);
  Floats best = Floats{} + ray.maximum, best_x{}, best_y{};
  Ints where = Ints{} - 1;
  std::int32_t number = 0;  // twice the block's, and one more for the second triangle
  for (const Block& block : blocks_) {
    Floats t, x, y;
    Ints first;
    const Ints mask = test(block, wide, best, t, x, y, first);
    best = mask ? t : best;
    best_x = mask ? x : best_x;
    best_y = mask ? y : best_y;
    where = mask ? (Ints{} + (number + 1)) + first : where;  // true is -1
    number += 2;
  }
  const int lane = lowest_lane(best);
  const std::int32_t found = where[lane];
  if (found < 0) return false;
  set(hit, size_t(found) / 2, size_t(lane), found % 2, best[lane], best_x[lane], best_y[lane]);
  return true;
}

bool TrianglePairs::any(const Ray& ray) const {
  const WideRay wide(ray);
  const Floats limit = Floats{} + ray.maximum;
  // A few blocks at a time without a branch, which would be guessed wrongly too often.
  constexpr size_t group = 8;
  for (size_t i = 0; i < blocks_.size(); i += group) {
    Ints hit{};
    for (size_t k = i; k < std::min(i + group, blocks_.size()); ++k) {
      Floats t, x, y;
      Ints first;
      hit |= test(blocks_[k], wide, limit, t, x, y, first);
    }
    if (any_of(hit)) return true;
  }
  return false;
}

void TrianglePairs::all(const Ray& ray, HitList& list) const {
  const WideRay wide(ray);
  for (size_t i = 0; i < blocks_.size(); ++i) {
    Floats t, x, y;
    Ints first;
    const Ints mask = test(blocks_[i], wide, Floats{} + ray.maximum, t, x, y, first);
    for (size_t lane = 0; lane < size_t(lanes) && any_of(mask); ++lane) {
      if (!mask[lane]) continue;
      Hit hit;
      set(hit, i, lane, first[lane] ? 0 : 1, t[lane], x[lane], y[lane]);
      list.add(hit);
    }
  }
}

}  // namespace etendue
