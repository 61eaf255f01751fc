// Emitted and direct light only, with a choice of the strategies that sample luminaires.
//
// Direct light that a surface point scatters towards `out` is
//     L = integral of f(out, w) L_e(w) |cos w| dw.
// n_l directions are sampled by points on luminaires, with the pdf p_l(w) (the probability of the luminaire included), and n_s
// by the shader, with the pdf p_s(w), both [1/sr]. The multi-sample estimator (Veach & Guibas 1995; Veach 1997, eq. 9.4) is
//     sum over both strategies k, and their samples i, of   w_k(w_ki) f L_e |cos| / (n_k p_k),
// with w_k = (n_k p_k)^b / sum_j (n_j p_j)^b, where b = 1 for the balance heuristic and 2 for the power heuristic. If only one
// strategy is used, w = 1. Only the shader samples specular lobes, and only luminaire samples find delta luminaires (point,
// spot and directional lights): these count in full.
//
// If mirrors show surfaces, a perfect mirror or refraction leads to one direction w_k each, along which the radiance is the
// same sum for the surface there: L = L_e + direct + sum_k a_k L(x_k, -w_k), up to a depth. Direct light is then computed for
// the non-specular lobes alone.

#include "etendue/render/renderer.h"
#include "etendue/transport/direct_light.h"
#include "etendue/transport/ray_tree.h"
#include "etendue/transport/renderer_members.h"
#include "etendue/transport/visibility.h"

namespace etendue {
namespace {

enum class Strategy : std::uint8_t { light, shader, both };
enum class Shown : std::uint8_t { luminaires, surfaces };

class DirectRenderer final : public Renderer {
  Strategy strategy = Strategy::both;
  int light_samples = 1, shader_samples = 1;
  Heuristic heuristic = Heuristic::power;
  Shown mirrors = Shown::luminaires;
  int view_depth = 5;

 public:
  static void describe(Description<DirectRenderer>& d) {
    d.summary(
         "Emitted and direct light only: paths of one and two segments, and these behind perfect mirrors and smooth glass.",
         "Veach & Guibas 1995, Optimally combining sampling techniques for Monte Carlo rendering; mirrors: Whitted 1980")
        .group("Light")
        .member<&DirectRenderer::strategy>("strategy", "",
                                           "how light is found: by points on luminaires, by directions of the "
                                           "shader, or by both, combined",
                                           choices("light", "shader", "both"))
        .member<&DirectRenderer::light_samples>("light_samples", "1", "points on luminaires for each sample of a pixel",
                                                range(1, 65536), soft(1, 64), logarithmic, unless("strategy", "shader"))
        .member<&DirectRenderer::shader_samples>("shader_samples", "1", "directions of the shader for each sample of a pixel",
                                                 range(1, 65536), soft(1, 64), logarithmic, unless("strategy", "light"));
    describe_heuristic<&DirectRenderer::heuristic>(d, when("strategy", "both"));
    d.group("Mirrors")
        .member<&DirectRenderer::mirrors>("mirrors", "",
                                          "what perfect mirrors and smooth glass show: `luminaires` alone, which is direct "
                                          "light; `surfaces`: those as well, with the light that comes to them directly",
                                          choices("luminaires", "surfaces"))
        .member<&DirectRenderer::view_depth>(
            "view_depth", "1",
            "what is farther from the camera is not shown, in segments from mirror to mirror: 1 shows what the camera sees "
            "itself, and mirrors are black; each more may double the work where surfaces both reflect and refract",
            range(1, 64), when("mirrors", "surfaces"));
  }

  PathClasses finds() const override {
    PathClasses lost = diffuse_light | glossy_light | area_caustics | delta_caustics | delta_caustics_in_mirrors |
                       scattering_media | emitting_media | heterogeneous_media | subsurface_light | fluorescence;
    if (strategy == Strategy::shader) lost |= delta_light;
    if (mirrors == Shown::luminaires) lost |= specular_views;
    return all_paths & ~lost;
  }

