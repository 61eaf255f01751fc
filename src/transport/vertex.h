#pragma once
// A vertex of a light transport path, as algorithms that build paths from both ends see it.
//
// Densities of vertices are per area [1/m^2] on surfaces and per volume [1/m^3] in media, where the density of the distance
// takes the place of the cosine: with p_w the solid-angle density of the direction from a to b and S the chance to get
// along the edge,
//     p(b) = p_w S |cos_b| / d^2   or   p_w S s_b / d^2   (Veach 1997, section 8.2.2; Pauly, Kollig & Keller 2000,
// "Metropolis light transport for participating media", section 3). Points of a luminaire at infinity have densities
// per solid angle, and what they light has the density p_A |cos| or p_A s_b, with p_A that of its place across the direction
// (LightFront).
//
// These densities only weigh strategies against one another, and for that need be the same whichever strategy made
// the path: S and s_b are means over the path's wavelengths, and specular scattering counts 1.

#include "etendue/camera.h"
#include "etendue/scene.h"
#include "etendue/shader.h"
#include "etendue/transport/medium_stack.h"
#include "luminaire_sampling.h"

namespace etendue {

/// The lobes that make a vertex of a walk; what passes straight on makes none.
inline constexpr Lobes vertex_lobes = Lobes(all_lobes & ~pass_through);

struct Vertex {
  enum class Kind : std::uint8_t { camera, luminaire, surface, volume, escape };

  Kind kind = Kind::surface;
  bool specular = false;             ///< the walk was scattered on by a specular lobe
  bool infinite = false;             ///< a luminaire at infinity, or an escaped ray
  bool single = false;               ///< the throughput holds the hero only
  bool parallel = false;             ///< of a camera whose rays are parallel: its directions are given by places, not angles
  SurfacePoint point;                ///< in a volume only the position and time mean something
  const Scatter* scatter = nullptr;  ///< of a surface; null: black
  const VolumeShader* volume = nullptr;  ///< of a volume
  const MediumStack* media = nullptr;    ///< around, on the side of `out`; null: nothing is tracked
  Vector3 out;                           ///< unit, to the vertex before; of an escape: against the ray
  Spectrum throughput;                   ///< light or importance that arrives, over the walk's density
  float extinction = 0;                  ///< mean over wavelengths [1/m], of a volume
  float chance = 1;                      ///< of getting along the edge from the vertex before
  float forward = 0, reverse = 0;        ///< densities from the walk's side and from the other

  /// Whether two directions lie on different sides of the surface.
  bool crosses(const Vector3& a, const Vector3& b) const { return (dot(point.normal, a) > 0) != (dot(point.normal, b) > 0); }
  bool on_surface() const { return kind == Kind::surface; }
  /// Whether a path that ends here can be connected to another: by what is not specular, whatever the walk chose.
  bool connectable() const { return on_surface() ? scatter && scatter->has(smooth_lobes) : kind != Kind::escape; }
};

/// f |cos| of light scattered at a surface or volume vertex from `out` towards `in` [1/sr], and the solid-angle density
/// with which a walk that came from `out` is scattered to `in` [1/sr].
ScatterValue scattering(const Vertex&, const Vector3& out, const Vector3& in, Transport);
/// The same density alone.
float scattering_density(const Vertex&, const Vector3& out, const Vector3& in, Transport);

/// The density of a vertex b that was chosen from a by a direction of solid-angle density `density`; `direction` is unit
/// from a to b, `chance` that of getting along the edge.
float vertex_density(float density, const Vertex& a, const Vertex& b, const Vector3& direction, float chance,
                     const LightFront&);

/// A ray from one vertex to another that ends just before it.
Ray connecting_ray(const Vertex& from, const Vertex& to);
/// A ray from a vertex to a point of the lens.
Ray lens_ray(const Vertex&, const LensSample&);
/// A ray that leaves a vertex.
Ray leaving_ray(const Vertex& from, const Vector3& direction);
/// The media along a ray that leaves a vertex; `scratch` holds them when they differ from those around the vertex.
const MediumStack* media_towards(const Vertex&, const Vector3& direction, MediumStack& scratch);

}  // namespace etendue
