// Light tracing: paths that begin at the luminaires (Arvo 1986; Dutre, Lafortune & Willems 1993).
//
// A pixel is an integral of importance over all light that leaves luminaires. A walk carries it from there,
//     beta = L_e |cos| / (P p_A p_w)  prod f |cos| / p,
// and at each vertex it may go to the lens: with a point of the lens seen under the solid-angle density p_l, the
// estimate beta f |cos| V W_e / p_l falls on the film where the camera images that direction.

#include "transport/media.h"
#include "transport/ray_steps.h"
#include "transport/record_walk.h"
#include "transport/seeded_bug.h"
#include "transport/subpaths.h"
#include "transport/visibility.h"

namespace etendue {

class LightTracer final : public Renderer {
  int max_depth = 64;
  int roulette_depth = 5;

 public:
  static void describe(Description<LightTracer>& d) {
    d.summary("Paths from the luminaires, connected to the lens at every vertex: best for caustics on what is seen directly.",
              "Arvo 1986, Backward ray tracing; Dutré, Lafortune & Willems 1993; Veach 1997, section 10.1")
        .member<&LightTracer::max_depth>("max_depth", "1",
                                         "longest path, in segments: 1 shows luminaires only, 2 adds direct light. A walk is "
                                         "kept as a whole, which takes up to 1 kB for each segment and thread, hence the limit",
                                         range(1, longest_kept_walk))
        .member<&LightTracer::roulette_depth>("roulette_depth", "1", "segments before Russian roulette may end a path",
                                              at_least(1));
  }

  std::string limits() const override {
    return "what the camera sees in mirrors or through glass, environments behind the scene, light that media emit";
  }
  std::vector<Advice> misses(const SceneTraits& traits) const override {
    std::vector<Advice> advice;
    if (!traits.specular.empty())
      advice.push_back(
          {"what the camera sees in or through " + some_of(traits.specular), "PathTracer, BidirectionalPathTracer"});
    if (!traits.environments.empty())
      advice.push_back(
          {some_of(traits.environments) + " where the camera sees it directly", "PathTracer, BidirectionalPathTracer"});
    if (!traits.emissive_media.empty())
      advice.push_back({"light of the media in " + some_of(traits.emissive_media), "PathTracer, BidirectionalPathTracer"});
    miss_subsurface(traits, advice);
    return advice;
  }

  Spectrum radiance(const RenderContext& context, const Ray& camera_ray, SampleContext& sample) const override {
    const Scene& scene = context.scene;
    if (sample.features) note_first_surface(scene, camera_ray, sample);
    EmittedLight light;
    static thread_local std::vector<Vertex> path;
    walk_from_luminaire(scene, *light_sampler, camera_ray.time, {max_depth, roulette_depth, &sample}, sample.wavelengths,
                        sample.random, sample.arena, path, light);

    // Each vertex keeps its dimensions whatever the walk used.
    for (size_t i = 0; i < path.size() && !sample.aborted(); ++i) {
      sample.random.jump(lens_dimension + 2 * std::uint32_t(i));
      if (path[i].connectable()) connect(context, path, i, light, sample);
    }
    if (sample.record) record_walk(sample.record->light_vertices, path);
    return {};
  }

 private:
  static constexpr std::uint32_t lens_dimension = 1u << 20;

  void connect(const RenderContext& context, const std::vector<Vertex>& path, size_t i, const EmittedLight& light,
               SampleContext& sample) const {
    const Vertex& v = path[i];
    const bool luminaire = i == 0;
    if (luminaire && (light.infinite || v.point.normal == Normal3{})) return;  // of these the film holds no image
    const Point2 u = sample.random.next_pair();
    const auto lens = context.camera.sample_lens(v.point.position, v.point.time, u);
    if (!lens || !(lens->density > 0)) return;

    Spectrum value;
    if (luminaire) {
      const SceneObject& object = *v.point.object;
      value = object.emission->radiance(v.point, lens->direction, sample.wavelengths) *
              (std::abs(dot(v.point.normal, lens->direction)) / (light.choice * light.position));
    } else {
      value = v.throughput * scattering(v, v.out, lens->direction, Transport::importance).value;
    }
    value *= lens->importance / lens->density;
    if (seeded(SeededBug::lens_importance)) value *= square(lens->distance) / lens->density;
    if (value.black()) return;

    const Ray ray = lens_ray(v, *lens);
    MediumStack scratch;
    const MediumStack* media = media_towards(v, lens->direction, scratch);
    if (luminaire && media) {  // those of the walk are on the side where it began
      media_at(context.scene, ray.origin, ray.time, scratch);
      media = &scratch;
    }
    value *= visible_fraction(context.scene, ray, media, sample.wavelengths, sample.arena, Transport::importance);
    if (value.black()) return;
    const int length = int(i) + 1;
    sample.splat(lens->film, value, sample.wavelengths, length);
    if (sample.record) sample.record->contribute({"light path to the lens", length, 1, value, lens->film, true});
  }
};

static const Register<LightTracer> registered;

}  // namespace etendue
