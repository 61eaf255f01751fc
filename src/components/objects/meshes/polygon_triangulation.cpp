#include "polygon_triangulation.h"

#include <algorithm>
#include <numeric>

namespace etendue {

Vector3 newell_normal(std::span<const Point3> points) {
  // Relative to the first point and in double, so that a small polygon far from the origin keeps its precision.
  double x = 0, y = 0, z = 0;
  const Point3 o = points[0];
  for (size_t i = 0; i < points.size(); ++i) {
    const Vector3 a = points[i] - o, b = points[(i + 1) % points.size()] - o;
    x += double(a.y) * b.z - double(a.z) * b.y;
    y += double(a.z) * b.x - double(a.x) * b.z;
    z += double(a.x) * b.y - double(a.y) * b.x;
  }
  return {float(x), float(y), float(z)};
}

namespace {

/// A corner projected to the plane, and the index of its point.
struct Corner {
  double x, y;
  std::uint32_t name;
};
using Outline = std::vector<Corner>;

/// Twice the area of a triangle; positive if it is counter-clockwise.
double turn_of(const Corner& a, const Corner& b, const Corner& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Projects points along the largest axis of a normal, in double, such that polygons that run around the normal are
/// counter-clockwise.
Outline projected(std::span<const Point3> points, const Vector3& normal) {
  const Vector3 size = abs(normal);
  const int axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
  const int a = normal[axis] < 0 ? (axis + 2) % 3 : (axis + 1) % 3, b = 3 - axis - a;
  Outline p(points.size());
  for (size_t i = 0; i < p.size(); ++i) p[i] = {double(points[i][a]), double(points[i][b]), std::uint32_t(i)};
  return p;
}

/// Two edges cross if the ends of each lie on different sides of the other.
bool cross_each_other(const Corner& a, const Corner& b, const Corner& c, const Corner& d) {
  return turn_of(a, b, c) * turn_of(a, b, d) < 0 && turn_of(c, d, a) * turn_of(c, d, b) < 0;
}

bool crosses_itself(const Outline& p) {
  const size_t n = p.size();
  for (size_t i = 0; i < n; ++i)
    for (size_t j = i + 2; j < n; ++j)
      if (cross_each_other(p[i], p[(i + 1) % n], p[j], p[(j + 1) % n])) return true;
  return false;
}

bool cross(const Outline& p, const Outline& q) {
  for (size_t i = 0; i < p.size(); ++i)
    for (size_t j = 0; j < q.size(); ++j)
      if (cross_each_other(p[i], p[(i + 1) % p.size()], q[j], q[(j + 1) % q.size()])) return true;
  return false;
}

/// Whether an outline lies inside another one that it does not cross. Decided by the first corner that is not on the other's
/// border.
bool lies_in(const Outline& inner, const Outline& outer) {
  for (const Corner& c : inner) {
    bool in = false, border = false;
    for (size_t i = 0, k = outer.size() - 1; i < outer.size(); k = i++) {
      const Corner &a = outer[k], &b = outer[i];
      const double side = turn_of(a, b, c);
      border = border || (side == 0 && (c.x - a.x) * (c.x - b.x) + (c.y - a.y) * (c.y - b.y) <= 0);
      if ((a.y > c.y) != (b.y > c.y) && (side > 0) == (b.y > a.y)) in = !in;
    }
    if (!border) return in;
  }
  return true;
}

double twice_area(const Outline& p) {
  double sum = 0;
  for (size_t i = 1; i + 1 < p.size(); ++i) sum += turn_of(p[0], p[i], p[i + 1]);
  return sum;
}

/// Clips ears until nothing is left. Returns false if the outline intersects itself.
bool cut_ears(const Outline& p, std::vector<std::array<std::uint32_t, 3>>& out) {
  const size_t n = p.size();
  const auto turn = [&](size_t i, size_t j, size_t k) { return turn_of(p[i], p[j], p[k]); };
  std::vector<size_t> next(n), previous(n);
  for (size_t i = 0; i < n; ++i) {
    next[i] = (i + 1) % n;
    previous[i] = (i + n - 1) % n;
  }
  const auto same = [&](size_t i, size_t j) { return p[i].x == p[j].x && p[i].y == p[j].y; };
  const auto is_ear = [&](size_t j) {
    const size_t i = previous[j], k = next[j];
    if (!(turn(i, j, k) > 0)) return false;
    for (size_t q = next[k]; q != i; q = next[q]) {
      // Only reflex corners can lie in an ear; a corner that coincides with a corner of the ear (a bridge to a hole) is
      // ignored.
      if (turn(previous[q], q, next[q]) > 0 || same(q, i) || same(q, j) || same(q, k)) continue;
      if (turn(i, j, q) >= 0 && turn(j, k, q) >= 0 && turn(k, i, q) >= 0) return false;
    }
    return true;
  };
  size_t left = n, at = 0, misses = 0;
  bool simple = true;
  const auto cut = [&](size_t j) {
    next[previous[j]] = next[j];
    previous[next[j]] = previous[j];
    --left;
  };
  while (left > 3) {
    const size_t i = previous[at], k = next[at];
    const bool straight = turn(i, at, k) == 0;
    if (straight || is_ear(at) || (misses > left && turn(i, at, k) > 0)) {
      // A straight corner is clipped too, without a triangle, since otherwise its neighbours might never become ears.
      if (!straight) out.push_back({p[i].name, p[at].name, p[k].name});
      simple = simple && misses <= left;
      cut(at);
      misses = 0;
      at = i;
      continue;
    }
    at = k;
    if (++misses > 2 * left + 1) {
      simple = false;
      break;
    }
  }
  const size_t first = at;
  for (size_t j = next[first]; next[j] != first; j = next[j]) {
    if (left > 3 || turn(first, j, next[j]) != 0) out.push_back({p[first].name, p[j].name, p[next[j]].name});
    simple = simple && turn(first, j, next[j]) >= 0;
  }
  return simple;
}

/// Joins a clockwise hole to the outline around it by a bridge, an edge traversed in both directions, from the hole's corner
/// with the largest x to a corner of the outline visible from it (Eberly 2008, "Triangulation by ear clipping"). Returns false
/// if there is none.
bool join(Outline& outline, const Outline& hole) {
  const size_t m = size_t(
      std::max_element(hole.begin(), hole.end(), [](const Corner& a, const Corner& b) { return a.x < b.x; }) - hole.begin());
  const Corner& from = hole[m];
  // The nearest edge in the direction +x, and its end with the larger x.
  const size_t n = outline.size();
  double nearest = std::numeric_limits<double>::infinity();
  size_t best = n;
  for (size_t i = 0; i < n; ++i) {
    const Corner &a = outline[i], &b = outline[(i + 1) % n];
    if (!(a.y <= from.y && b.y >= from.y && a.y < b.y)) continue;  // the inside, and so the hole, is to the left of the edge
    const double x = a.x + (from.y - a.y) / (b.y - a.y) * (b.x - a.x);
    if (!(x >= from.x && x < nearest)) continue;
    nearest = x;
    best = b.y == from.y ? (i + 1) % n : (a.y == from.y || a.x > b.x ? i : (i + 1) % n);
  }
  if (best == n) return false;
  // Reflex corners in the triangle of the hole's corner, the hit point and the edge's end hide this end. Of them the one at the
  // smallest angle to +x is visible; at equal angles the nearest.
  const Corner place{nearest, from.y, 0}, end = outline[best];
  const bool above = end.y > from.y;
  double least = std::abs(end.y - from.y) / std::max(end.x - from.x, 1e-300);
  double reach = end.x - from.x;
  for (size_t i = 0; i < n && end.y != from.y; ++i) {
    const Corner& c = outline[i];
    if (turn_of(outline[(i + n - 1) % n], c, outline[(i + 1) % n]) > 0 || c.x < from.x) continue;
    const double t0 = turn_of(from, place, c), t1 = turn_of(place, end, c), t2 = turn_of(end, from, c);
    if (!(above ? t0 >= 0 && t1 >= 0 && t2 >= 0 : t0 <= 0 && t1 <= 0 && t2 <= 0)) continue;
    const double slope = std::abs(c.y - from.y) / std::max(c.x - from.x, 1e-300);
    if (slope < least || (slope == least && c.x - from.x < reach)) {
      least = slope;
      reach = c.x - from.x;
      best = i;
    }
  }
  // Of several corners at this position (ends of bridges), the one whose interior angle contains the bridge.
  for (size_t i = 0; i < n; ++i) {
    if (outline[i].x != outline[best].x || outline[i].y != outline[best].y) continue;
    const Corner &a = outline[(i + n - 1) % n], &c = outline[i], &b = outline[(i + 1) % n];
    const bool after = turn_of(c, b, from) >= 0, before = turn_of(a, c, from) >= 0;
    if (turn_of(a, c, b) >= 0 ? after && before : after || before) {
      best = i;
      break;
    }
  }
  Outline joined(outline.begin(), outline.begin() + std::ptrdiff_t(best) + 1);
  for (size_t i = 0; i <= hole.size(); ++i) joined.push_back(hole[(m + i) % hole.size()]);
  joined.insert(joined.end(), outline.begin() + std::ptrdiff_t(best), outline.end());
  outline = std::move(joined);
  return true;
}

/// Up to this number of corners, all pairs of edges are tested for crossings; with more corners, ear clipping detects crossings
/// only in part.
constexpr size_t tested_corners = 4096;

}  // namespace

bool triangulate(std::span<const Point3> points, std::vector<std::array<std::uint32_t, 3>>& out) {
  if (points.size() < 3) return false;
  const Outline p = projected(points, newell_normal(points));
  const bool crossing = p.size() <= tested_corners && crosses_itself(p);
  return cut_ears(p, out) && !crossing;
}

PolygonCheck triangulate(std::span<const Point3> points, std::span<const size_t> ends,
                         std::vector<std::array<std::uint32_t, 3>>& out) {
  const Outline all = projected(points, newell_normal(points.first(ends[0])));
  std::vector<Outline> outlines;
  for (size_t i = 0; i < ends.size(); ++i) {
    outlines.emplace_back(all.begin() + std::ptrdiff_t(i > 0 ? ends[i - 1] : 0), all.begin() + std::ptrdiff_t(ends[i]));
    if (i > 0 && twice_area(outlines[i]) > 0) std::reverse(outlines[i].begin(), outlines[i].end());
  }
  if (points.size() <= tested_corners)
    for (size_t i = 0; i < outlines.size(); ++i) {
      if (crosses_itself(outlines[i])) return {PolygonFault::crossing, i};
      for (size_t k = 0; k < i; ++k)
        if (cross(outlines[i], outlines[k])) return {PolygonFault::crossing, i};
    }
  for (size_t i = 1; i < outlines.size(); ++i) {
    if (!lies_in(outlines[i], outlines[0])) return {PolygonFault::outside, i};
    for (size_t k = 1; k < outlines.size(); ++k)
      if (k != i && lies_in(outlines[i], outlines[k])) return {PolygonFault::nested, i};
  }
  // Holes are joined in order of decreasing largest x, so that no remaining hole intersects a bridge.
  const auto furthest = [&](size_t i) {
    double x = -std::numeric_limits<double>::infinity();
    for (const Corner& c : outlines[i]) x = std::max(x, c.x);
    return x;
  };
  std::vector<size_t> order(outlines.size() - 1);
  std::iota(order.begin(), order.end(), size_t(1));
  std::sort(order.begin(), order.end(), [&](size_t i, size_t k) { return furthest(i) > furthest(k); });
  for (const size_t i : order)
    if (!join(outlines[0], outlines[i])) return {PolygonFault::outside, i};
  return cut_ears(outlines[0], out) ? PolygonCheck{} : PolygonCheck{PolygonFault::crossing, 0};
}

}  // namespace etendue
