// Distribution ray tracing: rays spread over luminaires, lobes, the lens and time.
//
// Cook, Porter & Carpenter 1984, "Distributed ray tracing", distribute one tree of rays over all dimensions to be blurred. The
// lens, the time and the wavelengths are sampled with the camera ray. At a surface the tree splits: n_l rays go to points on
// luminaires, n_d and n_g along directions of the diffuse and the glossy lobes, n_s along each perfect mirror or refraction, so
// that each kind of blur gets as many rays as it needs.
//
// Let p_d and p_g [1/sr] be the pdfs of w if the diffuse or the glossy lobes alone are sampled. The n_d + n_g lobe rays are
// together one stratified sample of the density
//     N(w) = n_d p_d(w) + n_g p_g(w),
// so the radiance along each of them is multiplied by f |cos| / N, with f of both kinds of lobes: the balance heuristic between
// the lobes (Veach 1997, section 9.2.2). The luminaire rays find direct light as well, with n_l p_l(w). Lobe rays and luminaire
// rays are combined by the power heuristic (ibid., section 9.2.3),
//     w_lobes = N^2 / (N^2 + (n_l p_l)^2),    w_luminaires = 1 - w_lobes,
// so an emitter hit of a lobe ray counts w_lobes f |cos| L_e / N, and a luminaire ray w_luminaires f |cos| L_e / (n_l p_l).
// Emitter hits of rays from the camera and from specular lobes count in full. A kind of lobe without rays is not in N, and its
// direct light comes from luminaire rays alone; its indirect light, and nothing else, is left out.
//
// Beyond `split_depth` segments the tree does not split: one ray continues along any lobe, and one goes to a luminaire, as in a
// path tracer with Russian roulette. If all kinds of lobes are followed, the expectation is that of the path tracer.

#include "etendue/render/renderer.h"
#include "etendue/transport/direct_light.h"
#include "etendue/transport/ray_tree.h"
#include "etendue/transport/renderer_members.h"
#include "etendue/transport/visibility.h"

namespace etendue {
namespace {

class DistributionRenderer final : public Renderer {
  int light_samples = 4, diffuse_samples = 4, glossy_samples = 4, specular_samples = 1;
  int split_depth = 1, max_depth = 16, roulette_depth = 5;

 public:
  static void describe(Description<DistributionRenderer>& d) {
    d.summary(
         "Distribution ray tracing: soft shadows, gloss, depth of field and motion by rays that split at the first surfaces. "
         "Diffuse, glossy and specular lobes get their own rays; nothing is counted twice.",
         "Cook, Porter & Carpenter 1984, Distributed ray tracing; weights: Veach 1997, section 9.2")
        .group("Tree")
        .member<&DistributionRenderer::light_samples>("light_samples", "1", "rays to luminaires where the tree splits",
                                                      range(1, 65536))
        .member<&DistributionRenderer::diffuse_samples>(
            "diffuse_samples", "1",
            "rays along diffuse lobes where the tree splits; 0: light between matt surfaces is left out", range(0, 65536))
        .member<&DistributionRenderer::glossy_samples>(
            "glossy_samples", "1", "rays along glossy lobes where the tree splits; 0: their reflections are left out",
            range(0, 65536))
        .member<&DistributionRenderer::specular_samples>(
            "specular_samples", "1",
            "rays along each perfect mirror and refraction where the tree splits; with 1 both are followed", range(1, 65536))
        .member<&DistributionRenderer::split_depth>(
            "split_depth", "1", "segments up to which the tree splits, at each surface; beyond, one ray goes on", range(0, 16));
    d.group("Paths");
    describe_max_depth<&DistributionRenderer::max_depth>(d);
    describe_roulette_depth<&DistributionRenderer::roulette_depth>(d);
  }

  PathClasses finds() const override {
    PathClasses lost = delta_caustics | delta_caustics_in_mirrors | scattering_media | emitting_media | heterogeneous_media |
                       subsurface_light | fluorescence;
    if (diffuse_samples == 0) lost |= diffuse_light | area_caustics;
    if (glossy_samples == 0) lost |= glossy_light | area_caustics;
    return all_paths & ~lost;
  }

  Spectrum radiance(const RenderContext& context, const Ray& ray, SampleContext& sample) const override {
    RayTree tree{context.scene, sample};
    Branch camera(context.scene, ray, sample.wavelengths);
    follow(tree, camera);
    return tree.radiance;
  }

 private:
  struct Branch : RayBranch {
    using RayBranch::RayBranch;
    float share = 1;        ///< of the tree: the product of 1 / (rays) over its splits, a factor of the throughput
    float eta_squared = 1;  ///< the product of eta^2 over refractions, which divides the throughput
    // How the ray's direction was sampled: at which point, with which density N [1/sr] (0: not from a smooth lobe), next to how
    // many luminaire rays.
    Point3 from = {};
    Normal3 from_normal = {};
    float pdf = 0, luminaire_rays = 0;
  };

