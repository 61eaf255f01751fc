#pragma once
// Two walks, one from the camera and one from a luminaire, and every way to make a path of them.
//
// With alpha the walks' throughputs and w the multiple-importance weight of a strategy among all that could have made the same
// path (bidirectional_weight.h), the path of s vertices from the luminaire and t from the camera brings
//     C_{s,t} = w_{s,t} alpha_s c_{s,t} alpha_t     (Veach 1997, section 10.1; connection.h).
//   s = 0: the camera's walk meets a luminaire.      s = 1: a luminaire is sampled as seen from z_{t-1}.
//   t = 1: the light's walk goes to the lens, and the light falls on the film where it does.
// Merging: a photon that came by s vertices lies within r of z_{t-1}, and is taken to have come there (photons.h).
//
//     BidirectionalSubpaths walks(context, lights, sample, heuristic);
//     walks.from_camera(ray, limits, found);
//     walks.from_luminaire(ray.time, limits);
//     for each t: if (const auto light = walks.sample_luminaire(t)) found(*light);  …

#include <optional>

#include "etendue/transport/bidirectional_weight.h"
#include "etendue/transport/connection.h"

namespace etendue {

struct Photon;

/// Light that one strategy found.
struct PathContribution {
  int s = 0, t = 0;  ///< vertices from the luminaire and from the camera
  bool merged = false;
  Spectrum light;  ///< [W m^-2 sr^-1 nm^-1] of the sample, without the weight; for t = 1 as a Splat counts it
  const SceneObject* luminaire = nullptr;  ///< that it comes from; null: a medium sent it
  float weight = 1;
  Point2 film = {};  ///< of t = 1: where it falls
  /// Segments of the path. A photon takes the place of its own vertex and the camera's.
  int length() const { return s + t - 1; }
};

/// Who is told of what the camera's walk finds while it grows.
struct LightListener {
  virtual void found(const PathContribution&) = 0;

 protected:
  ~LightListener() = default;
};

/// One at a time on each thread: its walks live in the thread's own memory.
class BidirectionalSubpaths {
 public:
  BidirectionalSubpaths(const RenderContext&, const LightSampler&, SampleContext&, const StrategyWeights&);

  /// Lets the camera's walk grow; whoever chooses its directions (SubpathLimits) is in the weights from then on. `listener`
  /// hears of light that media send (s = 0) and of luminaires passed straight through; those at the walk's vertices are for
  /// `meet`.
  void from_camera(const Ray&, const SubpathLimits&, LightListener&);
  /// Lets the light's walk grow, by numbers of its own ("light"); after the camera's. It has no vertices when no light leaves.
  void from_luminaire(float time, const SubpathLimits&);

  int camera_vertices() const { return int(camera_.size()); }
  int light_vertices() const { return int(light_.size()); }
  /// z_{t-1} and y_{s-1}.
  const SubpathVertex& camera_vertex(int t) const { return camera_[size_t(t - 1)]; }
  const SubpathVertex& light_vertex(int s) const { return light_[size_t(s - 1)]; }
  const std::vector<SubpathVertex>& camera_subpath() const { return camera_; }
  /// Whether mirrors and clear surfaces alone lie between the lens and z_{t-1}.
  bool has_specular_prefix(int t) const;
  const Wavelengths& light_wavelengths() const { return light_wavelengths_; }

  /// s = 0: z_{t-1} lies on a luminaire, or sees those at infinity.
  void meet(int t, LightListener&) const;
  /// s = 1.
  std::optional<PathContribution> sample_luminaire(int t) const;
  /// s > 1, t > 1.
  std::optional<PathContribution> connect(int s, int t) const;
  /// t = 1.
  std::optional<PathContribution> connect_to_lens(int s) const;
  /// Of a photon that lies within r of z_{t-1}.
  std::optional<PathContribution> merge(const Photon&, int t) const;

  /// For people: both walks, when the sample is recorded.
  void record() const;

 private:
  void meet_at(const SubpathVertex&, const SurfacePoint& luminaire, int t, LightListener&) const;
  /// The density of a walk's vertex before its last, `count` vertices long, had a walk come from `from` through the last.
  float before_from(const std::vector<SubpathVertex>& walk, int count, const Vector3& from, Transport) const;

  const RenderContext& context_;
  const LightSampler& lights_;
  SampleContext& sample_;
  const StrategyWeights weights_;
  std::vector<SubpathVertex>&camera_, &light_;
  Wavelengths light_wavelengths_;
  const EmissionPlane front_;
  CameraDirections* directions_ = nullptr;
  float direct_ = 0;  ///< density of y_0 when it is sampled as seen from y_1
};

/// Tells a sample of light that was found: its value, or a splat, and whoever observes it.
void add_contribution(SampleContext&, const Wavelengths& of_light, const PathContribution&, Spectrum& radiance);

}  // namespace etendue
