#pragma once
// Ray trees: the steps shared by renderers that trace a tree of rays from the camera.

#include <optional>

#include "etendue/light_sampler.h"
#include "etendue/transport/boundaries.h"
#include "etendue/transport/light_groups.h"
#include "etendue/transport/medium.h"
#include "etendue/transport/path_vertex.h"
#include "etendue/transport/sample_context.h"
#include "etendue/transport/scattering.h"

namespace etendue {

/// The media around the origin of a camera ray; null if the scene has no objects that a ray can be inside of.
inline MediumStack* media_around(const Scene& scene, const Ray& ray, MediumStack& media) {
  if (!scene.has_interiors()) return nullptr;
  media_at(scene, ray.origin, ray.time, media);
  return &media;
}

/// Finds the nearest surface on a ray. Boundaries that are hidden inside an object of higher priority are crossed on the way,
/// which moves the ray's origin. `media` are those around the origin; null: media are not tracked.
inline bool meet_surface(const Scene& scene, Ray& ray, MediumStack* media, Hit& hit, SurfacePoint& point) {
  for (int crossings = 0; scene.nearest(ray, hit); ++crossings) {
    scene.locate(ray, hit, point);
    if (media) resolve_coincident(scene, ray, hit, point, *media);
    point.media = media;
    if (!media || !hidden_by_priority(*media, *point.object) || crossings == most_crossings) return true;
    cross_boundary(*media, *point.object, point.normal, ray.direction);
    ray.maximum -= hit.distance;
    ray.origin = point.exit(ray.direction);
    ray.width = point.footprint;
  }
  return false;
}

/// Continues a ray from a point in a sampled direction; `media` change if the ray goes through the surface. The width of the
/// ray grows as after a plane mirror.
inline void go_on(const SurfacePoint& point, const ScatterSample& next, Ray& ray, MediumStack* media) {
  if (media && next.transmitted()) cross_boundary(*media, *point.object, point.normal, next.direction);
  // A null-scattered ray keeps its far end (Camera::Reach).
  ray.maximum = next.lobe == null_scattering ? ray.maximum - distance(ray.origin, point.position) : infinity;
  ray.origin = point.exit(next.direction);
  ray.direction = next.direction;
  ray.of_camera &= next.lobe == null_scattering;
  ray.width = point.footprint;
}

/// Unoccluded light from a point of a luminaire: the shadow ray has not been traced yet.
struct LuminaireSample {
  Vector3 direction;  ///< unit, to the luminaire
  Spectrum radiance;  ///< [W m^-2 sr^-1 nm^-1]
  float pdf = 0;      ///< [1/sr], without the probability of the luminaire
  bool delta = false;
  Ray shadow;
};

/// Samples a point on a luminaire as seen from a surface point; false: no light arrives from there. `lights`: the sampler that
/// chose it; null: it was not chosen.
inline bool sample_luminaire(const Scene& scene, const LightSampler* lights, const SceneObject& luminaire,
                             const SurfacePoint& point, const Wavelengths& wavelengths, Point2 u, LuminaireSample& light) {
  SurfaceSample sampled = lights ? lights->sample(luminaire, point.position, point.normal, u, point.time)
                                 : luminaire.sample_visible(point.position, u, point.time);
  if (!(sampled.pdf > 0)) return false;
  light.radiance = luminaire.emission->radiance(sampled.point, -sampled.direction, wavelengths);
  if (light.radiance.black() || !scene.in_front(sampled.point, -sampled.direction)) return false;
  if (sampled.infinite)
    point.leave(sampled.direction, light.shadow);
  else
    point.towards(sampled.point, light.shadow);
  light.direction = sampled.direction;
  light.pdf = sampled.pdf;
  light.delta = sampled.delta;
  return true;
}

/// A ray of the tree with its own state: the branches of a tree can be in different media, and carry different wavelengths.
struct RayBranch {
  Ray ray;
  Spectrum throughput{1.0f};
  Wavelengths wavelengths;
  MediumStack media = {};
  bool tracked = false;                ///< whether media are tracked
  int depth = 1;                       ///< segments from the camera to the ray's end
  int crossings = 0;                   ///< consecutive null scatterings
  PathState path = path_after_camera;  ///< with light path expressions: of the branch up to the surface at its end

