#include "triangle_pairs.h"

#include <algorithm>

#include "etendue/scene.h"

namespace etendue {
namespace {

// Mask: the result of a comparison in all lanes.
#if defined(__AVX512VL__)
using Mask = __mmask8;
inline Mask below(const Floats& a, const Floats& b) { return _mm256_cmp_ps_mask(raw(a), raw(b), _CMP_LT_OQ); }
inline Mask and_at_most(Mask m, const Floats& a, const Floats& b) {
  return _mm256_mask_cmp_ps_mask(m, raw(a), raw(b), _CMP_LE_OQ);
}
inline Floats choose(Mask m, const Floats& yes, const Floats& no) {
  return lanes_of(_mm256_mask_blend_ps(m, raw(no), raw(yes)));
}
inline bool any_of(Mask m) { return m != 0; }
inline bool in(Mask m, size_t lane) { return (m >> lane & 1) != 0; }
#else
using Mask = std::int32_t __attribute__((vector_size(lanes * sizeof(std::int32_t))));
inline Mask below(const Floats& a, const Floats& b) { return a < b; }
inline Mask and_at_most(const Mask& m, const Floats& a, const Floats& b) { return m & (a <= b); }
inline Floats choose(const Mask& m, const Floats& yes, const Floats& no) { return m ? yes : no; }
inline bool in(const Mask& m, size_t lane) { return m[lane] != 0; }
inline bool any_of(const Mask& m) {
#if defined(__AVX__)
  return _mm256_movemask_ps(std::bit_cast<__m256>(m)) != 0;
#else
  std::int32_t all = 0;
  for (int i = 0; i < lanes; ++i) all |= m[i];
  return all != 0;
#endif
}
#endif

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

/// A ray, copied to all lanes.
struct WideRay {
  Floats ox, oy, oz, dx, dy, dz;
  explicit WideRay(const Ray& r)
      : ox(spread(r.origin.x)),
        oy(spread(r.origin.y)),
        oz(spread(r.origin.z)),
        dx(spread(r.direction.x)),
        dy(spread(r.direction.y)),
        dz(spread(r.direction.z)) {}
};

/// The intersections of a ray with planes: at distance t, at the point A + u a + v b = A + x b + y c with y = -u / k.
struct Met {
  Floats t, u, v, x;
};

// The ray O + t D hits the plane at t = N.C / N.D with C = A - O, at Q = t D - C from A. With g_a and g_b the vectors of the
// plane for which g_a.a = g_b.b = 1 and g_a.b = g_b.a = 0, this point is A + u a + v b for u = g_a.Q and v = g_b.Q. It is also
// A + x b + y c with x = h.Q (h.b = 1, h.c = 0) and y = -u / k, since a is -k c plus a vector along b. The quadrilateral is
// convex: inside it u and y may have any sign, v and x are not negative, and neither u + v nor x + y exceeds 1. (Moeller &
// Trumbore 1997 compute the same with less storage and more operations; here the latency of one ray counts, as the next segment
// of its path waits for it.)
//
// The shape is enlarged by the error of the weights, so that no ray passes between two shapes that share an edge. The
// coordinates of C and Q and those of the vectors g are rounded by half a unit in the last place each, which causes an error of
// about 2 eps |C| |g| / cos of a weight: it is bounded where |C| is no more than the scene's diameter and the cosine no less
// than an eighth. Between the two triangles of a pair there is no gap.
/// Returns which are hit with t > 0.
inline Mask test(const TrianglePairs::Block& s, const WideRay& r, Met& m) {
  const Floats cx = s.vx - r.ox, cy = s.vy - r.oy, cz = s.vz - r.oz;
  m.t = (s.nx * cx + s.ny * cy + s.nz * cz) / (s.nx * r.dx + s.ny * r.dy + s.nz * r.dz);
  const Floats qx = m.t * r.dx - cx, qy = m.t * r.dy - cy, qz = m.t * r.dz - cz;
  m.u = s.ax * qx + s.ay * qy + s.az * qz;
  m.v = s.bx * qx + s.by * qy + s.bz * qz;
  m.x = s.cx * qx + s.cy * qy + s.cz * qz;
  const Floats least = smaller(m.v, m.x), greatest = larger(m.u + m.v, m.x + m.u * s.turn);
  return and_at_most(and_at_most(below(Floats{}, m.t), s.lowest, least), greatest, s.most);
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
Double3 cross(const Double3& a, const Double3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double dot(const Double3& a, const Double3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Double3 scaled(const Double3& a, double s) { return {a.x * s, a.y * s, a.z * s}; }
double length(const Double3& a) { return std::sqrt(dot(a, a)); }

/// Whether (A, B, C) and (A, C, D) may be tested as a pair: they form a convex quadrilateral. Their deviation from a common
/// plane must be negligible beside the rounding of a point's coordinates, for which rays that leave the surface are offset.
bool make_a_pair(const std::array<Point3, 4>& p) {
  const Double3 a = difference(p[1], p[0]), b = difference(p[2], p[0]), c = difference(p[3], p[0]);
  const Double3 n = cross(a, b), m = cross(b, c);
  if (!(dot(n, m) > 0)) return false;
  const Double3 edge = difference(p[2], p[1]), other = difference(p[3], p[2]);
  if (!(dot(cross(edge, other), n) > 0 && dot(cross(a, c), n) > 0)) return false;  // not convex
  double furthest = 0;
  for (const Point3& q : p)
    furthest = std::max({furthest, std::abs(double(q.x)), std::abs(double(q.y)), std::abs(double(q.z))});
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
  constexpr size_t nearby = 8;  // modelling programs write the two triangles of a quadrilateral close to each other
  std::vector<bool> taken(count);
  for (size_t i = 0; i < count; ++i) {
    if (taken[i]) continue;
    const std::array<Point3, 3> mine = corners_of(i);
    bool paired = false;
    for (size_t j = i + 1; j < std::min(i + 1 + nearby, count) && !paired; ++j) {
      if (taken[j]) continue;
      const std::array<Point3, 3> its = corners_of(j);
      // B is the corner of triangle i that j does not have, D the corner of j that i does not have.
      for (int b = 0; b < 3 && !paired; ++b) {
        const int c = (b + 1) % 3, a = (b + 2) % 3;
        const int its_a = corner_at(its, mine[size_t(a)]), its_c = corner_at(its, mine[size_t(c)]);
        if (its_a < 0 || its_c < 0 || its_a == its_c) continue;
        const int its_d = 3 - its_a - its_c;
        const std::array corners{mine[size_t(a)], mine[size_t(b)], mine[size_t(c)], its[size_t(its_d)]};
        if (!make_a_pair(corners)) continue;
        // The index of the weight of a triangle's corner: 0 for A, then 1 and 2.
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
  const bool straight = parts[0].second == 1 && parts[0].third == 2 && parts[1].second == 1 && parts[1].third == 2;
  slots_.push_back({&object, parts, !pair, straight});
  Block& s = blocks_.back();
  const Double3 a = difference(p[1], p[0]), b = difference(p[2], p[0]), c = difference(p[3], p[0]), n = cross(a, b);
  const double area = length(n), second = length(cross(b, c)), k = pair ? second / area : 1;
  const auto put = [lane](Floats& x, Floats& y, Floats& z, const Double3& v) {
    x[lane] = float(v.x);
    y[lane] = float(v.y);
    z[lane] = float(v.z);
  };
  put(s.vx, s.vy, s.vz, {p[0].x, p[0].y, p[0].z});
  const Double3 g_a = scaled(cross(b, n), 1 / dot(n, n)), g_b = scaled(cross(n, a), 1 / dot(n, n));
  // h = c x m / m.m with m = b x c = k n, and zero for a single triangle.
  const Double3 h = pair ? scaled(cross(c, n), 1 / (k * dot(n, n))) : Double3{};
  put(s.ax, s.ay, s.az, g_a);
  put(s.bx, s.by, s.bz, g_b);
  put(s.cx, s.cy, s.cz, h);
  put(s.nx, s.ny, s.nz, n);
  constexpr double greatest = 1e-4;  // limit of the slack, for slivers
  const double steepest = std::max({length(g_a), length(g_b), length(h), length(g_a) / k});
  const float slack = float(std::min(double(rounding_bound(16)) * diameter * steepest, greatest));
  s.lowest[lane] = -slack;
  s.most[lane] = 1 + slack;
  // A single triangle ends at AC, where u = 0: with this value x + y exceeds its limit once u is less than -slack.
  s.turn[lane] = pair ? float(-1 / k) : -(1 + slack) / std::max(slack, 1e-12f);
}

inline void TrianglePairs::set(Hit& hit, size_t block, size_t lane, float t, float u, float v, float x) const {
  const Slot& slot = slots_[block * lanes + lane];
  // Which of the two triangles is hit is unpredictable, so there is no branch.
  const float beyond = u * blocks_[block].turn[lane];
  const bool first = (u >= 0) | slot.alone;
  const float w = first ? u : x, y = first ? v : beyond;
  const Part& triangle = slot.parts[size_t(!first)];
  hit.distance = t;
  hit.object = slot.object;
  hit.primitive = triangle.primitive;
  hit.u = w;
  hit.v = y;
  hit.depth = 0;
  if (!slot.straight) [[unlikely]] {
    const float weights[3] = {1 - w - y, w, y};
    hit.u = weights[triangle.second];
    hit.v = weights[triangle.third];
  }
}

bool TrianglePairs::nearest(const Ray& ray, Hit& hit) const {
  const WideRay wide(ray);
  Floats best = spread(ray.maximum), best_u{}, best_v{}, best_x{}, where = spread(std::bit_cast<float>(-1));
  std::int32_t number = 0;  // of the block, stored as the bits of a float
  for (const Block& block : blocks_) {
    Met m;
    // For low latency a block depends on the previous block only by one minimum.
    const Floats reach = choose(test(block, wide, m), m.t, spread(infinity));
    const Mask closer = below(reach, best);
    best = smaller(reach, best);
    best_u = choose(closer, m.u, best_u);
    best_v = choose(closer, m.v, best_v);
    best_x = choose(closer, m.x, best_x);
    where = choose(closer, spread(std::bit_cast<float>(number++)), where);
  }
  const int lane = lowest_lane(best);
  const auto found = std::bit_cast<std::int32_t>(where[lane]);
  if (found < 0) return false;
  set(hit, size_t(found), size_t(lane), best[lane], best_u[lane], best_v[lane], best_x[lane]);
  return true;
}

bool TrianglePairs::any(const Ray& ray) const {
  const WideRay wide(ray);
  const Floats limit = spread(ray.maximum);
  // Groups of blocks are tested without a branch between them, as it would be mispredicted too often.
  constexpr size_t group = 8;
  for (size_t i = 0;; i += group) {
    Mask hit{};
    const size_t end = std::min(i + group, blocks_.size());
    for (size_t k = i; k < end; ++k) {
      Met m;
      const Mask met = test(blocks_[k], wide, m);
      hit |= met & below(m.t, limit);
    }
    if (end == blocks_.size() || any_of(hit)) return any_of(hit);
  }
}

void TrianglePairs::all(const Ray& ray, HitList& list) const {
  const WideRay wide(ray);
  for (size_t i = 0; i < blocks_.size(); ++i) {
    Met m;
    Mask mask = test(blocks_[i], wide, m);
    mask &= below(m.t, spread(ray.maximum));
    for (size_t lane = 0; lane < size_t(lanes) && any_of(mask); ++lane) {
      if (!in(mask, lane)) continue;
      Hit hit;
      set(hit, i, lane, m.t[lane], m.u[lane], m.v[lane], m.x[lane]);
      list.add(hit);
    }
  }
}

}  // namespace etendue
