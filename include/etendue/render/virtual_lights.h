#pragma once
// Virtual lights: vertices of light subpaths, treated as point sources of the light that they scatter (Keller 1997, "Instant
// radiosity"). From n light subpaths, the radiance that a point z scatters towards the camera is
//     L(z) = (direct light) + 1/n sum_y f_z G(y, z) V f_y alpha_y,     G = |cos_y| |cos_z| / d^2
// (without the cosines in media), where the sum is over all subpath vertices y with non-delta lobes. All paths of a step share
// the virtual lights.
//
// G is unbounded, and lights near z make bright spots. So a virtual light contributes only the fraction
//     w(y, z) = min(1, b / G(y, z)).
// The remaining 1 - w is found by continuing the camera subpath from z (Kollig & Keller 2004, "Illumination in the presence of
// weak singularities"): at the next vertex y, direct light, the other virtual lights, and the further continuation of the
// subpath contribute, times 1 - w(y, z). Nothing is lost then for any b, and G (1 - w) / p is bounded, too; without this
// compensation corners are too dark. At most vertices after z, 1 - w = 0, and the subpath ends.
//
// Virtual lights are neither stored at specular vertices nor gathered there: at specular vertices the camera subpath continues
// with its whole throughput.

#include "etendue/render/photon_process.h"
#include "etendue/transport/camera_walk.h"
#include "etendue/transport/connection.h"
#include "etendue/transport/renderer_members.h"
#include "etendue/transport/roulette.h"

namespace etendue {

struct VirtualLight {
  SubpathVertex at;
  int vertices = 0;                        ///< of its subpath, the emitter's vertex and its own included
  const SceneObject* luminaire = nullptr;  ///< the emitter where its subpath began
  PathState rest = {};  ///< with light path expressions, the backward state of its subpath before it; as for photons, there is
                        ///< a light for each state of a distribution
};

/// The virtual lights of a step, with the memory they refer to.
struct VirtualLights {
  std::vector<VirtualLight> lights;
  std::vector<std::unique_ptr<Arena>> memory;
  double walks = 0;  ///< n
};

/// Settings for gathering virtual lights.
struct VirtualLightSettings {
  int max_depth = 64, roulette_depth = 5;
  Heuristic heuristic = Heuristic::power;
  bool compensate = true;
  float bound = 0;  ///< b [1/m^2]
};

class VirtualLightProcess : public PhotonProcess {
 public:
  /// `nearest`: the distance from which on a virtual light with both cosines 1 contributes fully, in widths of a pixel where it
  /// is first seen (the median over the picture).
  VirtualLightProcess(const Renderer& renderer_, const RenderContext& context_, VirtualLightSettings settings, float nearest)
      : PhotonProcess(renderer_, context_), settings_(settings) {
    settings_.bound = 1 / square(nearest * seen_pixel_width(context_));
  }

 protected:
  /// Traces the virtual lights of a step, after `share`.
  VirtualLights make_lights(Schedule&, const Step&, std::uint64_t walks) const;

  const VirtualLightSettings& settings() const { return settings_; }

  /// The weight w between points with these normals; normals are 0 in media.
  float part(const Point3& y, const Normal3& normal_y, const Point3& z, const Normal3& normal_z) const {
    const Vector3 d = y - z;
    const float squared = length_squared(d), distance = std::sqrt(squared);
    if (!(squared > 0)) return 0;
    float over = settings_.bound * squared;  // b / G
    if (normal_y != Normal3{}) over *= distance / std::abs(dot(normal_y, d));
    if (normal_z != Normal3{}) over *= distance / std::abs(dot(normal_z, d));
    return over < 1 ? over : 1;
  }

  /// The contribution of a virtual light at the last vertex of a camera subpath: w f_z G V f_y alpha_y.
  template <class Walk>
  Spectrum light_from(const VirtualLight& y, const Walk& walk, NumberStream& numbers) const {
    SubpathVertex z;
    static_cast<PathVertex&>(z) = walk.vertex;
    z.throughput = Spectrum(1.0f);
    z.hero_only = walk.sample.wavelengths.single();
    const float w = part(y.at.point.position, y.at.normal(), z.point.position, z.normal());
    if (!(w > 0)) return {};
    const auto c = connect(context.scene, y.at, z, walk.sample.wavelengths, numbers, walk.sample.arena);
    return c ? w * c->light : Spectrum();
  }