  /// The same with the scattering of light there from `in`, by the lobe if it is specular, else by the smooth ones of `lobes`.
  PathState path_after(const SurfacePoint& point, const Scatter& scatter, const Vector3& in, Lobe lobe = diffuse_reflection,
                       Lobes lobes = vertex_lobes) const {
    if (!PathStates::current()) [[likely]]
      return path;
    PathVertex vertex;
    vertex.point = point;
    vertex.scatter = &scatter;
    vertex.lobes = lobes;
    vertex.out = -ray.direction;
    return PathStates::current()->scattered(path, vertex, in, lobe);
  }
  /// Counts a scattering by this lobe; false: the ray must end (most_crossings).
  bool may_go_on(Lobe lobe) {
    crossings = lobe == null_scattering ? crossings + 1 : 0;
    return crossings <= most_crossings;
  }

  RayBranch(const Scene& scene, const Ray& camera_ray, const Wavelengths& wavelengths_)
      : ray(camera_ray), wavelengths(wavelengths_) {
    tracked = media_around(scene, ray, media) != nullptr;
  }
  MediumStack* around() { return tracked ? &media : nullptr; }
};

/// The state that all branches of one sample's tree share, and the radiance that they gather.
struct RayTree {
  const Scene& scene;
  SampleContext& sample;
  Spectrum radiance = {};

  /// `path`: of the whole path but its luminaire.
  void add(int length, const Spectrum& light, const SceneObject* luminaire, PathState path) {
    radiance += light;
    PathStates* const states = PathStates::current();
    report_light(sample.sink, length, light, luminaire, states ? states->ended(path, luminaire) : PathState{});
  }
  /// Adds the light that a luminaire emits from a point at the end of a branch, an emitter hit.
  void add_emission(const RayBranch& branch, const SurfacePoint& point, const SceneObject* luminaire) {
    const Spectrum light = branch.throughput * luminaire->emission->radiance(point, -branch.ray.direction, branch.wavelengths);
    add(branch.depth, light, luminaire, branch.path);
    sample.sink.emitter_hit(light, branch.depth, 1);
  }
  /// Samples a specular lobe or null scattering at the end of a branch, and returns the branch that continues from there;
  /// nullopt: none does. `first`: whether this is the first branch that continues from the surface.
  std::optional<RayBranch> continued(const RayBranch& branch, const SurfacePoint& point, const Scatter& scatter, Lobe lobe,
                                     bool& first) {
    const float choice = sample.numbers.next();  // a surface may have several lobes of this kind
    const auto next = scatter.sample(-branch.ray.direction, choice, sample.numbers.next_pair(), {.lobes = lobe});
    if (!next || enters_subsurface(point, *next)) return std::nullopt;
    RayBranch child = branch;
    child.throughput *= next->weight;
    child.path = branch.path_after(point, scatter, next->direction, next->lobe);
    if (next->dispersive) child.throughput *= child.wavelengths.drop_secondary();
    if (child.throughput.black() || !child.may_go_on(lobe)) return std::nullopt;
    if (lobe != null_scattering) ++child.depth;  // null scattering does not count as a segment
    go_on(point, *next, child.ray, child.around());
    if (!first) sample.sink.surface(point, branch.throughput);  // path records of a branch begin at this surface
    first = false;
    sample.sink.scattered(*next);
    return child;
  }
  /// For a branch that hits no surface: calls `add(luminaire)` for each luminaire at infinity, with `point` on it.
  template <class Add>
  void escape(const RayBranch& branch, Hit& hit, SurfacePoint& point, const Add& add) {
    for (const SceneObject* far : scene.infinite_luminaires(branch.ray)) {
      far->surface_point(branch.ray, hit, point);
      sample.sink.escape(*far, branch.ray, branch.throughput);
      add(far);
    }
  }
};

}  // namespace etendue
