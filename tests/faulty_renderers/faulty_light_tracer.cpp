// A light tracer with a fault, built from the same parts as LightTracer.

#include "etendue/transport/renderer_members.h"
#include "etendue/transport/subpath.h"
#include "etendue/transport/visibility.h"
#include "faults.h"

namespace etendue {
namespace {

class FaultyLightTracer final : public Renderer {
  Fault fault = Fault::none;
  int max_depth = 64, roulette_depth = 5;

 public:
  static void describe(Description<FaultyLightTracer>& d) {
    d.summary("For tests: light tracing with something wrong.");
    describe_fault<&FaultyLightTracer::fault>(d);
    describe_max_depth<&FaultyLightTracer::max_depth>(d);
    describe_roulette_depth<&FaultyLightTracer::roulette_depth>(d);
  }
  bool splats() const override { return true; }
  PathClasses finds() const override {
    return all_paths &
           ~(specular_views | seen_environments | delta_caustics_in_mirrors | emitting_media | subsurface_light | fluorescence);
  }

  Spectrum radiance(const RenderContext& context, const Ray& ray, SampleContext& sample) const override {
    EmittedLight light;
    std::vector<SubpathVertex> walk;
    generate_light_subpath(context.scene, *light_sampler, ray.time, {max_depth - 1, roulette_depth}, sample, walk, light);
    for (size_t i = 0; i < walk.size(); ++i) {
      const SubpathVertex& v = walk[i];
      NumberStream numbers = sample.numbers.fork("lens", std::uint32_t(i));
      const auto lens = context.camera.sample_lens(v.point.position, v.point.time, numbers.next_pair());
      if (!v.connectable() || !lens || !(lens->pdf > 0)) continue;
      if (i == 0 && (light.infinite || v.point.normal == Normal3{})) continue;
      MediumStack scratch;
      Spectrum value = i > 0 ? v.throughput * scattering(v, v.out, lens->direction, Transport::importance).value
                             : v.point.object->emission->radiance(v.point, lens->direction, sample.wavelengths) *
                                   (std::abs(dot(v.point.normal, lens->direction)) / (light.probability * light.pdf_position));
      value *= (lens->importance / lens->pdf) *
               shadow_transmittance(context.scene, lens_ray(v, *lens), media_towards(v, lens->direction, scratch),
                                    sample.wavelengths, numbers, sample.arena, Transport::importance);
      if (fault == Fault::lens_importance) value *= square(lens->distance) / lens->pdf;
      if (fault == Fault::skipped_length && i + 1 == 4) continue;
      sample.sink.splat(lens->film, value, sample.wavelengths, int(i) + 1);
    }
    return {};
  }
};
const Register<FaultyLightTracer> registered;

}  // namespace
}  // namespace etendue
