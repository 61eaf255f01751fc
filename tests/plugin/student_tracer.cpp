// A path tracer with next event estimation, in one file, out of tree.
#include "etendue/describe/description.h"
#include "etendue/render/renderer.h"
#include "etendue/shader.h"

using namespace etendue;

class StudentTracer final : public Renderer {
  int max_depth = 16;

 public:
  static void describe(Description<StudentTracer>& d) {
    d.summary("Path tracing with next event estimation, as in a first course.", "Kajiya 1986")
        .member<&StudentTracer::max_depth>("max_depth", "1", "longest path, in segments", at_least(1));
  }

  std::vector<Advice> misses(const SceneTraits& scene) const override {
    if (scene.media.empty() && scene.pass_through.empty()) return {};
    return {{"what media and boundaries without refraction do", "PathTracer"}};
  }

  Spectrum radiance(const RenderContext& context, const Ray& camera_ray, SampleContext& sample) const override {
    Spectrum light, throughput(1.0f);
    Ray ray = camera_ray;
    bool sampled = false;  // whether luminaires were already asked for the light that comes along the ray
    for (int length = 1; length <= max_depth && !sample.aborted(); ++length) {
      const ArenaScope memory(sample.arena);  // the next vertex needs nothing of this one
      const auto gather = [&](const Spectrum& value) {
        light += value;
        sample.note_length(length, value);
      };
      Hit hit;
      SurfacePoint point;
      if (!context.scene.nearest(ray, hit)) {
        for (const SceneObject* far : context.scene.infinite_luminaires()) {
          if (sampled) break;
          far->surface_point(ray, hit, point);
          gather(throughput * far->emission->radiance(point, -ray.direction, sample.wavelengths));
        }
        break;
      }
      context.scene.locate(ray, hit, point);
      const Vector3 out = -ray.direction;
      if (point.object->luminaire() && !(sampled && point.object->luminaire_index >= 0))
        gather(throughput * point.object->emission->radiance(point, out, sample.wavelengths));

      // Black surfaces scatter nothing.
      if (!point.object->shader || length == max_depth) break;
      const Scatter* scatter = point.object->shader->bind(point, sample.wavelengths, sample.arena);
      if (!scatter) break;

      const LightChoice choice = light_sampler->choose(point.position, point.normal, sample.random.next());
      const Point2 on_luminaire = sample.random.next_pair();
      if (choice.luminaire) {
        const SurfaceSample lamp = choice.luminaire->sample_visible(point.position, on_luminaire, ray.time);
        if (lamp.density > 0) {
          const Spectrum f = scatter->evaluate(out, lamp.direction);
          const Ray shadow = lamp.infinite ? point.leave(lamp.direction) : point.towards(lamp.point);
          if (!f.black() && !context.scene.any(shadow)) {
            const Spectrum emitted = choice.luminaire->emission->radiance(lamp.point, -lamp.direction, sample.wavelengths);
            const Spectrum direct = throughput * f * emitted / (choice.probability * lamp.density);
            light += direct;
            sample.note_length(length + 1, direct);
          }
        }
      }

      const auto next = scatter->sample(out, sample.random.next(), sample.random.next_pair());
      if (!next) break;
      throughput *= next->weight;
      if (next->dispersive) throughput *= sample.wavelengths.drop_secondary();
      sampled = !next->specular();
      ray = point.leave(next->direction);
    }
    return light;
  }
};

static const Register<StudentTracer> registered;
