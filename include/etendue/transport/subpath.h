#pragma once
// Walks that are kept as a whole, with the densities of their vertices from both sides: for algorithms that connect or compare
// what two walks found.
//
// Densities of vertices are per area [1/m^2] on surfaces and per volume [1/m^3] in media, where the density of the distance
// takes the place of the cosine: with p_w the solid-angle density of the direction from a to b and S the chance to get
// along the edge,
//     p(b) = p_w S |cos_b| / d^2   or   p_w S s_b / d^2   (Veach 1997, section 8.2.2; Pauly, Kollig & Keller 2000,
// "Metropolis light transport for participating media", section 3). Points of a luminaire at infinity have densities
// per solid angle, and what they light has the density p_A |cos| or p_A s_b, with p_A that of its place across the direction
// (EmissionPlane).
//
// These densities only weigh strategies against one another, and for that need be the same whichever strategy made
// the path: S and s_b are means over the path's wavelengths, and specular scattering counts 1.

#include <optional>
#include <vector>

#include "etendue/camera.h"
#include "etendue/transport/path_vertex.h"
#include "etendue/transport/sample_context.h"

namespace etendue {

/// A vertex of such a walk. What it points to lies in the sample's arena.
struct SubpathVertex : PathVertex {
  bool specular = false;         ///< the walk left it by a specular lobe
  bool infinite = false;         ///< a luminaire at infinity, or an escaped ray
  bool single = false;           ///< the throughput holds the hero only
  bool parallel = false;         ///< of a camera whose rays are parallel: its directions are given by places, not angles
  Spectrum throughput;           ///< what arrives, over the walk's density: of light flux [W/nm], of the camera 1 at first
  float extinction = 0;          ///< mean over wavelengths [1/m], in a medium
  float mean_transmittance = 1;  ///< of getting along the edge from the vertex before
  float pdf_forward = 0,
        pdf_reverse = 0;  ///< densities from the walk's side, and from the other: had a walk come here from the next

  /// Whether a path that ends here can be connected to another: by what is not specular, whatever the walk chose.
  bool connectable() const { return on_surface() ? scatters_smoothly() : kind != Kind::escape; }
};

template <bool clear>
class Walk;

/// Who chooses directions of walks from the camera where not scattering alone does: a guide.
class CameraDirections {
 public:
  virtual ~CameraDirections() = default;
  struct Choice {
    std::optional<ScatterSample> next;  ///< its density is that of whatever might have chosen it; empty: absorbed
    float more = 1;                     ///< that density, over the one of scattering alone
  };
  /// Where a walk goes on from its last vertex.
  virtual Choice sample(const Walk<false>&, float choice, Point2 u) = 0;
  /// With which density [1/sr] a walk that came from `out` goes on to `in`, where scattering alone has `scatter`.
  virtual float pdf(const PathVertex&, const Vector3& out, const Vector3& in, float scatter) const = 0;
};

/// How long walks are.
struct SubpathLimits {
  int longest = 64;                        ///< segments
  int roulette_depth = 5;                  ///< segments before Russian roulette may end a walk
  CameraDirections* directions = nullptr;  ///< of walks from the camera, and in the densities of others as if from there; null:
                                           ///< scattering alone chooses them
};

/// Density [1/sr] with which a walk from the camera that came from `out` goes on to `in`.
inline float camera_pdf(const CameraDirections* directions, const PathVertex& v, const Vector3& out, const Vector3& in,
                        float scatter) {
  return directions ? directions->pdf(v, out, in, scatter) : scatter;
}

/// Events along the segments of a subpath while it is traced; by default ignored. Vertices need no event: they are stored.
struct SegmentEvents {
  /// A medium emits light towards the camera: the path's length in segments, and its contribution.
  virtual void emitted(int /*length*/, const Spectrum&) {}
  /// The segment passes an emitter whose surface only scatters null: it is the subpath's last vertex during the call.
  virtual void crossed_luminaire() {}
  /// The segment enters a medium, along a ray and up to `reach` [m] unless it is scattered before, with this throughput at the
  /// ray's origin.
  virtual void through(const Medium&, const Ray&, float /*reach*/, const Spectrum& /*throughput*/) {}

 protected:
  ~SegmentEvents() = default;
};

class ProjectionMap;

/// Fills a kept vertex with what a walk has come to, for algorithms that let walks grow by themselves; set `keeps` of the walk.
/// `before` is the vertex before, and `density` that of the direction it was left in [1/sr], 1 after a specular lobe (where
/// Walk::direction_density is a probability). `specular` and `reverse` are known when the walk has gone on: see
/// generate_camera_subpath.
void store_vertex(const Walk<false>&, const SubpathVertex& before, float pdf, const EmissionPlane&, SubpathVertex&);

/// The walk that begins with a camera ray, which is the sample's. An escaped one ends with a vertex of kind `escape`.
void generate_camera_subpath(const RenderContext&, const Ray&, const SubpathLimits&, SampleContext&,
                             std::vector<SubpathVertex>& walk, SegmentEvents&);

/// A walk that begins at a luminaire, chosen by power. False: no light leaves there in the direction that was chosen; the walk
/// is the place on the luminaire alone, which may be seen from elsewhere, or empty. The context's
/// wavelengths and numbers are the walk's. `targets`, if any: it goes towards one of them.
bool generate_light_subpath(const Scene&, const LightSampler&, float time, const SubpathLimits&, SampleContext&,
                            std::vector<SubpathVertex>& walk, EmittedLight&, const ProjectionMap* targets = nullptr,
                            SegmentEvents* events = nullptr);

/// The density of a vertex b that was chosen from a by a direction of solid-angle density `density`; `direction` is unit
/// from a to b, `chance` that of getting along the edge.
float vertex_pdf(float pdf, const SubpathVertex& a, const SubpathVertex& b, const Vector3& direction, float mean_transmittance,
                 const EmissionPlane&);

/// Density of a camera ray's direction [1/sr]; of a camera with parallel rays that of its place [1/m^2].
float camera_direction_pdf(const Camera&, const Ray&);

/// The density of a luminaire's point as the beginning of such a walk; `direction` is unit, from x1 to it. [1/m^2]; of a
/// luminaire at infinity [1/sr].
float pdf_emission_origin(const LightSampler&, const SubpathVertex& x1, const SubpathVertex& luminaire,
                          const Vector3& direction);

/// Its density when a luminaire is sampled as seen from x1, in the same measure.
float pdf_next_event(const LightSampler&, const SubpathVertex& x1, const SubpathVertex& luminaire, const Vector3& direction);

/// For people: the vertices of a walk.
void record_subpath(std::vector<PathRecord::Vertex>&, std::span<const SubpathVertex> walk);

/// The features of the first surface along a camera ray, for renderers whose walks do not keep its hit.
void note_first_surface(const Scene&, const Ray&, SampleContext&);

}  // namespace etendue
