// A faulty renderer, which `etendue conform` must find.

#include "etendue/render/renderer.h"
#include "etendue/shader.h"

namespace etendue {
namespace {

class DimRenderer final : public Renderer {
 public:
  static void describe(Description<DimRenderer>& d) {
    d.summary("Paths that lose 3 % of their light with each reflection.")
        .member<&DimRenderer::max_depth>("max_depth", "1", "longest path, in segments", at_least(1));
  }

  Spectrum radiance(const RenderContext& context, const Ray& camera_ray, SampleContext& sample) const override {
    Spectrum light, throughput(1.0f);
    Ray ray = camera_ray;
    for (int length = 1; length <= max_depth; ++length) {
      Hit hit;
      SurfacePoint point;
      if (!context.scene.nearest(ray, hit)) {
        for (const SceneObject* far : context.scene.infinite_luminaires(ray)) {
          far->surface_point(ray, hit, point);
          light += throughput * far->emission->radiance(point, -ray.direction, sample.wavelengths);
        }
        break;
      }
      context.scene.locate(ray, hit, point);
      if (point.object->luminaire())
        light += throughput * point.object->emission->radiance(point, -ray.direction, sample.wavelengths);
      const Scatter* scatter =
          point.object->shader ? point.object->shader->bind(point, sample.wavelengths, sample.arena) : nullptr;
      if (!scatter) break;
      const auto next = scatter->sample(-ray.direction, sample.numbers.next(), sample.numbers.next_pair());
      if (!next) break;
      throughput *= next->weight * 0.97f;
      ray = point.leave(next->direction);
    }
    return light;
  }

  int max_depth = 16;
};
const Register<DimRenderer> dim;

}  // namespace
}  // namespace etendue
