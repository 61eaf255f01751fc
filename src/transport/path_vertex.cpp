#include "etendue/transport/path_vertex.h"

#include "etendue/transport/boundaries.h"

namespace etendue {

Ray leaving_ray(const PathVertex& from, const Vector3& direction) {
  if (from.on_surface() || (from.kind == PathVertex::Kind::luminaire && from.point.normal != Normal3{}))
    return from.point.leave(direction);
  Ray ray;
  ray.origin = from.point.position;
  ray.direction = direction;
  ray.time = from.point.time;
  return ray;
}

Ray connecting_ray(const PathVertex& from, const PathVertex& to) {
  const Vector3 direction = normalize(to.point.position - from.point.position);
  Ray ray = leaving_ray(from, direction);
  // Both ends lie on the side for which scattering was evaluated. Between two points of one wall that side is a matter of
  // rounding: if the light is on the outside of the wall, a ray that ended inside would let it in.
  const Vector3 way = to.point.exit(-direction) - ray.origin;
  const float distance = length(way);
  ray.direction = 1 / distance * way;
  ray.maximum = distance * SurfacePoint::almost_there;
  return ray;
}

Ray lens_ray(const PathVertex& v, const LensSample& lens) {
  Ray ray = leaving_ray(v, lens.direction);
  ray.maximum = (lens.distance - lens.nearest) * SurfacePoint::almost_there;
  ray.of_camera = true;
  return ray;
}

const MediumStack* media_towards(const PathVertex& v, const Vector3& direction, MediumStack& scratch) {
  if (!v.media || !v.on_surface()) return v.media;
  // On the side of the surface opposite to that from which the path came, the stack differs by the object.
  const bool through = (dot(v.point.normal, v.out) > 0) != (dot(v.point.normal, direction) > 0);
  if (!through || !v.point.object->shader) return v.media;
  scratch = *v.media;
  cross_boundary(scratch, *v.point.object, v.point.normal, direction);
  return &scratch;
}

}  // namespace etendue
