#include "primitives.h"

namespace etendue {
namespace {

/// A slightly enlarged box, as by rounding an object may return hits just outside its bounds.
Bounds3 widened(Bounds3 box) {
  const auto margin = [](float low, float high) { return 1e-6f * std::max(std::abs(low), std::abs(high)) + 1e-30f; };
  const Vector3 m{margin(box.low.x, box.high.x), margin(box.low.y, box.high.y), margin(box.low.z, box.high.z)};
  box.low = box.low - m;
  box.high = box.high + m;
  return box;
}

}  // namespace

void Primitives::gather(std::span<const SceneObject* const> objects) {
  owners_.clear();
  items_.clear();
  endless_.clear();
  size_t count = 0;
  for (const SceneObject* object : objects) {
    const std::optional<TriangleView> view = still_triangles(*object);
    count += view ? view->triangles.size() : 1;
  }
  if (count >= size_t(1) << 31) throw Error("a scene cannot have more than two thousand million triangles");
  items_.reserve(count);
  for (const SceneObject* object : objects) {
    if (object->unbounded()) {
      endless_.push_back(object);
      continue;
    }
    const std::uint32_t owner = std::uint32_t(owners_.size());
    if (const std::optional<TriangleView> view = still_triangles(*object)) {
      owners_.push_back({object, *view, {}});
      for (size_t i = 0; i < view->triangles.size(); ++i) items_.push_back({owner, std::uint32_t(i)});
    } else {
      owners_.push_back({object, {}, widened(object->bounds())});
      items_.push_back({owner, whole});
    }
  }
}

Bounds3 Primitives::bounds(size_t i) const {
  if (!triangle(i)) return owners_[items_[i].owner].bounds;
  Bounds3 box;
  for (int k = 0; k < 3; ++k) box.add(corner(i, k));
  return box;
}

// The plane n.(x - p) = 0 misses a box with centre c and half edges h when |n.(c - p)| > sum |n_k| h_k (Akenine-Moeller 2001,
// "Fast 3D triangle-box overlap testing").
bool Primitives::meets(size_t i, const DoubleBox& box) const {
  const Bounds3 own = bounds(i);
  for (int k = 0; k < 3; ++k)
    if (double(own.high[k]) < box.low[k] || double(own.low[k]) > box.high[k]) return false;
  if (!triangle(i)) return true;
  const Point3 &p = corner(i, 0), &q = corner(i, 1), &r = corner(i, 2);
  double n[3], distance = 0, reach = 0, size = 0;
  for (int k = 0; k < 3; ++k) {
    const int x = (k + 1) % 3, y = (k + 2) % 3;
    n[k] = (double(q[x]) - double(p[x])) * (double(r[y]) - double(p[y])) -
           (double(q[y]) - double(p[y])) * (double(r[x]) - double(p[x]));
  }
  for (int k = 0; k < 3; ++k) {
    const double away = (box.low[k] + box.high[k]) / 2 - double(p[k]);
    distance += n[k] * away;
    reach += std::abs(n[k]) * (box.high[k] - box.low[k]) / 2;
    size += std::abs(n[k]) * (std::abs(away) + std::abs(double(p[k])));
  }
  return std::abs(distance) <= reach + 1e-13 * size;
}

}  // namespace etendue
