#pragma once
// Vertices of light transport paths.

#include "etendue/camera.h"
#include "etendue/scene.h"
#include "etendue/shader.h"
#include "etendue/transport/luminaires.h"
#include "etendue/transport/medium.h"
#include "etendue/transport/scattering.h"

namespace etendue {

/// Where a path is scattered, begins or ends.
struct PathVertex {
  enum class Kind : std::uint8_t { camera, luminaire, surface, medium, escape };

  Kind kind = Kind::surface;
  /// Of a surface: light left a body here that it entered elsewhere (Shader::sample_exit); no ray came here.
  bool subsurface_exit = false;
  SurfacePoint point;                  ///< in a medium only the position and time mean something; of an escape nothing
  const Scatter* scatter = nullptr;    ///< of a surface; null: black
  Lobes lobes = vertex_lobes;          ///< those of a surface among which a walk chooses
  Medium medium;                       ///< of a vertex in a medium
  const MediumStack* media = nullptr;  ///< around, on the side of `out`; null: nothing is tracked
  Vector3 out;                         ///< unit, to the vertex before; of an escape: against the ray

  bool on_surface() const { return kind == Kind::surface; }
  bool in_medium() const { return kind == Kind::medium; }
  /// Whether light that comes from a direction can be scattered here, and not by a mirror alone.
  bool scatters_smoothly() const { return in_medium() || (on_surface() && scatter && scatter->has(smooth_lobes)); }
  /// For a light sampler: zero where directions are not measured against a surface.
  Normal3 normal() const { return in_medium() ? Normal3{} : point.normal; }
};

/// f |cos| of light scattered at a surface or a point of a medium from `out` towards `in` [1/sr], and the solid-angle density
/// with which a walk that came from `out` is scattered to `in` [1/sr].
inline ScatterValue scattering(const PathVertex& v, const Vector3& out, const Vector3& in, Transport transport) {
  if (v.in_medium()) {
    const float phase = v.medium.phase(v.point.position, v.point.time, out, in);
    return {Spectrum(phase), phase};
  }
  return v.scatter ? v.scatter->value_and_pdf(out, in, transport, v.lobes) : ScatterValue{};
}
/// The same density alone.
inline float scattering_pdf(const PathVertex& v, const Vector3& out, const Vector3& in, Transport transport) {
  if (v.in_medium()) return v.medium.phase(v.point.position, v.point.time, out, in);
  return v.scatter ? v.scatter->pdf(out, in, transport, v.lobes) : 0;
}

/// A direction that somebody else chose, with this density [1/sr], as a walk goes on in it (Walk::leave): a guide's, a map's.
/// Smooth lobes alone scatter there, so a guide must leave some chance to `sample_direction`, which knows of the others.
/// `density` is that of the whole mixture; what `sample_direction` gives is to be weighted by (its density / the mixture's) if
/// smooth, and over its share if specular. Empty: nothing is scattered that way.
inline std::optional<ScatterSample> scattered_towards(const PathVertex& v, const Vector3& in, float pdf, Transport transport) {
  const ScatterValue f = scattering(v, v.out, in, transport);
  if (!(pdf > 0) || f.value.black()) return {};
  ScatterSample s;
  s.direction = in;
  s.weight = f.value / pdf;
  s.pdf = pdf;
  if (v.on_surface() && (dot(v.point.normal, in) > 0) != (dot(v.point.normal, v.out) > 0)) s.lobe = diffuse_transmission;
  return s;
}

/// A ray from one vertex to another that ends just before it.
Ray connecting_ray(const PathVertex& from, const PathVertex& to);
/// Whether the camera does not see what a vertex lies on.
inline bool unseen(const PathVertex& v) {
  return (v.on_surface() || v.kind == PathVertex::Kind::luminaire) && !v.point.object->visible_to_camera;
}
/// A ray from a vertex to a point of the lens.
Ray lens_ray(const PathVertex&, const LensSample&);
/// A ray that leaves a vertex.
Ray leaving_ray(const PathVertex& from, const Vector3& direction);
/// The media along a ray that leaves a vertex; `scratch` holds them when they differ from those around the vertex.
const MediumStack* media_towards(const PathVertex&, const Vector3& direction, MediumStack& scratch);

}  // namespace etendue