  Spectrum radiance(const RenderContext& context, const Ray& ray, SampleContext& sample) const override {
    RayTree tree{context.scene, sample};
    RayBranch camera(context.scene, ray, sample.wavelengths);
    follow(tree, camera);
    return tree.radiance;
  }

 private:
  /// The lobes that direct light is computed for. Null scattering is no scattering, and is followed separately; so are specular
  /// lobes if mirrors show surfaces.
  Lobes direct_lobes() const { return mirrors == Shown::surfaces ? smooth_lobes : Lobes(all_lobes & ~null_scattering); }

  /// Follows a branch. Null scattering continues the branch itself, in a loop instead of a recursion.
  void follow(RayTree& tree, RayBranch& branch) const {
    while (!tree.sample.aborted() && to_next_surface(tree, branch)) {
    }
  }

  /// Adds the light of the next surface that a branch hits, and what that surface reflects and refracts. Returns whether the
  /// branch continues by null scattering.
  bool to_next_surface(RayTree& tree, RayBranch& branch) const {
    const Scene& scene = tree.scene;
    SampleContext& sample = tree.sample;
    const ArenaScope memory(sample.arena);
    Hit hit;
    SurfacePoint point;
    if (!meet_surface(scene, branch.ray, branch.around(), hit, point)) {
      tree.escape(branch, hit, point, [&](const SceneObject* far) { tree.add_emission(branch, point, far); });
      return false;
    }
    const Vector3 out = -branch.ray.direction;
    sample.sink.surface(point, branch.throughput);
    if (point.object->luminaire()) tree.add_emission(branch, point, point.object);
    const Scatter* scatter = scattering_at(point, out, branch.wavelengths, sample.arena);
    if (!scatter) return false;

    Spectrum direct;
    const auto add_direct = [&](const Spectrum& scattered, const SceneObject* luminaire, const Vector3& in, Lobe lobe) {
      const Spectrum light = branch.throughput * scattered;
      direct += light;
      tree.add(branch.depth + 1, light, luminaire, branch.path_after(point, *scatter, in, lobe));
    };
    if (strategy != Strategy::shader && scatter->has(smooth_lobes)) by_luminaires(tree, branch, point, *scatter, add_direct);
    if (strategy != Strategy::light && scatter->has(direct_lobes())) by_shader(tree, branch, point, *scatter, add_direct);
    sample.sink.next_event(direct, branch.depth + 1, 1);
    if (mirrors == Shown::surfaces && branch.depth < view_depth) follow_mirrors(tree, branch, point, *scatter);

    const auto straight = pass_straight(point, *scatter, branch.ray, branch.around());
    if (!straight) return false;
    branch.throughput *= *straight;
    return branch.may_go_on(null_scattering);
  }

  /// Follows one new branch for each perfect mirror and refraction.
  void follow_mirrors(RayTree& tree, const RayBranch& branch, const SurfacePoint& point, const Scatter& scatter) const {
    bool first = true;
    for (const Lobe lobe : {specular_reflection, specular_transmission}) {
      if (!scatter.has(lobe)) continue;
      if (auto child = tree.continued(branch, point, scatter, lobe, first)) follow(tree, *child);
    }
  }

  /// Continues a ray by null scattering. Returns the fraction of light that passes; nullopt if all is scattered or absorbed.
  static std::optional<Spectrum> pass_straight(const SurfacePoint& point, const Scatter& scatter, Ray& ray,
                                               MediumStack* media) {
    if (!scatter.has(null_scattering)) return std::nullopt;
    const auto straight = scatter.sample(-ray.direction, 0, {}, {.lobes = null_scattering});
    if (!straight || straight->weight.black()) return std::nullopt;
    go_on(point, *straight, ray, media);
    return straight->weight;
  }

