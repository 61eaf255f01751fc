#pragma once
// InfiniteObject: the interface of objects at infinity, such as environment maps and distant lights, and SurroundingObject,
// that of fog around the scene. Rays never hit these objects: a ray that leaves the scene sees the environments.
//
// A new object at infinity must implement `surface_point`, which returns the point seen along a ray, `area`, `sample_visible`
// and `visible_pdf`. A delta light overrides `extent`. A SurroundingObject must implement `reach`.

#include "etendue/emission_shader.h"
#include "etendue/scene_object.h"

namespace etendue {

class InfiniteObject : public SceneObject {
 public:
  /// Sets the bounding sphere of all finite objects. Called by Scene::prepare.
  virtual void enclose(const Point3& centre, float radius) {
    centre_ = centre;
    radius_ = radius;
  }

  /// The points of the unit square that `sample_visible`, from any place, maps to this direction (unit), and the most that
  /// there are of any direction; 0: not known.
  virtual IncidentPlaces visible_places(const Vector3& /*direction*/, float /*time*/) const { return {}; }
  virtual int most_visible_places() const { return 0; }

  Extent extent() const override { return Extent::environment; }
  Bounds3 bounds() const final { return {}; }
  bool intersect(const Ray&, Hit&) const final { return false; }
  bool occludes(const Ray&) const final { return false; }
  void tangents(SurfacePoint&) const override {}  // a point at infinity has none
  /// There are no points with an area at infinity: the pdf is 0.
  SurfaceSample sample_area(Point2, float) const final { return {}; }
  float area_pdf(const SurfacePoint&) const final { return 0; }

 protected:
  Point3 centre_{0, 0, 0};  ///< the bounding sphere of all finite objects
  float radius_ = 1;        ///< [m]
};

/// An object without a surface whose inside is all of space.
class SurroundingObject : public InfiniteObject {
 public:
  /// The distance along an unoccluded ray at which the inside ends [m]; may be infinite.
  virtual float reach(const Ray&) const = 0;

  Extent extent() const final { return Extent::surroundings; }
  void surface_point(const Ray&, const Hit&, SurfacePoint&) const final {}
  float area(float) const final { return 0; }
};

/// The object as a SurroundingObject; its extent must be Extent::surroundings. Scene::prepare has checked the class.
inline const SurroundingObject& surroundings_of(const SceneObject& object) {
  return static_cast<const SurroundingObject&>(object);
}

}  // namespace etendue
