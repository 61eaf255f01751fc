// Properties of the first surfaces as colours: normals, depth, object identifiers and others.
//
// All but the albedo are no light and must not depend on the wavelengths of a sample: they are shown by DisplayColors, exactly
// and without noise.

#include <algorithm>

#include "display_colors.h"
#include "etendue/describe/color.h"
#include "etendue/render/renderer.h"
#include "etendue/transport/ray_tree.h"

namespace etendue {
namespace {

enum class Feature : std::uint8_t { normal, shading_normal, depth, albedo, uv, object, primitive, position, hit_count, facing };

class FeatureRenderer final : public Renderer {
 public:
  Feature feature = Feature::shading_normal;

  static void describe(Description<FeatureRenderer>& d) {
    d.summary(
         "Shows what the first surfaces are like instead of light, in colours of linear sRGB, the same for every sample of a "
         "place. Where nothing is met it is black.")
        .without("light_sampler", "it looks at no luminaires")
        .member<&FeatureRenderer::feature>(
            "feature", "",
            "normal, shading_normal: 0.5 + 0.5 n as (r, g, b), n pointing to the surface's front. depth: the distance from the "
            "camera [m] as grey. albedo: the colour of what is scattered of white light. uv: the fractional parts of the "
            "surface "
            "coordinates as (u, v, 0). object, primitive: a colour for each. position: 0.5 + 0.5 d as (r, g, b), d the way "
            "from "
            "the scene's centre over the scene's radius. hit_count: how many surfaces the ray meets, at most 1000, as grey. "
            "facing: the cosine between shading normal and view, grey from the front and red from the back",
            choices("normal", "shading_normal", "depth", "albedo", "uv", "object", "primitive", "position", "hit_count",
                    "facing"));
  }

  PathClasses finds() const override { return no_paths; }  // it does not render light

  std::unique_ptr<RenderProcess> begin(const RenderContext& context) const override;
};

/// Has a number for each object of the scene.
class FeatureProcess final : public RenderProcess {
 public:
  FeatureProcess(const FeatureRenderer& r, const RenderContext& c) : RenderProcess(r, c), feature(r.feature) {
    white_ = rgb_space("srgb").illuminant;
    number(c.scene);
    std::sort(objects_.begin(), objects_.end());
  }

  Spectrum radiance(const Ray& camera_ray, SampleContext& sample) const override {
    const Scene& scene = context.scene;
    MediumStack media;
    Ray ray = camera_ray;
    Hit hit;
    SurfacePoint point;
    if (!meet_surface(scene, ray, media_around(scene, ray, media), hit, point)) return {};
    const Vector3 out = -ray.direction;
    sample.sink.surface(point, Spectrum(1.0f));
    Spectrum value;
    if (feature == Feature::albedo) {  // the albedo is shown as scattered white light
      if (const Scatter* const scatter = scattering_at(point, out, sample.wavelengths, sample.arena))
        value = scatter->albedo(out) * white_->evaluate(sample.wavelengths, ColorUse::radiance);
    } else {
      value = display_colors()(
          color(scene, camera_ray, hit, point, distance(context.camera.lens_point(camera_ray), point.position)));
      sample.wavelengths = display_colors().wavelengths;
    }
    sample.sink.light(1, value);
    sample.sink.emitter_hit(value, 1, 1);
    return value;
  }

 private:
  Vector3 color(const Scene& scene, const Ray& ray, const Hit& hit, const SurfacePoint& point, float depth) const {
    const auto grey = [](float v) { return Vector3{v, v, v}; };
    switch (feature) {
      case Feature::normal: return signed_color(Vector3(point.normal));
      case Feature::shading_normal: return signed_color(Vector3(point.shading_normal));
      case Feature::depth: return grey(depth);
      case Feature::uv: return {point.uv.x - std::floor(point.uv.x), point.uv.y - std::floor(point.uv.y), 0};
      case Feature::object: return id_color(object_number(hit));
      case Feature::primitive: return id_color(mix_bits(object_number(hit)) + point.primitive + 1);
      case Feature::position: return signed_color((point.position - scene.centre()) / scene.radius());
      case Feature::hit_count: return grey(float(hit_count(scene, ray)));
      case Feature::facing: {
        const float cosine = -dot(point.shading_normal, ray.direction);
        return cosine >= 0 ? grey(cosine) : Vector3{-cosine, 0, 0};
      }
      case Feature::albedo: break;
    }
    return {};
  }

  static Vector3 signed_color(const Vector3& v) {
    const auto part = [](float x) { return std::max(0.5f + 0.5f * x, 0.0f); };
    return {part(v.x), part(v.y), part(v.z)};
  }

  /// Components between 0.1 and 1, so that no colour is as dark as the background.
  static Vector3 id_color(std::uint64_t id) {
    const std::uint64_t bits = mix_bits(id + 0x9e3779b97f4a7c15ull);
    const auto part = [&](int shift) { return 0.1f + 0.9f / 255 * float((bits >> shift) & 255); };
    return {part(0), part(8), part(16)};
  }

  static int hit_count(const Scene& scene, Ray ray) {
    constexpr int most = 1000;
    Hit hit;
    SurfacePoint point;
    int count = 0;
    while (count < most && scene.nearest(ray, hit)) {
      ++count;
      scene.locate(ray, hit, point);
      ray.maximum -= hit.distance;
      ray.origin = point.exit(ray.direction);
    }
    return count;
  }

  /// Numbers all objects, those of nested scenes too.
  void number(const Scene& scene) {
    for (const Ref<SceneObject>& object : scene.objects) {
      objects_.emplace_back(object.get(), objects_.size() + 1);
      if (const auto* inner = scene_within(*object)) number(*inner);
    }
  }

  /// A number for the hit object in this instance: an instanced scene gives its objects a different number in each instance.
  std::uint64_t object_number(const Hit& hit) const {
    const auto of = [&](const SceneObject* object) {
      const auto place = std::lower_bound(objects_.begin(), objects_.end(), std::pair(object, size_t(0)));
      return place != objects_.end() && place->first == object ? place->second : 0;
    };
    std::uint64_t id = of(hit.object);
    for (int i = 0; i < hit.depth; ++i) id = mix_bits(id) + of(hit.scenes[i]);
    return id;
  }

  const Feature feature;
  Color white_;
  std::vector<std::pair<const SceneObject*, size_t>> objects_;  // sorted by address, with numbers in the file's order
};

std::unique_ptr<RenderProcess> FeatureRenderer::begin(const RenderContext& context) const {
  return std::make_unique<FeatureProcess>(*this, context);
}

const Register<FeatureRenderer> registered;

}  // namespace
}  // namespace etendue
