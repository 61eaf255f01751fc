// Light tracing: paths that begin at the luminaires (Arvo 1986; Dutre, Lafortune & Willems 1993).
//
// A pixel is an integral of importance over all light that leaves luminaires. A walk carries it from there,
//     beta = L_e |cos| / (P p_A p_w)  prod f |cos| / p,
// and at each vertex it may go to the lens: with a point of the lens seen under the solid-angle density p_l, the
// estimate beta f |cos| V W_e / p_l falls on the film where the camera images that direction.

#include "etendue/render/renderer.h"
#include "etendue/transport/light_groups.h"
#include "etendue/transport/renderer_members.h"
#include "etendue/transport/subpath.h"
#include "etendue/transport/visibility.h"

namespace etendue {

class LightTracer final : public Renderer {
  int max_depth = 64;
  int roulette_depth = 5;

 public:
  static void describe(Description<LightTracer>& d) {
    d.summary("Paths from the luminaires, connected to the lens at every vertex: best for caustics on what is seen directly.",
              "Arvo 1986, Backward ray tracing; Dutré, Lafortune & Willems 1993; Veach 1997, section 10.1");
    d.without("map_filter", "its paths come from luminaires, and what they meet is not averaged");
    d.group("Paths");
    describe_max_depth<&LightTracer::max_depth>(d, stored_subpath_depth, range(1, longest_stored_subpath));
    describe_roulette_depth<&LightTracer::roulette_depth>(d);
  }

  bool splats() const override { return true; }
  PathClasses finds() const override {
    return all_paths & ~(specular_views | seen_environments | delta_caustics_in_mirrors | emitting_media | subsurface_light);
  }

  Spectrum radiance(const RenderContext& context, const Ray& camera_ray, SampleContext& sample) const override {
    if (sample.observe.features) note_first_surface(context.scene, camera_ray, sample);
    EmittedLight light;
    static thread_local std::vector<SubpathVertex> path;
    generate_light_subpath(context.scene, *light_sampler, camera_ray.time, {max_depth - 1, roulette_depth}, sample, path,
                           light);
    for (size_t i = 0; i < path.size() && !sample.aborted(); ++i)
      if (path[i].connectable()) connect(context, path, i, light, sample);
    if (sample.observe.record) record_subpath(sample.observe.record->light_vertices, path);
    return {};
  }

 private:
  void connect(const RenderContext& context, std::vector<SubpathVertex>& path, size_t i, const EmittedLight& light,
               SampleContext& sample) const {
    SubpathVertex& v = path[i];
    const bool luminaire = i == 0;
    if (unseen(v)) return;
    if (luminaire && (light.infinite || v.point.normal == Normal3{})) return;  // of these the film holds no image
    NumberStream numbers = sample.numbers.fork("lens", std::uint32_t(i));
    const auto lens = context.camera.sample_lens(v.point.position, v.point.time, numbers.next_pair());
    if (!lens || !(lens->pdf > 0)) return;

    Spectrum value;
    if (luminaire) {
      if (!context.scene.in_front(v.point, lens->direction)) return;
      const SceneObject& object = *v.point.object;
      value = object.emission->radiance(v.point, lens->direction, sample.wavelengths) *
              (std::abs(dot(v.point.normal, lens->direction)) / (light.choice * light.position));
    } else {
      value = v.throughput * scattering(v, v.out, lens->direction, Transport::importance).value;
    }
    value *= lens->importance / lens->pdf * context.camera.lens_weight(*lens, sample.wavelengths);
    if (value.black()) return;

    const Ray ray = lens_ray(v, *lens);
    MediumStack scratch;
    const MediumStack* media = media_towards(v, lens->direction, scratch);
    if (luminaire && media) {  // those of the walk are on the side where it began
      media_at(context.scene, ray.origin, ray.time, scratch);
      media = &scratch;
    }
    value *= shadow_transmittance(context.scene, ray, media, sample.wavelengths, numbers, sample.arena, Transport::importance);
    if (value.black()) return;
    const int length = int(i) + 1;
    splat_light(sample, lens->film, value, sample.wavelengths, length, path[0].point.object);
    if (sample.observe.record)
      sample.observe.record->contribute({"light path to the lens", length, 1, value, lens->film, true});
  }
};

static const Register<LightTracer> registered;

}  // namespace etendue
