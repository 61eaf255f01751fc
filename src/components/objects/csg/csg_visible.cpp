// Sampling of CSG solids by solid angle from a reference point.

#include "csg.h"
#include "etendue/core/warp.h"
#include "geometry/geometry.h"

// A direction is sampled uniformly in the cone around the bounding sphere of the box, with the pdf 1 / (2 pi (1 - cos)) [1/sr],
// and a ray is traced. Visible points of the solid have this pdf; points hidden by other parts of the solid have the pdf 0.

namespace etendue {
namespace {

/// The cone of directions towards the bounding sphere; all directions from inside it.
struct View {
  Frame frame;
  float one_minus_cosine = 2;

  View(const Bounds3& box, const Point3& from) : frame(Normal3(0, 0, 1)) {
    const Vector3 to = box.centre() - from;
    const float sin2 = 1.0001f * length_squared(box.diagonal()) / (4 * length_squared(to));
    if (!(sin2 < 0.9999f)) return;
    frame = Frame(Normal3(normalize(to)));
    one_minus_cosine = sin2 / (1 + std::sqrt(1 - sin2));
  }
  /// The cone is too small for float directions to distinguish points of the solid.
  bool remote() const { return one_minus_cosine < 1e-9f; }
  float pdf() const { return warp::cone_pdf(one_minus_cosine); }
  Vector3 direction(Point2 u) const {
    const float h = u.x * one_minus_cosine, sine = safe_sqrt(h * (2 - h)), phi = 2 * pi * u.y;
    return frame.to_world({sine * std::cos(phi), sine * std::sin(phi), 1 - h});
  }
};

}  // namespace

bool Csg::first_seen(const Point3& from, const Vector3& direction, float time, SurfacePoint& p) const {
  Ray ray;
  ray.origin = from;
  ray.direction = direction;
  ray.time = time;
  Hit hit;
  if (!intersect(ray, hit)) return false;
  surface_point(ray, hit, p);
  // A hit at the surface on which `from` itself lies is skipped.
  if (hit.distance * std::abs(dot(p.normal, direction)) > 4 * p.error) return true;
  p.leave(direction, ray);
  if (!intersect(ray, hit)) return false;
  surface_point(ray, hit, p);
  return true;
}

SurfaceSample Csg::sample_visible(const Point3& from, Point2 u, float time) const {
  if (bounds_.empty()) return {};
  const View view(bounds_, from);
  if (view.remote()) return SceneObject::sample_visible(from, u, time);
  SurfaceSample s;
  if (first_seen(from, view.direction(u), time, s.point)) complete_by_angle(s, from, view.pdf());
  return s;
}

float Csg::visible_pdf(const Point3& from, const Vector3& direction, const SurfacePoint& p) const {
  const View view(bounds_, from);
  if (view.remote()) return SceneObject::visible_pdf(from, direction, p);
  SurfacePoint seen;
  if (!first_seen(from, direction, p.time, seen)) return 0;
  const float near = 1e-4f * distance(from, p.position) + 4 * (p.error + seen.error);
  return distance(p.position, seen.position) < near ? view.pdf() : 0;
}

}  // namespace etendue
