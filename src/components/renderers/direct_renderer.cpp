// Emitted and direct light only, with the choice of how luminaires are found.
//
// Light that reaches a surface point straight from luminaires and is scattered towards `out` is
//     L = integral of f(out, w) L_e(w) |cos w| dw.
// n_l directions are drawn by choosing points on luminaires, with density p_l(w) (the probability of the luminaire included),
// n_s by the shader, with density p_s(w). The multi-sample estimator (Veach & Guibas 1995; Veach 1997, eq. 9.4) is
//     sum over both strategies k, and their samples i, of   w_k(w_ki) f L_e |cos| / (n_k p_k),
// with w_k = (n_k p_k)^b / sum_j (n_j p_j)^b, b = 1 for the balance and 2 for the power heuristic. Either strategy alone has
// w = 1. Only the shader finds light by way of specular lobes, and only luminaire samples that of luminaires
// without extent: these count in full.

#include "etendue/render/renderer.h"
#include "etendue/transport/direct_light.h"
#include "etendue/transport/ray_tree.h"
#include "etendue/transport/renderer_members.h"
#include "etendue/transport/visibility.h"

namespace etendue {
namespace {

enum class Strategy : std::uint8_t { light, shader, both };

class DirectRenderer final : public Renderer {
  Strategy strategy = Strategy::both;
  int light_samples = 1, shader_samples = 1;
  Heuristic heuristic = Heuristic::power;

 public:
  static void describe(Description<DirectRenderer>& d) {
    d.summary("Emitted and direct light only: paths of one and two segments.",
              "Veach & Guibas 1995, Optimally combining sampling techniques for Monte Carlo rendering")
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
  }

  PathClasses finds() const override {
    PathClasses lost = diffuse_light | glossy_light | specular_views | area_caustics | delta_caustics |
                       delta_caustics_in_mirrors | scattering_media | emitting_media | uneven_media | subsurface_light;
    if (strategy == Strategy::shader) lost |= delta_light;
    return all_paths & ~lost;
  }

  Spectrum radiance(const RenderContext& context, const Ray& camera_ray, SampleContext& sample) const override {
    const Scene& scene = context.scene;
    MediumStack inside;
    MediumStack* const media = media_around(scene, camera_ray, inside);
    Spectrum radiance, throughput(1.0f);
    Ray ray = camera_ray;
    Hit hit;
    SurfacePoint point;
    const auto add = [&](int length, const Spectrum& light, const SceneObject* luminaire) {
      radiance += light;
      tell_light(sample.observe, length, light, luminaire);
    };
    for (int crossings = 0; crossings <= most_crossings; ++crossings) {  // goes round where light passes straight on
      const ArenaScope memory(sample.arena);
      if (!meet_surface(scene, ray, media, hit, point)) {
        for (const SceneObject* far : scene.infinite_luminaires(ray)) {
          far->surface_point(ray, hit, point);
          const Spectrum light = throughput * far->emission->radiance(point, -ray.direction, sample.wavelengths);
          add(1, light, far);
          sample.observe.escape(*far, ray, throughput);
          sample.observe.met(light, 1, 1);
        }
        return radiance;
      }
      const Vector3 out = -ray.direction;
      sample.observe.surface(point, throughput);
      if (point.object->luminaire()) {
        const Spectrum light = throughput * point.object->emission->radiance(point, out, sample.wavelengths);
        add(1, light, point.object);
        sample.observe.met(light, 1, 1);
      }
      const Scatter* scatter = scattering_at(point, out, sample.wavelengths, sample.arena);
      sample.observe.first_surface(scene, point, hit, scatter, out, sample.wavelengths);
      if (!scatter) return radiance;

      Spectrum direct;
      const auto add_direct = [&](const Spectrum& scattered, const SceneObject* luminaire) {
        const Spectrum light = throughput * scattered;
        direct += light;
        add(2, light, luminaire);
      };
      if (strategy != Strategy::shader && scatter->has(smooth_lobes))
        by_luminaires(scene, point, *scatter, out, sample, add_direct);
      if (strategy != Strategy::light && scatter->has(bent_lobes))
        by_shader(scene, point, *scatter, ray, media, sample, add_direct);
      sample.observe.sampled(direct, 2, 1);

      const auto straight = pass_straight(point, *scatter, ray, media);
      if (!straight) return radiance;
      throughput *= *straight;
    }
    return radiance;
  }

