// A random walk: the shortest program that solves the rendering equation (Kajiya 1986), and the first of three renderers to
// read. RandomWalk samples directions uniformly; SimplePathTracer samples them in proportion to the BSDF, and samples
// luminaires, too; PathTracer weights these two strategies, and traces media.
//
// The radiance that leaves a point x in the direction out is
//     L(x, out) = L_e(x, out) + integral over the sphere of f(out, in) |cos_in| L(x', -in) d(in),
// x' being the point that is seen from x in the direction in. One direction from the pdf p = 1 / (4 pi) [1/sr] gives the
// estimate
//     L(x, out) ~ L_e(x, out) + f(out, in) |cos_in| / p  L(x', -in),
// and the same again for L(x', -in). Unrolled, with the throughput T_1 = 1 at the first point x_1 that the camera sees,
//     L = sum over k of T_k L_e(x_k),     T_{k+1} = T_k f |cos| / p.
// Light by specular surfaces and of delta lights is not found: a uniform direction hits theirs with probability 0.

#include "etendue/core/warp.h"
#include "etendue/render/renderer.h"
#include "etendue/transport/fluorescence.h"
#include "etendue/transport/light_groups.h"
#include "etendue/transport/renderer_members.h"
#include "etendue/transport/scattering.h"

namespace etendue {

class RandomWalk final : public Renderer {
  int max_depth = 5;

 public:
  static void describe(Description<RandomWalk>& d) {
    d.summary(
        "The rendering equation by uniformly sampled directions: for learning, and as a truth that shares little with others.",
        "Kajiya 1986; Pharr, Jakob & Humphreys 2023, section 1.3.6");
    describe_max_depth<&RandomWalk::max_depth>(d);
  }

  PathClasses finds() const override {
    return all_paths &
           ~(specular_views | delta_light | area_caustics | delta_caustics | delta_caustics_in_mirrors | scattering_media |
             emitting_media | heterogeneous_media | subsurface_light | light_through_surfaces | fluorescent_media);
  }

  Spectrum radiance(const RenderContext& context, const Ray& camera_ray, SampleContext& sample) const override {
    const Scene& scene = context.scene;
    const Wavelengths& wavelengths = sample.wavelengths;
    Spectrum L, T(1.0f);
    const auto add_emission = [&](const SurfacePoint& x, const Vector3& out, int length) {
      const Spectrum light = T * x.object->emission->radiance(x, out, wavelengths);
      L += light;
      report_light(sample.sink, length, light, x.object);
    };

    Ray ray = camera_ray;
    for (int length = 1; length <= max_depth && !sample.aborted(); ++length) {
      Hit hit;
      SurfacePoint x;
      const Vector3 out = -ray.direction;
      if (!scene.nearest(ray, hit)) {
        for (const SceneObject* environment : scene.infinite_luminaires(ray)) {
          environment->surface_point(ray, hit, x);
          add_emission(x, out, length);
        }
        break;
      }
      scene.locate(ray, hit, x);
      if (x.object->luminaire()) add_emission(x, out, length);

      const Scatter* scatter = scattering_at(x, out, wavelengths, sample.arena);
      // A fluorescent surface scatters light of the same wavelengths or emits light of others: from here the path follows one.
      if (scene.has_fluorescence()) scatter = choose_reradiation(x, out, scatter, T, sample).scatter;
      if (!scatter) break;
      const Vector3 in = warp::sphere(sample.numbers.next_pair());
      const float p = warp::sphere_pdf;
      const Spectrum f_cos = scatter->evaluate(out, in);
      T *= f_cos / p;
      if (T.black()) break;
      x.leave(in, ray);
      ray.of_camera = false;
    }
    return L;
  }
};

static const Register<RandomWalk> registered;

}  // namespace etendue