  /// A surface point at which branches continue.
  struct Place {
    const SurfacePoint& point;
    const Scatter& scatter;
    Vector3 out;
    bool splits;
  };

  Lobes followed() const {
    return all_lobes & ~(diffuse_samples > 0 ? 0 : diffuse_lobes) & ~(glossy_samples > 0 ? 0 : glossy_lobes);
  }

  /// Adds an emitter hit of a branch.
  void add_emission(RayTree& tree, const Branch& branch, const SurfacePoint& point) const {
    const Vector3& direction = branch.ray.direction;
    Spectrum light = branch.throughput * point.object->emission->radiance(point, -direction, branch.wavelengths);
    if (light.black()) return;
    float weight = 1;
    if (branch.pdf > 0) {
      const float pdf = next_event_direction_pdf(*light_sampler, branch.from, branch.from_normal, direction, point);
      weight = heuristic_weight(Heuristic::power, branch.pdf, branch.luminaire_rays * pdf);
    }
    light *= weight;
    tree.add(branch.depth, light, point.object, branch.path);
    tree.sample.sink.emitter_hit(light, branch.depth, weight);
  }

  void follow(RayTree& tree, Branch& branch) const {
    const Scene& scene = tree.scene;
    SampleContext& sample = tree.sample;
    Hit hit;
    SurfacePoint point;
    for (;;) {
      const ArenaScope memory(sample.arena);
      if (sample.aborted()) return;
      if (!meet_surface(scene, branch.ray, branch.around(), hit, point)) {
        tree.escape(branch, hit, point, [&](const SceneObject*) { add_emission(tree, branch, point); });
        return;
      }
      const Vector3 out = -branch.ray.direction;
      sample.sink.surface(point, branch.throughput);
      if (point.object->luminaire()) add_emission(tree, branch, point);
      const Scatter* scatter = scattering_at(point, out, branch.wavelengths, sample.arena);
      if (!scatter) return;

      const Place place{point, *scatter, out, branch.depth <= split_depth};
      const bool last = branch.depth >= max_depth;
      if (!last && scatter->has(smooth_lobes)) {
        const Spectrum direct = direct_light(tree, branch, place);
        sample.sink.next_event(direct, branch.depth + 1, 1);
      }
      // Null scattering does not count as a segment, so the last segment may still pass null-scattering surfaces.
      const Lobes lobes = last ? Lobes(null_scattering) : followed();
      if (place.splits) {
        if (!split(tree, branch, place, lobes)) return;
        continue;
      }
      const float choice = sample.numbers.next();
      const auto next = scatter->sample(out, choice, sample.numbers.next_pair(), {.lobes = lobes});
      if (!next || enters_subsurface(place.point, *next)) return;
      branch.throughput *= next->weight;
      step(sample, branch, place, *next, next->pdf, 1);
      // The factor of radiance by refraction is taken back when the path leaves the medium, so it does not enter the survival
      // probability, and neither does the factor of splitting.
      if (branch.depth > roulette_depth) {
        const float survival = std::min(0.95f, branch.throughput.maximum() * branch.eta_squared / branch.share);
        if (sample.numbers.next() >= survival) return;
        branch.throughput /= survival;
      }
      if (branch.throughput.black() || !branch.may_go_on(next->lobe)) return;
    }
  }

  /// Follows each kind of lobe with its number of branches. Null scattering continues the branch itself, since it may happen a
  /// thousand times in a row; returns whether it does.
  bool split(RayTree& tree, Branch& branch, const Place& place, Lobes lobes) const {
    struct Kind {
      Lobes lobes, rivals;
      int count, rival_count;
    };
    const Kind kinds[] = {{diffuse_lobes, glossy_lobes, diffuse_samples, glossy_samples},
                          {glossy_lobes, diffuse_lobes, glossy_samples, diffuse_samples},
                          {specular_reflection, no_lobes, specular_samples, 0},
                          {specular_transmission, no_lobes, specular_samples, 0},
                          {null_scattering, no_lobes, 1, 0}};
    SampleContext& sample = tree.sample;
    bool first = true, goes_on = false;
    for (const Kind& kind : kinds) {
      if (!place.scatter.has(kind.lobes & lobes)) continue;
      const int rivals = place.scatter.has(kind.rivals) ? kind.rival_count : 0;
      for (int i = 0; i < kind.count && !sample.aborted(); ++i) {
        const float choice = (float(i) + sample.numbers.next()) / float(kind.count);
        const auto next = place.scatter.sample(place.out, std::min(choice, one_minus_epsilon), sample.numbers.next_pair(),
                                               {.lobes = kind.lobes});
        if (!next || enters_subsurface(place.point, *next)) continue;
        Branch child = branch;
        float pdf = float(kind.count) * next->pdf;  // N of a smooth lobe
        if (rivals == 0) {
          child.throughput *= next->weight / float(kind.count);
        } else {
          const ScatterValue other = place.scatter.value_and_pdf(place.out, next->direction, {.lobes = kind.rivals});
          const Spectrum value = next->weight * next->pdf + other.value;
          pdf += float(rivals) * other.pdf;
          child.throughput *= value / pdf;
        }
        step(sample, child, place, *next, pdf, kind.count + rivals);
        if (child.throughput.black() || !child.may_go_on(next->lobe)) continue;
        if (!first) sample.sink.surface(place.point, branch.throughput);  // path records of a branch begin at this surface
        first = false;
        sample.sink.scattered(*next);
        if (kind.lobes == null_scattering) {
          branch = child;
          goes_on = true;
        } else {
          follow(tree, child);
        }
      }
    }
    return goes_on;
  }

