// Whitted's ray tracing: a tree of mirrored and refracted rays, and shadow rays to delta lights.
//
// Light of a delta luminaire (point, spot or directional light) arrives at a point x from one direction w_i, so the radiance
// that x scatters towards `out` is a plain sum, and perfect mirrors and refraction lead to one direction w_k each (Whitted
// 1980, "An improved illumination model for shaded display", eq. 2, with the surfaces' own f in place of his constants):
//     L(x, out) = L_e + sum_i f(out, w_i) E_i V_i |cos w_i| + sum_k a_k L(x_k, -w_k),
// with E_i the irradiance perpendicular to w_i, V_i the transmittance of the shadow ray, and a_k the fraction of light that
// specular lobe k scatters. No integral over directions is estimated: only wavelengths, the film point, the lens point and the
// time are sampled. Where refraction is dispersive, the refracted branch, and no other, continues with the hero wavelength
// alone.

#include "etendue/render/renderer.h"
#include "etendue/transport/ray_tree.h"
#include "etendue/transport/renderer_members.h"
#include "etendue/transport/visibility.h"

namespace etendue {
namespace {

class WhittedRenderer final : public Renderer {
  int max_depth = 8;

 public:
  static void describe(Description<WhittedRenderer>& d) {
    d.summary("Classical ray tracing: shadow rays to delta lights, perfect mirrors and refraction.",
              "Whitted 1980, An improved illumination model for shaded display");
    d.without("light_sampler", "each luminaire is asked at every surface, and none chosen");
    d.group("Paths");
    describe_max_depth<&WhittedRenderer::max_depth>(
        d, "; each more may double the work where surfaces both reflect and refract", range(1, 64));
  }

  PathClasses finds() const override {
    return all_paths &
           ~(area_light | diffuse_light | glossy_light | area_caustics | delta_caustics | delta_caustics_in_mirrors |
             scattering_media | emitting_media | heterogeneous_media | subsurface_light | fluorescence);
  }

  Spectrum radiance(const RenderContext& context, const Ray& ray, SampleContext& sample) const override {
    RayTree tree{context.scene, sample};
    RayBranch camera(context.scene, ray, sample.wavelengths);
    follow(tree, camera);
    return tree.radiance;
  }

 private:
  /// Null scattering continues the branch itself, since it may happen a thousand times in a row; mirrored and refracted rays,
  /// at most `max_depth` deep, are new branches.
  void follow(RayTree& tree, RayBranch& branch) const {
    while (!tree.sample.aborted() && to_next_surface(tree, branch)) {
    }
  }

  /// Adds the light of the next surface that a branch hits. Returns whether the branch continues by null scattering.
  bool to_next_surface(RayTree& tree, RayBranch& branch) const {
    const ArenaScope memory(tree.sample.arena);
    const Scene& scene = tree.scene;
    SampleContext& sample = tree.sample;
    Hit hit;
    SurfacePoint point;
    if (!meet_surface(scene, branch.ray, branch.around(), hit, point)) {
      tree.escape(branch, hit, point, [&](const SceneObject* far) { tree.add_emission(branch, point, far); });
      return false;
    }
    const Vector3 out = -branch.ray.direction;
    sample.sink.surface(point, branch.throughput);
    if (point.object->luminaire()) tree.add_emission(branch, point, point.object);
    const Scatter* scatter = scattering_at(point, out, branch.wavelengths, sample.arena);
    if (!scatter) return false;
    const bool last = branch.depth >= max_depth;
    if (!last && scatter->has(smooth_lobes)) {
      const Spectrum direct = direct_light(tree, branch, point, *scatter);
      sample.sink.next_event(direct, branch.depth + 1, 1);
    }

    bool first = true, goes_on = false;
    for (const Lobe lobe : {specular_reflection, specular_transmission, null_scattering}) {
      // Null scattering does not count as a segment, so the last segment may still pass null-scattering surfaces.
      if (!scatter->has(lobe) || (last && lobe != null_scattering)) continue;
      auto child = tree.continued(branch, point, *scatter, lobe, first);
      if (!child) continue;
      if (lobe == null_scattering) {
        branch = *child;
        goes_on = true;
      } else {
        follow(tree, *child);
      }
    }
    return goes_on;
  }

  /// Adds the direct light of all delta luminaires; returns its sum.
  static Spectrum direct_light(RayTree& tree, const RayBranch& branch, const SurfacePoint& point, const Scatter& scatter) {
    SampleContext& sample = tree.sample;
    const Vector3 out = -branch.ray.direction;
    Spectrum sum;
    LuminaireSample light;
    for (const SceneObject* luminaire : tree.scene.luminaires()) {
      if (!luminaire->delta() ||
          !sample_luminaire(tree.scene, nullptr, *luminaire, point, branch.wavelengths, {0.5f, 0.5f}, light))
        continue;
      const Spectrum f = scatter.evaluate(out, light.direction, {.lobes = smooth_lobes});
      if (f.black()) continue;
      const Spectrum direct = branch.throughput * (f * light.radiance / light.pdf *
                                                   shadow_transmittance(tree.scene, light.shadow, nullptr, branch.wavelengths,
                                                                        sample.numbers, sample.arena));
      tree.add(branch.depth + 1, direct, luminaire, branch.path_after(point, scatter, light.direction));
      sum += direct;
    }
    return sum;
  }
};

const Register<WhittedRenderer> registered;

}  // namespace
}  // namespace etendue
