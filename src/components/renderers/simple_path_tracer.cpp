// A simple path tracer: the second of three renderers to read (random_walk.cpp, path_tracer.cpp). Two things are new.
//
// Directions are sampled by the BSDF, with a pdf p that is nearly proportional to f |cos|, so that f |cos| / p varies little:
//     T_{k+1} = T_k f |cos| / p.
//
// Next event estimation: the light that comes to x_k straight from luminaires is found by sampling a point on one. A luminaire
// is chosen with the probability P, and a point on it with the solid-angle pdf p_l [1/sr] as seen from x_k, so that
//     direct(x_k) ~ f(out, in) |cos_in| L_e V / (P p_l),     V = 1 if nothing lies between, else 0.
// The path hits the same emitters itself, and their light must not be added twice. L_e(x_k) is therefore added at the first
// point alone, and after specular scattering at x_{k-1}, where next event estimation finds nothing:
//     L = sum over k of T_k ( [k = 1 or specular] L_e(x_k) + direct(x_k) ).
// path_tracer.cpp takes both wherever both are possible, and weights them (multiple importance sampling).

#include "etendue/render/renderer.h"
#include "etendue/transport/fluorescence.h"
#include "etendue/transport/light_groups.h"
#include "etendue/transport/ray_tree.h"
#include "etendue/transport/renderer_members.h"
#include "etendue/transport/scattering.h"

namespace etendue {

class SimplePathTracer final : public Renderer {
  int max_depth = 5;

 public:
  static void describe(Description<SimplePathTracer>& d) {
    d.summary("Path tracing with next event estimation and nothing else: for learning, and as a truth for what is built on it.",
              "Kajiya 1986; Pharr, Jakob & Humphreys 2023, section 13.2");
    describe_max_depth<&SimplePathTracer::max_depth>(d);
  }

  PathClasses finds() const override {
    return all_paths & ~(delta_caustics | delta_caustics_in_mirrors | scattering_media | emitting_media | heterogeneous_media |
                         subsurface_light | light_through_surfaces | fluorescent_media);
  }

  Spectrum radiance(const RenderContext& context, const Ray& camera_ray, SampleContext& sample) const override {
    const Scene& scene = context.scene;
    Spectrum L, T(1.0f);
    const auto add = [&](const Spectrum& light, int length, const SceneObject* luminaire) {
      L += light;
      report_light(sample.sink, length, light, luminaire);
    };

    Ray ray = camera_ray;
    MediumStack inside;  // the glass that contains the ray; null: no ray of this scene can be in any
    MediumStack* const media = media_around(scene, ray, inside);
    bool specular = true;  // of the last scattering; the camera counts as a specular one
    for (int length = 1; length <= max_depth && !sample.aborted(); ++length) {
      Hit hit;
      SurfacePoint x;
      const Vector3 out = -ray.direction;
      if (!meet_surface(scene, ray, media, hit, x)) {
        for (const SceneObject* environment : scene.infinite_luminaires(ray)) {
          environment->surface_point(ray, hit, x);
          if (specular) add(T * environment->emission->radiance(x, out, sample.wavelengths), length, environment);
        }
        break;
      }
      if (x.object->luminaire() && specular)
        add(T * x.object->emission->radiance(x, out, sample.wavelengths), length, x.object);

      const Scatter* scatter = scattering_at(x, out, sample.wavelengths, sample.arena);
      // A fluorescent surface scatters light of the same wavelengths or emits light of others: from here the path follows one.
      if (scene.has_fluorescence()) scatter = choose_reradiation(x, out, scatter, T, sample).scatter;
      if (!scatter || length == max_depth) break;

      const SceneObject* luminaire = nullptr;
      const Spectrum direct = direct_light(scene, x, out, *scatter, sample, luminaire);
      add(T * direct, length + 1, luminaire);

      const float lobe = sample.numbers.next();
      const std::optional<ScatterSample> next = scatter->sample(out, lobe, sample.numbers.next_pair());
      if (!next || enters_subsurface(x, *next)) break;
      T *= next->weight;  // f |cos| / p
      // A dispersive refraction has another direction for each wavelength: the path follows the hero, whose weight is
      // increased.
      if (next->dispersive) T *= sample.wavelengths.drop_secondary();
      specular = next->specular();
      go_on(x, *next, ray, media);
    }
    return L;
  }

 private:
  /// One sample of direct(x) [W m^-2 sr^-1 nm^-1], and the luminaire that it comes from.
  Spectrum direct_light(const Scene& scene, const SurfacePoint& x, const Vector3& out, const Scatter& scatter,
                        SampleContext& sample, const SceneObject*& luminaire) const {
    const LightChoice choice = light_sampler->choose(x.position, x.normal, sample.numbers.next());
    const Point2 u = sample.numbers.next_pair();
    luminaire = choice.luminaire;
    if (!luminaire) return {};
    SurfaceSample on = luminaire->sample_visible(x.position, u, x.time);
    if (!(on.pdf > 0)) return {};
    const Vector3 in = on.direction;
    const Spectrum f_cos = scatter.evaluate(out, in, {.lobes = smooth_lobes});
    const Spectrum emitted = luminaire->emission->radiance(on.point, -in, sample.wavelengths);
    if (f_cos.black() || emitted.black() || !scene.in_front(on.point, -in)) return {};
    const Ray shadow = on.infinite ? x.leave(in) : x.towards(on.point);
    if (scene.any(shadow)) return {};
    return f_cos * emitted / (choice.probability * on.pdf);
  }
};

static const Register<SimplePathTracer> registered;

}  // namespace etendue
