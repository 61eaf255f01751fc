#pragma once
// Primitives: what acceleration structures are built over: single triangles, and whole objects.

#include <span>
#include <vector>

#include "etendue/core/error.h"
#include "etendue/mesh_facts.h"
#include "geometry/watertight.h"

namespace etendue {

/// The box of a cell, in double precision, so that the cells that a ray from far away crosses are the cells to which the
/// surfaces were assigned.
struct DoubleBox {
  double low[3], high[3];
};

class Primitives {
 public:
  /// Collects the primitives of a scene's objects. Throws Error if there are 2^31 or more.
  void gather(std::span<const SceneObject* const> objects);

  size_t size() const { return items_.size(); }
  bool triangle(size_t i) const { return items_[i].triangle != whole; }
  /// The triangle's number within its object.
  std::uint32_t number(size_t i) const { return items_[i].triangle; }
  const SceneObject* object(size_t i) const { return owner(owner_of(i)); }
  /// Number of the object that a primitive belongs to, for `owner`.
  std::uint32_t owner_of(size_t i) const { return items_[i].owner; }
  const SceneObject* owner(std::uint32_t number) const { return owners_[number].object; }
  /// Frees the list of primitives, for structures that have stored the owners and numbers. Functions with an argument `i` must
  /// not be called any more.
  void forget_items() { items_ = {}; }
  const Point3& corner(size_t i, int k) const {
    const Item& item = items_[i];
    const TriangleView& view = owners_[item.owner].view;
    return view.positions[view.triangles[item.triangle][size_t(k)]];
  }
  Bounds3 bounds(size_t i) const;
  /// False only if no point of the primitive lies in the box: by its bounds, and by the plane of a triangle.
  bool meets(size_t i, const DoubleBox& box) const;

  /// Unbounded objects: every ray is tested against them, as no box contains them.
  bool nearest_endless(Ray& rest, Hit& hit) const {
    bool found = false;
    for (const SceneObject* object : endless_)
      if (object->intersect(rest, hit)) {
        rest.maximum = hit.distance;
        found = true;
      }
    return found;
  }
  bool any_endless(const Ray& ray) const {
    for (const SceneObject* object : endless_)
      if (object->occludes(ray)) return true;
    return false;
  }
  void all_endless(const Ray& ray, HitList& list) const {
    for (const SceneObject* object : endless_) object->all_hits(ray, list);
  }

  // One ray against one primitive.
  bool nearest(size_t i, const Ray& ray, const ShearedRay<double>& sheared, Hit& hit) const {
    if (!triangle(i)) return object(i)->intersect(ray, hit);
    const Corners corners = corners_of(i);
    const CornerWeights<double> w = corner_weights(sheared, corners);
    if (!inside(w)) return false;
    const float t = float(plane_distance(sheared, corners));
    if (!(t > 0 && t < ray.maximum)) return false;
    const double scale = 1 / w.sum();
    hit.distance = t;
    hit.object = object(i);
    hit.primitive = number(i);
    hit.u = float(w.b * scale);
    hit.v = float(w.c * scale);
    hit.depth = 0;
    return true;
  }
  bool any(size_t i, const Ray& ray, const ShearedRay<double>& sheared) const {
    Hit hit;
    return triangle(i) ? nearest(i, ray, sheared, hit) : object(i)->occludes(ray);
  }
  void all(size_t i, const Ray& ray, const ShearedRay<double>& sheared, HitList& list) const {
    if (!triangle(i)) return object(i)->all_hits(ray, list);
    Hit hit;
    if (nearest(i, ray, sheared, hit)) list.add(hit);
  }

 private:
  struct Owner {
    const SceneObject* object;
    TriangleView view;
    Bounds3 bounds;
  };
  struct Item {
    std::uint32_t owner, triangle;  ///< triangle: its number, or `whole` for a whole object
  };
  static constexpr std::uint32_t whole = ~0u;

  struct Corners {
    std::array<float, 3> p[3];
    double operator()(int k, int axis) const { return double(p[k][size_t(axis)]); }
  };
  Corners corners_of(size_t i) const {
    using Coordinates = std::array<float, 3>;
    return {std::bit_cast<Coordinates>(corner(i, 0)), std::bit_cast<Coordinates>(corner(i, 1)),
            std::bit_cast<Coordinates>(corner(i, 2))};
  }

  std::vector<Owner> owners_;
  std::vector<Item> items_;
  std::vector<const SceneObject*> endless_;
};

}  // namespace etendue
