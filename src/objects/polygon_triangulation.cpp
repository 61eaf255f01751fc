#include "polygon_triangulation.h"

namespace etendue {

Vector3 newell_normal(std::span<const Point3> points) {
  // About the first point, in double, so that a small polygon far from the origin keeps its digits.
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

bool triangulate(std::span<const Point3> points, std::vector<std::array<std::uint32_t, 3>>& out) {
  const size_t n = points.size();
  if (n < 3) return false;
  // Projected along the largest axis of the normal, in double, turned so that the polygon runs counter-clockwise.
  const Vector3 normal = newell_normal(points), size = abs(normal);
  const int axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
  const int a = normal[axis] < 0 ? (axis + 2) % 3 : (axis + 1) % 3, b = 3 - axis - a;
  struct Corner {
    double x, y;
  };
  std::vector<Corner> p(n);
  for (size_t i = 0; i < n; ++i) p[i] = {points[i][a], points[i][b]};
  const auto turn = [&](size_t i, size_t j, size_t k) {
    return (p[j].x - p[i].x) * (p[k].y - p[i].y) - (p[j].y - p[i].y) * (p[k].x - p[i].x);
  };
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
      // Only reflex corners can lie in an ear; one that touches a corner of the ear (a bridge to a hole) does not count.
      if (turn(previous[q], q, next[q]) > 0 || same(q, i) || same(q, j) || same(q, k)) continue;
      if (turn(i, j, q) >= 0 && turn(j, k, q) >= 0 && turn(k, i, q) >= 0) return false;
    }
    return true;
  };
  size_t left = n, at = 0, misses = 0;
  bool simple = true;
  if (n <= 4096)  // two edges cross where each has the other's ends on both sides
    for (size_t i = 0; i < n && simple; ++i)
      for (size_t j = i + 2; j < n && simple; ++j) {
        const size_t k = (i + 1) % n, l = (j + 1) % n;
        simple = !(turn(i, k, j) * turn(i, k, l) < 0 && turn(j, l, i) * turn(j, l, k) < 0);
      }
  const auto cut = [&](size_t j) {
    next[previous[j]] = next[j];
    previous[next[j]] = previous[j];
    --left;
  };
  while (left > 3) {
    const size_t i = previous[at], k = next[at];
    const bool straight = turn(i, at, k) == 0;
    if (straight || is_ear(at) || (misses > left && turn(i, at, k) > 0)) {
      // A straight corner is cut too, though its triangle has no area, or its neighbour would see no ear beside it.
      if (!straight) out.push_back({std::uint32_t(i), std::uint32_t(at), std::uint32_t(k)});
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
  for (size_t j = next[first]; next[j] != first; j = next[j])
    if (left > 3 || turn(first, j, next[j]) != 0)
      out.push_back({std::uint32_t(first), std::uint32_t(j), std::uint32_t(next[j])});
  return simple;
}

}  // namespace etendue