  /// Continues a branch in a sampled direction; its throughput already contains the sample's weight.
  void step(SampleContext& sample, Branch& branch, const Place& place, const ScatterSample& next, float pdf, int rays) const {
    branch.path = branch.path_after(place.point, place.scatter, next.direction, next.lobe, followed());
    if (next.dispersive) branch.throughput *= branch.wavelengths.drop_secondary();
    branch.eta_squared *= next.eta * next.eta;
    go_on(place.point, next, branch.ray, branch.around());
    if (!place.splits) sample.sink.scattered(next);
    if (next.lobe == null_scattering) return;  // a null-scattering surface is not a vertex of the path
    ++branch.depth;
    branch.share /= float(rays);
    branch.pdf = next.specular() ? 0 : pdf;
    branch.luminaire_rays = place.splits ? float(light_samples) : 1;
    branch.from = place.point.position;
    branch.from_normal = place.point.normal;
  }

  /// f |cos| of the lobes that are followed (as `value`), and N (as `pdf`).
  ScatterValue lobe_rays(const Place& place, const Vector3& in) const {
    if (!place.splits) return place.scatter.value_and_pdf(place.out, in, {.lobes = followed()});
    ScatterValue sum;
    for (const auto& [lobes, count] : {std::pair(diffuse_lobes, diffuse_samples), std::pair(glossy_lobes, glossy_samples)}) {
      if (count == 0 || !place.scatter.has(lobes)) continue;
      const ScatterValue kind = place.scatter.value_and_pdf(place.out, in, {.lobes = lobes});
      sum.value += kind.value;
      sum.pdf += float(count) * kind.pdf;
    }
    return sum;
  }

  /// Adds next event estimation: direct light scattered towards `out`; returns its sum.
  Spectrum direct_light(RayTree& tree, const Branch& branch, const Place& place) const {
    const int count = place.splits ? light_samples : 1;
    const Lobes alone = smooth_lobes & ~followed();
    SampleContext& sample = tree.sample;
    Spectrum sum;
    LuminaireSample light;
    for (int i = 0; i < count && !sample.aborted(); ++i) {
      // Stratified choices: together, all rays choose luminaires with the same probabilities as one choice.
      const float choice = std::min((float(i) + sample.numbers.next()) / float(count), one_minus_epsilon);
      const Point2 u = sample.numbers.next_pair();
      const LightChoice chosen = light_sampler->choose(place.point.position, place.point.normal, choice);
      if (!chosen.luminaire ||
          !sample_luminaire(tree.scene, light_sampler.get(), *chosen.luminaire, place.point, branch.wavelengths, u, light))
        continue;
      const float pdf = float(count) * chosen.probability * light.pdf;
      const ScatterValue rivals = lobe_rays(place, light.direction);
      Spectrum f = rivals.value * weight_over_pdf(Heuristic::power, pdf, light.delta ? 0 : rivals.pdf);
      if (place.scatter.has(alone)) f += place.scatter.evaluate(place.out, light.direction, {.lobes = alone}) / pdf;
      if (f.black()) continue;
      const Spectrum direct = branch.throughput * (f * light.radiance *
                                                   shadow_transmittance(tree.scene, light.shadow, nullptr, branch.wavelengths,
                                                                        sample.numbers, sample.arena));
      tree.add(branch.depth + 1, direct, chosen.luminaire, branch.path_after(place.point, place.scatter, light.direction));
      sum += direct;
    }
    return sum;
  }
};

const Register<DistributionRenderer> registered;

}  // namespace
}  // namespace etendue
