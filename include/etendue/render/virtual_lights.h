#pragma once
// Virtual lights: vertices of walks from luminaires, taken for points that send on what came to them (Keller 1997, "Instant
// radiosity"). A place z that scatters light towards the camera has, by n walks,
//     L(z) = (light straight from luminaires) + 1/n sum_y f_z G(y, z) V f_y alpha_y,     G = |cos_y| |cos_z| / d^2
// (without the cosines in media), the sum being over all their vertices y that scatter smoothly. All paths of a step share the
// lights.
//
// G has no bound, and lights near z make bright spots. So they bring the part
//     w(y, z) = min(1, b / G(y, z))
// alone. The rest, 1 - w, is found by letting the camera's walk go on from z (Kollig & Keller 2004, "Illumination in the
// presence of weak singularities"): to what it comes to, y, is added what light straight from luminaires, other virtual lights,
// and walks that go on from there bring, times 1 - w(y, z). Nothing is lost then, whatever b is, and G (1 - w) / p is bounded,
// too; without, corners are too dark. Behind a place z the walk has 1 - w = 0 mostly, and ends.
//
// No virtual light stands on a mirror, and none is seen in one from z: there walks go on with all they carry.

#include "etendue/render/photon_process.h"
#include "etendue/transport/camera_walk.h"
#include "etendue/transport/connection.h"
#include "etendue/transport/renderer_members.h"
#include "etendue/transport/roulette.h"

namespace etendue {

struct VirtualLight {
  SubpathVertex at;
  int vertices = 0;                        ///< of its walk up to it, the luminaire's and its own included
  const SceneObject* luminaire = nullptr;  ///< that its walk began at
};

/// Those of a step, with what they point to.
struct VirtualLights {
  std::vector<VirtualLight> lights;
  std::vector<std::unique_ptr<Arena>> memory;
  double walks = 0;  ///< n
};

/// What gathering light from them is told by a description.
struct VirtualLightSettings {
  int max_depth = 64, roulette_depth = 5;
  Heuristic heuristic = Heuristic::power;
  bool compensate = true;
  float bound = 0;  ///< b [1/m^2]
};

class VirtualLightProcess : public PhotonProcess {
 public:
  /// `nearest`: from where on a light that is faced squarely counts fully, in widths of a pixel where it is first seen (the
  /// median over the picture).
  VirtualLightProcess(const Renderer& r, const RenderContext& c, VirtualLightSettings s, float nearest)
      : PhotonProcess(r, c), settings_(s) {
    settings_.bound = 1 / square(nearest * seen_pixel_width(c));
  }

 protected:
  /// Makes those of a step, after `share`.
  VirtualLights make_lights(Schedule&, const Step&, std::uint64_t walks) const;

  const VirtualLightSettings& settings() const { return settings_; }

  /// w, of places with these normals, which are 0 in media.
  float part(const Point3& y, const Normal3& normal_y, const Point3& z, const Normal3& normal_z) const {
    const Vector3 d = y - z;
    const float squared = length_squared(d), distance = std::sqrt(squared);
    if (!(squared > 0)) return 0;
    float over = settings_.bound * squared;  // b / G
    if (normal_y != Normal3{}) over *= distance / std::abs(dot(normal_y, d));
    if (normal_z != Normal3{}) over *= distance / std::abs(dot(normal_z, d));
    return over < 1 ? over : 1;
  }

  /// What a light brings to the last vertex of a walk: w f_z G V f_y alpha_y.
  template <class Walk>
  Spectrum light_from(const VirtualLight& y, const Walk& walk, NumberStream& numbers) const {
    SubpathVertex z;
    static_cast<Vertex&>(z) = walk.vertex;
    z.throughput = Spectrum(1.0f);
    z.single = walk.sample.wavelengths.single();
    const float w = part(y.at.point.position, y.at.normal(), z.point.position, z.normal());
    if (!(w > 0)) return {};
    const auto c = connect(context.scene, y.at, z, walk.sample.wavelengths, numbers, walk.sample.arena);
    return c ? w * c->light : Spectrum();
  }

  /// Light along a camera ray, one sample of it. `gather(walk)` adds what virtual lights bring to the walk's last vertex.
  template <class Gather>
  Spectrum follow(const Ray& ray, SampleContext& sample, const Gather& gather) const {
    const LightSampler& luminaires = *renderer.light_sampler;
    const Roulette roulette{settings_.roulette_depth};
    CameraWalk<false> walk(context.scene, sample, ray, settings_.max_depth);
    const auto met = [&](const SurfacePoint& luminaire) {
      return walk.emitter_hit_weight(luminaires, settings_.heuristic, luminaire);
    };
    while (walk.next_vertex(met) && !walk.at_end()) {
      const Vertex& v = walk.vertex;
      const NumberStream::Bounce u = walk.next_bounce();
      const Spectrum whole = walk.throughput;
      const bool smooth = v.scatters_smoothly(), gathered = !walk.specular;  // at the vertex before
      // What virtual lights here bring to that is there already. Without compensation that is all there is, but for luminaires
      // that the walk meets, which may lie behind panes.
      if (smooth && gathered && !v.subsurface_exit)
        walk.throughput *= settings_.compensate ? 1 - part(v.point.position, v.normal(), walk.from, walk.from_normal) : 0;
      if (smooth && !walk.throughput.black()) {
        walk.add_direct(luminaires, u, settings_.heuristic);
        gather(walk);
      }
      const auto next = walk.sample_direction(u.lobe_choice, u.direction);
      if (next && (next->specular() || enters_subsurface_of(v, *next))) walk.throughput = whole;
      if (next && !settings_.compensate && gathered && next->lobe != null_scattering) walk.throughput = {};
      if (next && !walk.throughput.black() && walk.go_on(*next) && roulette.survives(walk)) continue;
      walk.end();
    }
    return walk.radiance;
  }

 private:
  static bool enters_subsurface_of(const Vertex& v, const ScatterSample& next) {
    return v.on_surface() && !v.subsurface_exit && enters_subsurface(v.point, next);
  }

  VirtualLightSettings settings_;
};

/// Members of renderers by virtual lights, beside the number of walks.
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

/// What they find. Of light that bodies and media send out, virtual lights know nothing.
inline constexpr PathClasses compensated_virtual_lights_find =
    all_paths & ~(subsurface_light | emitting_media | delta_caustics | delta_caustics_in_mirrors);
inline constexpr PathClasses bounded_virtual_lights_find = compensated_virtual_lights_find & ~area_caustics;

}  // namespace etendue
