#pragma once
// SubpathVertex: the vertices of a subpath that is stored as a whole, with the pdfs by which both directions of tracing sample
// them: for algorithms that connect two subpaths, merge them, or weight strategies against each other (bidirectional_weight.h).
//
// The pdf of a vertex is per area [1/m^2] on surfaces and per volume [1/m^3] in media, where the pdf of the distance replaces
// the cosine. With p_w the pdf [1/sr] of the direction from a to b, d their distance, S the transmittance of the segment and
// s_b the extinction at b,
//     p(b) = p_w S |cos_b| / d^2   or   p_w S s_b / d^2   (Veach 1997, section 8.2.2; Pauly, Kollig & Keller 2000,
// "Metropolis light transport for participating media", section 3). Points of a luminaire at infinity have pdfs per solid
// angle, and the points that it lights have the pdf p_A |cos| or p_A s_b, with p_A [1/m^2] that of the ray's point on the plane
// across its direction (EmissionPlane).
//
// These pdfs are used in weights only, and must not depend on the strategy that made the path. So S and s_b are means over the
// path's wavelengths, and the pdf of a specular lobe counts as 1.

#include <optional>
#include <vector>

#include "etendue/camera.h"
#include "etendue/transport/path_layers.h"
#include "etendue/transport/path_vertex.h"
#include "etendue/transport/sample_context.h"

namespace etendue {

/// A vertex of a stored subpath. The objects that it points to lie in the sample's arena.
struct SubpathVertex : PathVertex {
  bool leaves_specularly = false;  ///< the subpath leaves the vertex by a specular lobe
  bool infinite = false;           ///< on a luminaire at infinity, or an escaped ray
  bool hero_only = false;          ///< the throughput holds the hero wavelength only
  bool parallel = false;           ///< the camera is orthographic: its rays have a pdf per area [1/m^2] instead of per solid
                                   ///< angle
  Spectrum throughput;           ///< alpha: contribution of the subpath up to here over its pdf; from a luminaire flux [W/nm],
                                 ///< from the camera 1 at first
  float extinction = 0;          ///< in a medium [1/m], mean over the wavelengths
  float mean_transmittance = 1;  ///< of the segment from the vertex before
  float pdf_forward = 0;  ///< of the vertex, sampled from the vertex before [1/m^2 on a surface; 1/m^3 in a medium; 1/sr on a
                          ///< luminaire at infinity and of an escaped ray]
  float pdf_reverse = 0;  ///< the same, sampled from the vertex after
  PathState path;  ///< with light path expressions: of the subpath up to here, its scattering here included (path_layers.h); a
                   ///< forward state from the camera, a backward one from a luminaire
  int level = 0;   ///< of the wavelengths beyond the vertex, seen from the subpath's beginning (fluorescence.h)

