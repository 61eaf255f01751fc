#pragma once
// PathVertex: the vertex of any path, with the local quantities that every light transport algorithm needs: f |cos| and the pdf
// of scattering at the vertex, and rays that leave it or connect it to another vertex. SubpathVertex (subpath.h) adds what
// multiple importance sampling needs, ChainVertex (light_path.h) specular chains for path space Metropolis.

#include "etendue/camera.h"
#include "etendue/scene.h"
#include "etendue/shader.h"
#include "etendue/transport/luminaires.h"
#include "etendue/transport/medium.h"
#include "etendue/transport/scattering.h"

namespace etendue {

/// A point where a path starts, is scattered or ends.
struct PathVertex {
  enum class Kind : std::uint8_t { camera, luminaire, surface, medium, escape };

  Kind kind = Kind::surface;
  /// The vertex is the exit point of subsurface scattering (Shader::sample_exit): no ray of the path ends here.
  bool subsurface_exit = false;
  SurfacePoint point;                  ///< in a medium only position and time are valid; for an escape nothing
  const Scatter* scatter = nullptr;    ///< the BSDF, on a surface; null: black
  Lobes lobes = vertex_lobes;          ///< the lobes of a surface that a walk samples
  Medium medium;                       ///< the medium that scatters, for a vertex in a medium
  const MediumStack* media = nullptr;  ///< the media around the vertex, on the side of `out`; null: media are not tracked
  Vector3 out;                         ///< unit, to the vertex before; for an escape the direction opposite to the ray

  bool on_surface() const { return kind == Kind::surface; }
  bool in_medium() const { return kind == Kind::medium; }
  /// Whether the vertex has a lobe that is not a delta distribution, so that next event estimation and connections can reach
  /// it.
  bool scatters_smoothly() const { return in_medium() || (on_surface() && scatter && scatter->has(smooth_lobes)); }
  /// The normal for a light sampler: zero in media, where there is no surface.
  Normal3 normal() const { return in_medium() ? Normal3{} : point.normal; }
};

/// f |cos| [1/sr] of a path that comes from `out` and continues to `in`, or the phase function in a medium; and the pdf [1/sr]
/// with which it samples `in`.
inline ScatterValue scattering(const PathVertex& vertex, const Vector3& out, const Vector3& in, Transport transport) {
  if (vertex.in_medium()) {
    const float phase = vertex.medium.phase(vertex.point.position, vertex.point.time, out, in);
    return {Spectrum(phase), phase};
  }
  return vertex.scatter ? vertex.scatter->value_and_pdf(out, in, {transport, vertex.lobes}) : ScatterValue{};
}
/// Only that value.
inline Spectrum scattered(const PathVertex& vertex, const Vector3& out, const Vector3& in, Transport transport) {
  if (vertex.in_medium()) return Spectrum(vertex.medium.phase(vertex.point.position, vertex.point.time, out, in));
  return vertex.scatter ? vertex.scatter->evaluate(out, in, {transport, vertex.lobes}) : Spectrum();
}
/// Only that pdf.
inline float scattering_pdf(const PathVertex& vertex, const Vector3& out, const Vector3& in, Transport transport) {
  if (vertex.in_medium()) return vertex.medium.phase(vertex.point.position, vertex.point.time, out, in);
  return vertex.scatter ? vertex.scatter->pdf(out, in, {transport, vertex.lobes}) : 0;
}

/// The sample of a direction that another distribution chose, such as a path guide, with that distribution's pdf [1/sr]; for
/// Walk::leave. Only smooth lobes are evaluated, so a mixture must also use `sample_direction`, which samples the specular
/// lobes. `pdf` is that of the whole mixture. The weight of a sample from `sample_direction` must be multiplied by (its pdf /
/// pdf of the mixture) if it is smooth, and divided by the probability of that strategy if it is specular. Empty: f is 0 in
/// this direction.
inline std::optional<ScatterSample> scattered_towards(const PathVertex& vertex, const Vector3& in, float pdf,
                                                      Transport transport) {
  const ScatterValue f = scattering(vertex, vertex.out, in, transport);
  if (!(pdf > 0) || f.value.black()) return {};
  ScatterSample sample;
  sample.direction = in;
  sample.weight = f.value / pdf;
  sample.pdf = pdf;
  if (vertex.on_surface() && (dot(vertex.point.normal, in) > 0) != (dot(vertex.point.normal, vertex.out) > 0))
    sample.lobe = diffuse_transmission;
  return sample;
}

/// A shadow ray from one vertex to another, which ends just before it.
Ray connecting_ray(const PathVertex& from, const PathVertex& to);
/// Whether the vertex lies on an object that is invisible to the camera.
inline bool unseen(const PathVertex& vertex) {
  return (vertex.on_surface() || vertex.kind == PathVertex::Kind::luminaire) && !vertex.point.object->visible_to_camera;
}
/// A shadow ray from a vertex to a point of the lens.
Ray lens_ray(const PathVertex&, const LensSample&);
/// A ray that leaves a vertex.
Ray leaving_ray(const PathVertex& from, const Vector3& direction);
/// The media along a ray that leaves a vertex. `scratch` holds them if they differ from those around the vertex.
const MediumStack* media_towards(const PathVertex&, const Vector3& direction, MediumStack& scratch);

}  // namespace etendue
