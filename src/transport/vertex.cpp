#include "vertex.h"

#include "medium_tracking.h"
#include "seeded_bug.h"

namespace etendue {

ScatterValue scattering(const Vertex& v, const Vector3& out, const Vector3& in, Transport transport) {
  if (v.kind == Vertex::Kind::volume) {
    const float phase = v.volume->phase(v.point.position, out, in);
    return {Spectrum(phase), phase};
  }
  if (!v.scatter) return {};
  if (seeded(SeededBug::no_squared_index)) transport = Transport::importance;
  ScatterValue f = v.scatter->value_and_density(out, in, transport, smooth_lobes);
  // The walk chooses among all lobes.
  if (v.scatter->has(specular_lobes)) f.density = scattering_density(v, out, in, transport);
  if (seeded(SeededBug::lost_cosine)) f.value /= v.scatter->cosine(in);
  return f;
}

float scattering_density(const Vertex& v, const Vector3& out, const Vector3& in, Transport transport) {
  if (v.kind == Vertex::Kind::volume) return v.volume->phase(v.point.position, out, in);
  return v.scatter ? v.scatter->density(out, in, transport, vertex_lobes) : 0;
}

float vertex_density(float density, const Vertex& a, const Vertex& b, const Vector3& direction, float chance,
                     const LightFront& front) {
  density *= chance;
  if (b.infinite || b.kind == Vertex::Kind::escape) return density;
  if (b.kind == Vertex::Kind::volume)
    density *= b.extinction;
  else if (b.point.normal != Normal3{})
    density *= std::abs(dot(b.point.normal, direction));
  if (a.parallel) return density;
  if (a.infinite) return density * front.density(b.point.position, direction);
  return density / length_squared(b.point.position - a.point.position);
}

Ray leaving_ray(const Vertex& from, const Vector3& direction) {
  if (from.on_surface() || (from.kind == Vertex::Kind::luminaire && from.point.normal != Normal3{}))
    return from.point.leave(direction);
  Ray ray;
  ray.origin = from.point.position;
  ray.direction = direction;
  ray.time = from.point.time;
  return ray;
}

Ray connecting_ray(const Vertex& from, const Vertex& to) {
  const Vector3 direction = normalize(to.point.position - from.point.position);
  Ray ray = leaving_ray(from, direction);
  // At both ends on the side for which scattering was asked, which between two points of one wall is a matter of rounding: with
  // light on its outside, a ray that ended within would bring it in.
  const Vector3 way = to.point.exit(-direction) - ray.origin;
  const float distance = length(way);
  ray.direction = 1 / distance * way;
  ray.maximum = distance * SurfacePoint::almost_there;
  return ray;
}

Ray lens_ray(const Vertex& v, const LensSample& lens) {
  Ray ray = leaving_ray(v, lens.direction);
  ray.maximum = lens.distance * SurfacePoint::almost_there;
  return ray;
}

const MediumStack* media_towards(const Vertex& v, const Vector3& direction, MediumStack& scratch) {
  if (!v.media || !v.on_surface()) return v.media;
  const bool through = (dot(v.point.normal, v.out) > 0) != (dot(v.point.normal, direction) > 0);
  if (!through || !v.point.object->shader) return v.media;
  scratch = *v.media;
  cross_boundary(scratch, *v.point.object, v.point.normal, direction);
  return &scratch;
}

}  // namespace etendue
