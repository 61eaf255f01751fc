#include "etendue/transport/point_tree.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>

#include "etendue/core/error.h"

namespace etendue {

std::vector<std::uint32_t> PointTree::build(std::span<const Point3> points) {
  if (points.size() > std::numeric_limits<std::uint32_t>::max()) throw Error("a tree of points holds at most 2^32 of them");
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  // Ranges are halved until the larger half fits in a leaf: the nodes above are numbered level by level.
  size_t levels = 0;
  for (size_t n = points.size(); n > leaf; n -= n / 2) ++levels;
  planes_.assign((size_t(1) << levels) - 1, {});
  divide(points, order.data(), 0, points.size(), 0);
  points_.resize(points.size());
  tbb::parallel_for(tbb::blocked_range<size_t>(0, points.size(), 1 << 14), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t i = range.begin(); i < range.end(); ++i) points_[i] = points[order[i]];
  });
  return order;
}

void PointTree::divide(std::span<const Point3> points, std::uint32_t* order, size_t begin, size_t end, size_t node) {
  if (end - begin <= leaf) return;
  Point3 low = points[order[begin]], high = low;
  for (size_t i = begin + 1; i < end; ++i) {
    const Point3& p = points[order[i]];
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const Vector3 edge = high - low;
  const int axis = edge.x >= edge.y && edge.x >= edge.z ? 0 : edge.y >= edge.z ? 1 : 2;
  const size_t middle = begin + (end - begin) / 2;
  // Points with equal coordinates are ordered by their index, so that the order does not depend on the standard library.
  std::nth_element(order + begin, order + middle, order + end, [&](std::uint32_t a, std::uint32_t b) {
    const float x = points[a][axis], y = points[b][axis];
    return x != y ? x < y : a < b;
  });
  planes_[node] = {points[order[middle]][axis], std::uint32_t(axis)};
  const auto lower = [&] { divide(points, order, begin, middle, 2 * node + 1); };
  const auto upper = [&] { divide(points, order, middle, end, 2 * node + 2); };
  if (end - begin > (1 << 15)) {
    tbb::parallel_invoke(lower, upper);
  } else {
    lower();
    upper();
  }
}

std::vector<PointTree::Near>& PointTree::near_on_this_thread() {
  static thread_local std::vector<Near> near;
  return near;
}

void PointTree::nearest(const Point3& p, float radius, size_t count, std::vector<Near>& found) const {
  found.clear();
  if (count == 0) return;
  float squared = square(radius);
  search(p, squared, [&](std::uint32_t i, float d2) {
    if (found.size() == count) {
      std::pop_heap(found.begin(), found.end());
      found.pop_back();
    }
    found.push_back({d2, i});
    std::push_heap(found.begin(), found.end());
    if (found.size() == count) squared = found.front().squared;
  });
}

}  // namespace etendue
