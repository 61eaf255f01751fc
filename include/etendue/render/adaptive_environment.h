#pragma once
// AdaptiveEnvironment: a light sampler that samples an environment where it is seen (guiding/environment_guide.h), and the
// process of a path tracer that uses it.
//
// What is seen from where is learned before the first step, from a few thousand camera paths and some hundred shadow rays for
// each region of space. It depends on the scene, the camera and the picture's size alone: not on the seed, so that the samples
// of every seed are independent of it, and not on a crop. Choosing luminaires is left to another light sampler.

#include <functional>

#include "etendue/guiding/environment_guide.h"
#include "etendue/infinite_object.h"
#include "etendue/render/renderer.h"

namespace etendue {

class AdaptiveEnvironment final : public LightSampler {
 public:
  /// `lights` chooses luminaires; it must be built for the scene, and outlive this one.
  AdaptiveEnvironment(const LightSampler& lights, const Scene&);

  /// Whether the scene has an environment of which anything can be learned.
  bool applies() const { return environment_ != nullptr; }
  /// Learns; does nothing if it has learned already. An aborted schedule leaves nothing.
  void learn(Schedule&, const RenderProcess&);

  void build(const Scene&) override {}
  LightChoice choose(const Point3& p, const Normal3& n, float u) const override { return lights_.choose(p, n, u); }
  float probability(const Point3& p, const Normal3& n, const SceneObject& l) const override {
    return lights_.probability(p, n, l);
  }
  LightChoice choose(float u) const override { return lights_.choose(u); }
  float probability(const SceneObject& l) const override { return lights_.probability(l); }

  SurfaceSample sample(const SceneObject&, const Point3& from, const Normal3&, Point2 u, float time) const override;
  float pdf(const SceneObject&, const Point3& from, const Normal3&, const Vector3& direction,
            const SurfacePoint&) const override;

 private:
  const LightSampler& lights_;
  const InfiniteObject* environment_ = nullptr;
  EnvironmentGuide guide_;  ///< without regions: nothing is learned yet
};

/// A process of camera paths whose next event estimation asks such a light sampler. `Radiance` is a function
/// `Spectrum(const LightSampler&, const Ray&, SampleContext&)`.
template <class Radiance>
class AdaptiveEnvironmentProcess final : public RenderProcess {
 public:
  AdaptiveEnvironmentProcess(const Renderer& r, const RenderContext& c, Radiance radiance)
      : RenderProcess(r, c), lights_(*r.light_sampler, c.scene), radiance_(std::move(radiance)) {}

  void prepare_step(Schedule& schedule, const Step&) override { lights_.learn(schedule, *this); }
  Spectrum radiance(const Ray& ray, SampleContext& sample) const override { return radiance_(lights_, ray, sample); }

 private:
  AdaptiveEnvironment lights_;
  const Radiance radiance_;
};

/// Such a process; where the scene has no such environment, the usual one.
template <class Radiance>
std::unique_ptr<RenderProcess> adaptive_process(const Renderer& renderer, const RenderContext& context, Radiance radiance) {
  if (!AdaptiveEnvironment(*renderer.light_sampler, context.scene).applies())
    return std::make_unique<RenderProcess>(renderer, context);
  return std::make_unique<AdaptiveEnvironmentProcess<Radiance>>(renderer, context, std::move(radiance));
}

}  // namespace etendue
