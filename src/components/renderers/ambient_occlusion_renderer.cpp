// Ambient occlusion: the unoccluded fraction of the hemisphere over each surface point.
//
//     A(x) = 1/pi * integral over the hemisphere of V(x, w) cos(w) dw
// (Zhukov, Iones & Kronin 1998, "An ambient light illumination model", eq. 4; Landis 2002), where V is 1 if a ray of the given
// length hits nothing. Directions are sampled with the pdf cos / pi, so A is the mean of V. With unlimited rays the image's Y
// is that of direct light on white diffuse surfaces under a sky of radiance 1.

#include "display_colors.h"
#include "etendue/core/warp.h"
#include "etendue/render/renderer.h"
#include "etendue/transport/ray_tree.h"
#include "etendue/transport/visibility.h"

namespace etendue {
namespace {

class AmbientOcclusionRenderer final : public Renderer {
  float distance = 0;
  int rays = 4;
  bool shading_normals = true;
  float open = 1, background = 1;

 public:
  static void describe(Description<AmbientOcclusionRenderer>& d) {
    d.summary(
         "The fraction of the hemisphere over each surface, weighted by the cosine, from which nothing blocks light: "
         "a grey from 0 (enclosed) to 1 (open). Surfaces are seen from both sides.",
         "Zhukov, Iones & Kronin 1998, An ambient light illumination model; Landis 2002, Production-ready global "
         "illumination")
        .without("light_sampler", "it looks at no luminaires")
        .group("Rays")
        .member<&AmbientOcclusionRenderer::distance>("distance", "m", "what is farther away blocks nothing; 0: all does",
                                                     at_least(0), soft(0.01, 100), logarithmic)
        .member<&AmbientOcclusionRenderer::rays>("rays", "1", "rays for each sample of a pixel", range(1, 65536), soft(1, 64),
                                                 logarithmic)
        .member<&AmbientOcclusionRenderer::shading_normals>(
            "shading_normals", "",
            "whether the hemisphere is about the normals that surfaces are shaded by, or their true ones")
        .group("Grey")
        .member<&AmbientOcclusionRenderer::open>("open", "1", "where nothing blocks light", at_least(0), soft(0, 1))
        .member<&AmbientOcclusionRenderer::background>("background", "1", "where the camera sees nothing", at_least(0),
                                                       soft(0, 1));
  }

  PathClasses finds() const override { return no_paths; }  // it does not render light

  Spectrum radiance(const RenderContext& context, const Ray& camera_ray, SampleContext& sample) const override {
    const Scene& scene = context.scene;
    MediumStack media;
    Ray ray = camera_ray;
    Hit hit;
    SurfacePoint point;
    if (!meet_surface(scene, ray, media_around(scene, ray, media), hit, point)) {
      return grey(background, 1, sample);
    }
    const Vector3 out = -ray.direction;
    sample.sink.surface(point, Spectrum(1.0f));

    // The hemisphere is on the side that is seen. Directions below the geometric surface, which shading normals allow, count as
    // occluded.
    const float side = dot(point.normal, out) < 0 ? -1.0f : 1.0f;
    const Normal3 normal = shading_normals ? point.shading_normal : point.normal;
    const Frame frame(dot(normal, point.normal) * side < 0 ? -normal : normal);
    float seen = 0;
    Ray shadow;
    for (int i = 0; i < rays && !sample.aborted(); ++i) {
      const Vector3 direction = frame.to_world(warp::cosine_hemisphere(sample.numbers.next_pair()));
      if (!(dot(point.normal, direction) * side > 0)) continue;
      point.leave(direction, shadow);
      if (distance > 0) shadow.maximum = distance;
      seen += shadow_transmittance(scene, shadow, nullptr, sample.wavelengths, sample.numbers, sample.arena).average();
    }
    const Spectrum value = grey(open * seen / float(rays), 2, sample);
    sample.sink.next_event(value, 2, 1);
    return value;
  }

 private:
  static Spectrum grey(float value, int length, SampleContext& sample) {
    const Spectrum spectrum = display_colors()({value, value, value});
    sample.wavelengths = display_colors().wavelengths;
    sample.sink.light(length, spectrum);
    return spectrum;
  }
};

const Register<AmbientOcclusionRenderer> registered;

}  // namespace
}  // namespace etendue
