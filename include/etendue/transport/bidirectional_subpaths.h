#pragma once
// BidirectionalSubpaths: a subpath from the camera, a subpath from a luminaire, and every strategy that makes a path of them,
// with its multiple importance sampling weight.
//
// A strategy (s, t) takes s vertices y_0 … y_{s-1} from the luminaire and t vertices z_0 … z_{t-1} from the lens. With alpha
// the throughputs of the subpaths, its contribution is
//     C_{s,t} = alpha_s c_{s,t} alpha_t     (Veach 1997, section 10.1; connection.h),
// which counts w_{s,t} C_{s,t}, with w the multiple importance sampling weight of the strategy (bidirectional_weight.h).
//   s = 0: emitter hit. z_{t-1} lies on a luminaire.
//   s = 1: next event estimation. A point of a luminaire is sampled as seen from z_{t-1}.
//   t = 1: light tracing. y_{s-1} is connected to the lens, and the contribution is splatted where it falls on the film.
//   other: y_{s-1} and z_{t-1} are connected.
// Merging: a photon whose light subpath has s vertices before it lies within the radius r of z_{t-1}, and is taken to lie there
// (photons.h).
//
//     BidirectionalSubpaths paths(context, lights, sample, weights);
//     paths.from_camera(ray, limits);
//     paths.from_luminaire(ray.time, limits);
//     for each t: if (const auto light = paths.next_event(t)) add_contribution(sample, *light, …);  …
//
// render/bidirectional.h is the estimator that sums all strategies.

#include <optional>

#include "etendue/transport/bidirectional_weight.h"
#include "etendue/transport/connection.h"
#include "etendue/transport/fluorescence.h"

namespace etendue {

struct Photon;

/// The contribution of one path, made by one strategy.
struct PathContribution {
  int s = 0, t = 0;  ///< vertices from the luminaire and from the camera
  bool merged = false;
  Spectrum light;                          ///< C, without w [W m^-2 sr^-1 nm^-1]; for t = 1 the value of a Splat
  const SceneObject* luminaire = nullptr;  ///< null: emitted by a medium
  float weight = 1;                        ///< w
  Point2 film = {};                        ///< of t = 1: where it is splatted
  PathState matches = {};                  ///< the light path expressions that the path matches
  double path_tracing_moment = 1;          ///< G; computed where the sample has a list of records
  /// Segments of the path. A merged photon and z_{t-1} are one vertex.
  int length() const { return s + t - 1; }
};

/// A record of what path tracing alone would make of the light that a bidirectional sample has found, for a PathSink with a
/// list of these: w C^2 (G - w) [Y^2], with G of path_tracing_moment and C [Y]. The mean over samples is by how much the second
/// moment of path tracing, summed over the lengths of paths, is larger than that of bidirectional path tracing.
struct PathTracingExcess {
  double value = 0;
  std::optional<Point2> film = {};  ///< where the light is splatted; none: in the sample's own pixel
};

/// At most one may exist per thread at a time: its vertices are stored in memory of the thread that the next one uses again.
class BidirectionalSubpaths {
 public:
  BidirectionalSubpaths(const RenderContext&, const LightSampler&, SampleContext&, const StrategyWeights&);

  /// For scenes with fluorescence, before the subpaths are traced: draws their wavelengths for paths of at most so many
  /// reradiations (fluorescence.h). Without, paths are elastic. `dyes`: also of dyes in media, which weights do not know.
  void follow_fluorescence(int most, bool dyes);

  /// Traces the camera subpath. The distribution that chooses its directions (SubpathLimits) is part of all weights after this.
  void from_camera(const Ray&, const SubpathLimits&);
  /// Traces the light subpath with its own stream of primary samples ("light"); call it after `from_camera`. It has no vertices
  /// when no light is emitted in the sampled direction.
  void from_luminaire(float time, const SubpathLimits&);

  int camera_vertices() const { return int(camera_.size()); }
  int light_vertices() const { return int(light_.size()); }
  /// z_{t-1} and y_{s-1}.
  const SubpathVertex& camera_vertex(int t) const { return camera_[size_t(t - 1)]; }
  const SubpathVertex& light_vertex(int s) const { return light_[size_t(s - 1)]; }
  const std::vector<SubpathVertex>& camera_subpath() const { return camera_; }
  /// Whether all vertices between the lens and z_{t-1} scatter specularly.
  bool has_specular_prefix(int t) const;
  /// The wavelengths of light that the light subpath sends to the lens.
  const Wavelengths& light_wavelengths() const { return levels_ ? (*levels_)[0] : light_wavelengths_; }
  /// What contributions must be multiplied by: 1 / P(k) of the number of reradiations.
  float level_weight() const { return levels_ ? levels_->weight() : 1; }