  /// Whether the vertex can be connected to a vertex of another subpath: it has a lobe that is not specular, whichever lobe the
  /// subpath sampled.
  bool connectable() const { return on_surface() ? scatters_smoothly() : kind != Kind::escape; }
};

template <bool unattenuated>
class Walk;
class WavelengthLevels;

/// A distribution that samples the directions of camera subpaths in place of scattering alone: a path guide.
class CameraDirections {
 public:
  virtual ~CameraDirections() = default;
  struct Choice {
    std::optional<ScatterSample> next;  ///< its pdf is that of the whole mixture; empty: absorbed
    float more = 1;                     ///< that pdf over the pdf of scattering alone
  };
  /// Samples the direction in which a walk leaves its last vertex.
  virtual Choice sample(const Walk<false>&, float choice, Point2 u) = 0;
  /// The pdf [1/sr] with which a walk that came from `out` samples `in`, where scattering alone has the pdf `scatter`.
  virtual float pdf(const PathVertex&, const Vector3& out, const Vector3& in, float scatter) const = 0;
};

/// Limits of a subpath's length, and how its directions are sampled.
struct SubpathLimits {
  int longest = 64;                          ///< maximum length in segments
  int roulette_depth = 5;                    ///< segments before Russian roulette may end the subpath
  CameraDirections* directions = nullptr;    ///< for camera subpaths, and for the pdfs of other vertices as sampled from the
                                             ///< camera; null: directions are sampled by scattering alone
  bool reverse_pdfs = true;                  ///< whether SubpathVertex::pdf_reverse is computed, which weights alone need
  const WavelengthLevels* levels = nullptr;  ///< the subpath follows fluorescence through these wavelengths; null: it does not
  bool dyes = false;                         ///< whether that includes dyes in media, whose vertices have no pdfs for weights
};

/// The pdf [1/sr] with which a camera subpath that came from `out` samples `in`; `scatter` is the pdf of scattering alone.
inline float camera_pdf(const CameraDirections* directions, const PathVertex& vertex, const Vector3& out, const Vector3& in,
                        float scatter) {
  return directions ? directions->pdf(vertex, out, in, scatter) : scatter;
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

/// Fills a stored vertex from the last vertex of a walk, for algorithms that drive a Walk themselves; the walk must have
/// `stores_subpath` set. `before` is the vertex before, and `pdf` that of the direction from it [1/sr], or 1 after a specular
/// lobe (where Walk::direction_pdf is a probability). `leaves_specularly` and `pdf_reverse` are only known when the walk leaves
/// the vertex: see generate_camera_subpath.
void store_vertex(const Walk<false>&, const SubpathVertex& before, float pdf, const EmissionPlane&, SubpathVertex&);

/// Traces the subpath that starts with a camera ray, using the sample's wavelengths and primary samples. An escaped subpath
/// ends with a vertex of kind `escape`.
void generate_camera_subpath(const RenderContext&, const Ray&, const SubpathLimits&, SampleContext&,
                             std::vector<SubpathVertex>& walk, SegmentEvents&);

/// Traces a subpath that starts on a luminaire, chosen by power, using the context's wavelengths and primary samples. False: no
/// light is emitted in the sampled direction; the subpath is then the point on the luminaire alone, which can still be
/// connected, or empty. With `targets` the first ray is sampled by ProjectionMap::sample_emitted_light, towards specular
/// objects.
bool generate_light_subpath(const Scene&, const LightSampler&, float time, const SubpathLimits&, SampleContext&,
                            std::vector<SubpathVertex>& walk, EmittedLight&, const ProjectionMap* targets = nullptr,
                            SegmentEvents* events = nullptr);

/// The pdf of a vertex b that is sampled from a: `pdf` is that of the direction [1/sr], `direction` is unit from a to b, and
/// `mean_transmittance` that of the segment.
float vertex_pdf(float pdf, const SubpathVertex& a, const SubpathVertex& b, const Vector3& direction, float mean_transmittance,
                 const EmissionPlane&);

/// The first vertex of a camera subpath: a point of the lens.
SubpathVertex lens_vertex(const Camera&, const Point3&, float time);

/// The pdf of a camera ray's direction [1/sr]; for an orthographic camera that of its position [1/m^2].
float camera_direction_pdf(const Camera&, const Ray&);

/// The pdf of a luminaire's point as the origin of a light subpath [1/m^2]; for a luminaire at infinity [1/sr]. `direction` is
/// unit, from x1 to the point.
float pdf_emission_origin(const LightSampler&, const SubpathVertex& x1, const SubpathVertex& luminaire,
                          const Vector3& direction);

/// The pdf of that point by next event estimation from x1 [1/m^2]; for a luminaire at infinity [1/sr].
float next_event_point_pdf(const LightSampler&, const SubpathVertex& x1, const SubpathVertex& luminaire,
                           const Vector3& direction);

/// Stores the vertices of a subpath in a PathRecord.
void record_subpath(std::vector<PathRecord::Vertex>&, std::span<const SubpathVertex> walk);

}  // namespace etendue
