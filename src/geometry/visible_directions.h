#pragma once
// Samples points of an object by uniform directions from a reference point, mixed with sampling by area. Near a surface,
// samples by area concentrate in few directions and 1 / pdf is unbounded; the share of samples by direction bounds it.

#include "etendue/core/warp.h"
#include "geometry.h"

namespace etendue {

/// The fraction of samples of visible points that are made by direction.
struct DirectionShare {
  float value = 0;      ///< from 0 (all by area) to 1 (all by direction)
  bool convex = false;  ///< visibility follows without tracing a ray: from inside (value 1) all points are visible, from
                        ///< outside those that face the reference point
};

/// Whether a ray from `from` hits the point before any other point of the same object.
inline bool met_first(const Point3& from, const Vector3& direction, const SurfacePoint& p) {
  Ray ray;
  ray.origin = from;
  ray.direction = direction;
  ray.time = p.time;
  Hit hit;
  const float d = distance(p.position, from);
  return p.object->intersect(ray, hit) && std::abs(hit.distance - d) <= 1e-4f * d + 4 * p.error;
}

/// The pdf [1/sr] of a point sampled by sample_by_both; `pdf_by_area(point)` is the pdf [1/m^2] of the sampler by area.
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

/// Samples a point by direction with probability `share`, else by the given sampler: `sample_by_area(u, sample)` fills a point
/// or returns false if it found none. The pdf [1/sr] is that of the mixture.
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