  /// Calls `add(light, luminaire, in, lobe)` for the light scattered towards `out`, found by luminaire samples; by_shader by
  /// directions.
  template <class Add>
  void by_luminaires(RayTree& tree, const RayBranch& branch, const SurfacePoint& point, const Scatter& scatter,
                     const Add& add) const {
    SampleContext& sample = tree.sample;
    const Vector3 out = -branch.ray.direction;
    const float n = float(light_samples);
    LuminaireSample light;
    for (int i = 0; i < light_samples && !sample.aborted(); ++i) {
      // Stratified choices: together, all samples choose luminaires with the same probabilities as one choice.
      const float choice = std::min((float(i) + sample.numbers.next()) / n, one_minus_epsilon);
      const Point2 u = sample.numbers.next_pair();
      const LightChoice chosen = light_sampler->choose(point.position, point.normal, choice);
      if (!chosen.luminaire ||
          !sample_luminaire(tree.scene, light_sampler.get(), *chosen.luminaire, point, branch.wavelengths, u, light))
        continue;
      const ScatterValue f = scatter.value_and_pdf(out, light.direction, {.lobes = direct_lobes()});
      if (f.value.black()) continue;
      const bool rivalled = strategy == Strategy::both && !light.delta;
      const float weight =
          weight_over_pdf(heuristic, n * chosen.probability * light.pdf, rivalled ? float(shader_samples) * f.pdf : 0);
      add(f.value * light.radiance * weight *
              shadow_transmittance(tree.scene, light.shadow, nullptr, branch.wavelengths, sample.numbers, sample.arena),
          chosen.luminaire, light.direction, diffuse_reflection);
    }
  }

  template <class Add>
  void by_shader(RayTree& tree, RayBranch& branch, const SurfacePoint& point, const Scatter& scatter, const Add& add) const {
    const Scene& scene = tree.scene;
    SampleContext& sample = tree.sample;
    const MediumStack* const media = branch.around();
    const Vector3 out = -branch.ray.direction;
    const float n = float(shader_samples);
    Hit hit;
    SurfacePoint met;
    for (int i = 0; i < shader_samples && !sample.aborted(); ++i) {
      const float choice = std::min((float(i) + sample.numbers.next()) / n, one_minus_epsilon);
      const auto next = scatter.sample(out, choice, sample.numbers.next_pair(), {.lobes = direct_lobes()});
      if (!next || enters_subsurface(point, *next)) continue;
      Wavelengths wavelengths = branch.wavelengths;
      Spectrum throughput = next->weight / n;
      if (next->dispersive) throughput *= wavelengths.drop_secondary();
      Ray ray = branch.ray;
      MediumStack inside;
      if (media) inside = *media;
      MediumStack* const around = media ? &inside : nullptr;
      go_on(point, *next, ray, around);

      const auto weight = [&](const SurfacePoint& on_luminaire) {
        if (strategy == Strategy::shader || next->specular()) return 1.0f;
        const float pdf = next_event_direction_pdf(*light_sampler, point.position, point.normal, next->direction, on_luminaire);
        return heuristic_weight(heuristic, n * next->pdf, float(light_samples) * pdf);
      };
      for (int crossings = 0; crossings <= most_crossings; ++crossings) {
        const ArenaScope memory(sample.arena);
        if (!meet_surface(scene, ray, around, hit, met)) {
          for (const SceneObject* far : scene.infinite_luminaires(ray)) {
            far->surface_point(ray, hit, met);
            add(throughput * far->emission->radiance(met, -ray.direction, wavelengths) * weight(met), far, next->direction,
                next->lobe);
          }
          break;
        }
        if (met.object->luminaire())
          add(throughput * met.object->emission->radiance(met, -ray.direction, wavelengths) * weight(met), met.object,
              next->direction, next->lobe);
        if (!met.object->shader || !(met.object->shader->possible_lobes() & null_scattering)) break;
        const Scatter* there = scattering_at(met, -ray.direction, wavelengths, sample.arena);
        const auto straight = there ? pass_straight(met, *there, ray, around) : std::nullopt;
        if (!straight) break;
        throughput *= *straight;
      }
    }
  }
};

const Register<DirectRenderer> registered;

}  // namespace
}  // namespace etendue
