#pragma once
// Points of an object where directions meet it: near a surface, where points by area crowd into few directions and
// 1 / density has no bound, this is what keeps estimates calm.

#include "etendue/core/warp.h"
#include "geometry.h"

namespace etendue {

/// How many samples of the points seen from a place are made by direction.
struct DirectionShare {
  float value = 0;      ///< from 0 (none) to 1 (all)
  bool convex = false;  ///< from inside (1) all points are met, from outside those that face the place: no need to look
};

/// Whether a ray from a place meets a point before anything else of its object.
inline bool met_first(const Point3& from, const Vector3& direction, const SurfacePoint& p) {
  Ray ray;
  ray.origin = from;
  ray.direction = direction;
  ray.time = p.time;
  Hit hit;
  const float d = distance(p.position, from);
  return p.object->intersect(ray, hit) && std::abs(hit.distance - d) <= 1e-4f * d + 4 * p.error;
}

/// The density [1/sr] of a point chosen by sample_by_both; `density_by_area(point)` is that of the other sampler [1/m^2].
template <class Density>
float pdf_by_both(const DirectionShare& share, const Point3& from, const Vector3& direction, const SurfacePoint& p,
                  const Density& pdf_by_area) {
  float pdf = 0;
  if (share.value < 1) {
    const float cosine = std::abs(dot(p.normal, direction));
    if (cosine > 0) pdf = (1 - share.value) * pdf_by_area(p) * distance_squared(p.position, from) / cosine;
  }
  if (share.value == 0) return pdf;
  const bool met = share.convex ? share.value == 1 || dot(p.normal, direction) < 0 : met_first(from, direction, p);
  return met ? pdf + share.value * warp::sphere_pdf : pdf;
}

/// A point by direction with a share of all samples, else by the given sampler: `sample_by_area(u, sample)`
/// fills a point or says that it found none. The density [1/sr] is that of both together.
template <class Sampler, class Density>
SurfaceSample sample_by_both(const SceneObject& object, const DirectionShare& share, const Point3& from, Point2 u, float time,
                             const Sampler& sample_by_area, const Density& pdf_by_area) {
  SurfaceSample s;
  if (u.x < share.value) {
    Ray ray;
    ray.origin = from;
    ray.direction = warp::sphere({u.x / share.value, u.y});
    ray.time = time;
    Hit hit;
    if (!object.intersect(ray, hit)) return s;
    object.surface_point(ray, hit, s.point);
  } else {
    const float rest = share.value > 0 ? std::min((u.x - share.value) / (1 - share.value), one_minus_epsilon) : u.x;
    if (!sample_by_area({rest, u.y}, s)) return s;
  }
  complete_by_angle(s, from, 1);
  s.pdf *= pdf_by_both(share, from, s.direction, s.point, pdf_by_area);
  return s;
}

}  // namespace etendue