 private:
  /// What passes straight on is followed apart, and is no scattering.
  static constexpr Lobes bent_lobes = all_lobes & ~pass_through;

  /// Lets a ray go straight on through a surface. Returns the fraction that does; none when all is scattered or absorbed.
  static std::optional<Spectrum> pass_straight(const SurfacePoint& point, const Scatter& scatter, Ray& ray,
                                               MediumStack* media) {
    if (!scatter.has(pass_through)) return std::nullopt;
    const auto straight = scatter.sample(-ray.direction, 0, {}, Transport::radiance, pass_through);
    if (!straight || straight->weight.black()) return std::nullopt;
    go_on(point, *straight, ray, media);
    return straight->weight;
  }

  /// Calls `add(light, luminaire)` for light that is scattered towards `out`; so does by_shader.
  template <class Add>
  void by_luminaires(const Scene& scene, const SurfacePoint& point, const Scatter& scatter, const Vector3& out,
                     SampleContext& sample, const Add& add) const {
    const float n = float(light_samples);
    LuminaireSample light;
    for (int i = 0; i < light_samples && !sample.aborted(); ++i) {
      // Choices in equal strata over all samples: together they still choose luminaires as one choice does.
      const float choice = std::min((float(i) + sample.numbers.next()) / n, one_minus_epsilon);
      const Point2 u = sample.numbers.next_pair();
      const LightChoice chosen = light_sampler->choose(point.position, point.normal, choice);
      if (!chosen.luminaire || !sample_luminaire(*chosen.luminaire, point, sample.wavelengths, u, light)) continue;
      const ScatterValue f = scatter.value_and_density(out, light.direction, Transport::radiance, bent_lobes);
      if (f.value.black()) continue;
      const bool rivalled = strategy == Strategy::both && !light.delta;
      const float weight = weight_over_density(heuristic, n * chosen.probability * light.density,
                                               rivalled ? float(shader_samples) * f.density : 0);
      add(f.value * light.radiance * weight *
              visible_fraction(scene, light.shadow, nullptr, sample.wavelengths, sample.numbers, sample.arena),
          chosen.luminaire);
    }
  }

  template <class Add>
  void by_shader(const Scene& scene, const SurfacePoint& point, const Scatter& scatter, const Ray& camera_ray,
                 const MediumStack* media, SampleContext& sample, const Add& add) const {
    const Vector3 out = -camera_ray.direction;
    const float n = float(shader_samples);
    Hit hit;
    SurfacePoint met;
    for (int i = 0; i < shader_samples && !sample.aborted(); ++i) {
      const float choice = std::min((float(i) + sample.numbers.next()) / n, one_minus_epsilon);
      const auto next = scatter.sample(out, choice, sample.numbers.next_pair(), Transport::radiance, bent_lobes);
      if (!next || enters_body(point, *next)) continue;
      Wavelengths wavelengths = sample.wavelengths;
      Spectrum throughput = next->weight / n;
      if (next->dispersive) throughput *= wavelengths.drop_secondary();
      Ray ray = camera_ray;
      MediumStack inside;
      if (media) inside = *media;
      MediumStack* const around = media ? &inside : nullptr;
      go_on(point, *next, ray, around);

      const auto weight = [&](const SurfacePoint& on_luminaire) {
        if (strategy == Strategy::shader || next->specular()) return 1.0f;
        const float density = direct_light_density(*light_sampler, point.position, point.normal, next->direction, on_luminaire);
        return heuristic_weight(heuristic, n * next->density, float(light_samples) * density);
      };
      for (int crossings = 0; crossings <= most_crossings; ++crossings) {
        const ArenaScope memory(sample.arena);
        if (!meet_surface(scene, ray, around, hit, met)) {
          for (const SceneObject* far : scene.infinite_luminaires(ray)) {
            far->surface_point(ray, hit, met);
            add(throughput * far->emission->radiance(met, -ray.direction, wavelengths) * weight(met), far);
          }
          break;
        }
        if (met.object->luminaire())
          add(throughput * met.object->emission->radiance(met, -ray.direction, wavelengths) * weight(met), met.object);
        if (!met.object->shader || !(met.object->shader->possible_lobes() & pass_through)) break;
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