  /// Adds that, over the number of light subpaths and the probability of the light.
  template <class Walk>
  void add_light(const VirtualLight& y, Walk& walk, NumberStream& numbers, float divisor) const {
    const Spectrum light = light_from(y, walk, numbers) / divisor;
    PathState rest;
    Vector3 to_y;
    if (PathStates* const states = PathStates::current(); states && !light.black()) [[unlikely]] {
      to_y = normalize(y.at.point.position - walk.vertex.point.position);
      rest = states->scattered_before(y.rest, y.at, -to_y);
    } else if (states) {
      return;  // it adds nothing, and its direction may be none
    }
    walk.add_light(y.vertices, light, y.luminaire, rest, to_y);
  }

  /// A one-sample estimate of the radiance along a camera ray. `gather(walk)` adds the virtual lights at the subpath's last
  /// vertex.
  template <class Gather>
  Spectrum follow(const Ray& ray, SampleContext& sample, const Gather& gather) const {
    const LightSampler& luminaires = *renderer.light_sampler;
    const Roulette roulette{settings_.roulette_depth};
    CameraWalk<false> walk(context.scene, sample, ray, settings_.max_depth);
    const auto met = [&](const SurfacePoint& luminaire) {
      return walk.emitter_hit_weight(luminaires, settings_.heuristic, luminaire);
    };
    while (walk.next_vertex(met) && !walk.at_end()) {
      const PathVertex& vertex = walk.vertex;
      const NumberStream::Bounce u = walk.next_bounce();
      const Spectrum whole = walk.throughput;
      const bool smooth = vertex.scatters_smoothly(), gathered = !walk.arrived_specularly;  // at the previous vertex
      // Virtual lights at this vertex already contribute to the previous vertex, with weight w; the walk carries the rest,
      // 1 - w. Without compensation it carries only emitter hits, which may lie behind null-scattering surfaces.
      if (smooth && gathered && !vertex.subsurface_exit)
        walk.throughput *=
            settings_.compensate ? 1 - part(vertex.point.position, vertex.normal(), walk.from, walk.from_normal) : 0;
      if (smooth && !walk.throughput.black()) {
        walk.add_direct(luminaires, u, settings_.heuristic);
        gather(walk);
      }
      const auto next = walk.sample_direction(u.lobe_choice, u.direction);
      if (next && (next->specular() || enters_subsurface_of(vertex, *next))) walk.throughput = whole;
      if (next && !settings_.compensate && gathered && next->lobe != null_scattering) walk.throughput = {};
      if (next && !walk.throughput.black() && walk.go_on(*next) && roulette.survives(walk)) continue;
      walk.end();
    }
    return walk.radiance;
  }

 private:
  static bool enters_subsurface_of(const PathVertex& vertex, const ScatterSample& next) {
    return vertex.on_surface() && !vertex.subsurface_exit && enters_subsurface(vertex.point, next);
  }

  VirtualLightSettings settings_;
};

/// Describes the members of renderers with virtual lights, except the number of light subpaths.
template <auto max_depth, auto roulette_depth, auto heuristic, auto nearest, auto compensate, class R>
void describe_virtual_lights(Description<R>& d) {
  d.group("Paths");
  describe_max_depth<max_depth>(d, stored_subpath_depth, range(1, longest_stored_subpath));
  describe_roulette_depth<roulette_depth>(d);
  describe_heuristic<heuristic>(d);
  d.group("Virtual lights")
      .template member<nearest>(
          "nearest", "1",
          "distance within which a virtual light that is faced squarely counts less, in widths of a pixel "
          "where it is first seen (the median over the picture)",
          range(1e-3, 1e6), soft(1, 300), logarithmic)
      .template member<compensate>("compensate", "",
                                   "whether walks find what virtual lights nearby leave out; without, corners are too dark: a "
                                   "bias, and caustics are lost");
}

/// The path classes they find. Virtual lights do not carry the light of subsurface scattering and of emissive media.
inline constexpr PathClasses compensated_virtual_lights_find =
    all_paths & ~(fluorescence | subsurface_light | emitting_media | delta_caustics | delta_caustics_in_mirrors);
inline constexpr PathClasses bounded_virtual_lights_find = compensated_virtual_lights_find & ~area_caustics;

}  // namespace etendue