  /// s = 0, along the segments of the camera subpath: emission of media, and emitters whose surface has null scattering only.
  std::span<const PathContribution> segment_emission() const { return segment_emission_; }
  /// s = 0: z_{t-1} lies on a luminaire, or the ray escapes to luminaires at infinity. Valid until the next call.
  std::span<const PathContribution> emitter_hits(int t) const;
  /// s = 1.
  std::optional<PathContribution> next_event(int t) const;
  /// s > 1, t > 1.
  std::optional<PathContribution> connect(int s, int t) const;
  /// t = 1. For s = 1 the point of the luminaire itself is connected to the lens.
  std::optional<PathContribution> connect_to_lens(int s) const;
  /// A photon within r of z_{t-1}.
  std::optional<PathContribution> merge(const Photon&, int t) const;

  /// Stores both subpaths in the sample's PathRecord, if it has one.
  void record() const;

 private:
  /// The wavelengths of the segment beyond a vertex of the camera subpath.
  const Wavelengths& wavelengths_beyond(const SubpathVertex& z) const {
    return levels_ ? (*levels_)[z.level] : sample_.wavelengths;
  }
  /// Whether light that comes to a vertex of the camera subpath straight from a luminaire is of the luminaire's level.
  bool at_last_level(const SubpathVertex& z) const { return !levels_ || z.level == levels_->count(); }

  /// The state of the camera subpath with its scattering at z_{t-1} from a direction, and of the light subpath at y_{s-1}.
  PathState path_from_camera(int t, const Vector3& in) const;
  PathState path_from_luminaire(int s, const Vector3& on) const;
  void add_emitter_hit(const SubpathVertex&, const SurfacePoint& luminaire, int t, std::vector<PathContribution>&) const;
  void add_emitter_hits(int t, std::vector<PathContribution>&) const;
  /// Sets the weight of a contribution, and what path tracing would make of it if that is asked for.
  void weigh(PathContribution&, const ConnectedPath&) const;
  /// The path of strategy (s, 1), whose last vertex is `lens`.
  ConnectedPath path_to_lens(int s, const LensConnection&, const SubpathVertex& lens) const;
  /// The pdf (vertex_pdf) of the vertex before the last among a subpath's first `count` vertices, if it is sampled from the
  /// opposite end: by a walk that comes to the last vertex from the direction `from` and is scattered there.
  float before_from(const std::vector<SubpathVertex>& subpath, int count, const Vector3& from, Transport) const;

  const RenderContext& context_;
  const LightSampler& lights_;
  SampleContext& sample_;
  const StrategyWeights weights_;
  std::vector<SubpathVertex>&camera_, &light_;
  std::vector<PathContribution>&segment_emission_, &hits_;
  Wavelengths light_wavelengths_;
  std::optional<WavelengthLevels> levels_;  ///< of a sample that follows fluorescence
  bool dyes_ = false;
  Medium emitting_;  ///< while the camera subpath is traced: the medium of its segment
  const EmissionPlane front_;
  CameraDirections* directions_ = nullptr;
  float y0_next_event_point_pdf_ = 0;  ///< pdf of y_0 when it is sampled as seen from y_1
};

/// Adds a weighted contribution to the sample's radiance, or splats it (t = 1), and passes it to the sample's PathSink.
void add_contribution(SampleContext&, const Wavelengths& of_light, const PathContribution&, Spectrum& radiance);

/// The sum of the weighted contributions of one sample. `accept(PathContribution&)` returns whether a contribution counts, and
/// may scale it.
template <class Accept>
class ContributionSum {
 public:
  ContributionSum(SampleContext& sample, const BidirectionalSubpaths& paths, const Accept& accept)
      : sample_(sample), paths_(paths), accept_(accept) {}

  void add(PathContribution contribution) {
    contribution.light *= paths_.level_weight();
    if (accept_(contribution)) add_contribution(sample_, paths_.light_wavelengths(), contribution, radiance);
  }
  void add(const std::optional<PathContribution>& contribution) {
    if (contribution) add(*contribution);
  }
  void add(std::span<const PathContribution> contributions) {
    for (const PathContribution& each : contributions) add(each);
  }

  Spectrum radiance;

 private:
  SampleContext& sample_;
  const BidirectionalSubpaths& paths_;
  const Accept accept_;
};

}  // namespace etendue
