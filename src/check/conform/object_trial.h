#pragma once
// Shared by the checks of scene objects: an object with its size, and tolerances for rounding.

#include <string>

#include "conformance.h"
#include "etendue/scene_object.h"

namespace etendue::conform {

struct ObjectTrial {
  ObjectTrial(Trial& t, const SceneObject& o)
      : trial(t),
        object(o),
        bounds(o.bounds()),
        centre(bounds.centre()),
        radius(length(bounds.diagonal()) / 2),
        time(t.uniform()) {}

  Trial& trial;
  const SceneObject& object;
  const Bounds3 bounds;
  const Point3 centre;
  const float radius, time;

  /// The tolerance of positions [m].
  float slack(const Point3& p) const { return 1e-4f * radius + 1e-5f * length(p - Point3{}); }
  bool inside(const Bounds3& box, const Point3& p) const {
    const float s = slack(p);
    for (int i = 0; i < 3; ++i)
      if (!(p[i] >= box.low[i] - s && p[i] <= box.high[i] + s)) return false;
    return true;
  }
  SurfacePoint located(const Ray& ray, const Hit& hit) const {
    SurfacePoint p;
    object.surface_point(ray, hit, p);
    return p;
  }
  Ray ray(const Point3& from, const Vector3& direction, float maximum = infinity) const {
    Ray r;
    r.origin = from;
    r.direction = direction;
    r.maximum = maximum;
    r.time = time;
    return r;
  }
  SurfaceSample sample_area() const { return object.sample_area(trial.pair(), time); }

  /// Whether `wrong` of n cases are few enough to be due to rounding or to edges.
  static bool few(int wrong, int n, double share = 1e-3) { return wrong <= 3 + int(share * n); }
};

std::string text_of(const Point3&);
std::string text_of(const Vector3&);

/// Checks that tangents lie in the surface and predict the positions of points with other uv coordinates.
void check_tangents(const ObjectTrial&);
/// Checks the solid angle in which the object is seen from a point, and the points of sample_visible.
void check_seen_from(const ObjectTrial&, const Point3& from);
/// Checks that a copy which is translated, rotated and scaled gives the same hits, transformed.
void check_moved(const ObjectTrial&);

}  // namespace etendue::conform
