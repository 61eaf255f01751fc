#pragma once
// AdaptiveLights: a light sampler that has learned what is hidden from where, and the process of a path tracer that uses it.
//
//   - An environment is sampled in the directions in which it is seen (guiding/environment_guide.h).
//   - Among a few luminaires, the one to ask is chosen by what it was seen to give in the same region of space: with the
//     probability P_tree of another light sampler, which knows places and powers, mixed with that of the region,
//         P = d P_tree + (1 - d) P_region,
//     where P_region is proportional to the root of the mean square of one sample's contribution (to a diffuse surface), which
//     makes the variance of the sum least. For the environment this is the mean over its tiles of the roots of their squares:
//     that of samples with the learned probabilities.
//
//   - In a region from which no ray has met any light, a part of the samples is not taken at all (Russian roulette on next
//     event estimation): with the probability 1 - a no point is sampled, and the pdf of a point is a times what it is else.
//     So the weights of multiple importance sampling know of it, too, and emitter hits count for more.
//
// It learns before the first step, from a few thousand camera paths and some thousand shadow rays for each region. What it
// learns depends on the scene, the camera and the picture's size alone: not on the seed, so that the samples of every seed are
// independent of it, and not on a crop. All probabilities are positive wherever those of the other light sampler are, so
// estimates are unbiased, whatever was learned.

#include <functional>

#include "etendue/guiding/environment_guide.h"
#include "etendue/infinite_object.h"
#include "etendue/render/renderer.h"

namespace etendue {

class AdaptiveLights final : public LightSampler {
 public:
  /// `lights` chooses luminaires; it must be built for the scene, and outlive this one.
  AdaptiveLights(const LightSampler& lights, const Scene&);

  /// Whether anything can be learned of the scene's luminaires.
  bool applies() const { return environment_ || few_; }
  /// Learns; does nothing if it has learned already, or nothing can be learned. An aborted schedule leaves nothing.
  void learn(Schedule&, const RenderProcess&);

  void build(const Scene&) override {}
  LightChoice choose(const Point3&, const Normal3&, float u) const override;
  float probability(const Point3&, const Normal3&, const SceneObject&) const override;
  LightChoice choose(float u) const override { return lights_.choose(u); }
  float probability(const SceneObject& l) const override { return lights_.probability(l); }

  SurfaceSample sample(const SceneObject&, const Point3& from, const Normal3&, Point2 u, float time) const override;
  float pdf(const SceneObject&, const Point3& from, const Normal3&, const Vector3& direction,
            const SurfacePoint&) const override;

 private:
  static constexpr size_t most_luminaires = 64;  ///< with more, those of a region are too many to learn
  static constexpr float asked_in_the_dark = 0.25f;

  /// The learned CDF of the luminaires at a place; null: nothing is learned there.
  const float* chances(const Point3&, const Normal3&) const;

  /// The probability a with which a luminaire is sampled in a region.
  float asked(std::uint32_t region) const { return dark_.empty() || !dark_[region] ? 1 : asked_in_the_dark; }

  /// P of a luminaire, from P_tree and the CDF of the region.
  float mixed(float others, const float* chances, const SceneObject&) const;

  /// The pdf [1/sr] of a direction to the environment: the sum of its parts times R_t of their tiles.
  float guided_pdf(std::uint32_t region, const Vector3& direction, float time) const;

  const LightSampler& lights_;
  const std::span<const SceneObject* const> luminaires_;
  const bool few_, chooses_;                     ///< whether there are few luminaires, and more than one to choose among
  const InfiniteObject* environment_ = nullptr;  ///< null: none that is known well enough
  bool one_place_ = false;                       ///< whether each of its directions has one place in the unit square
  EnvironmentGuide guide_;                       ///< without regions: nothing is learned yet
  std::vector<bool> dark_;                       ///< the regions without light; empty: none, or too few to be worth it
  std::vector<float> chances_;                   ///< for each region the CDF of its luminaires; all 0: none was seen
};

/// A process of camera paths whose next event estimation asks such a light sampler. `Radiance` is a function
/// `Spectrum(const LightSampler&, const Ray&, SampleContext&)`.
template <class Radiance>
class AdaptiveLightsProcess final : public RenderProcess {
 public:
  AdaptiveLightsProcess(const Renderer& r, const RenderContext& c, Radiance radiance)
      : RenderProcess(r, c), lights_(*r.light_sampler, c.scene), radiance_(std::move(radiance)) {}

  void prepare_step(Schedule& schedule, const Step&) override { lights_.learn(schedule, *this); }
  Spectrum radiance(const Ray& ray, SampleContext& sample) const override { return radiance_(lights_, ray, sample); }

 private:
  AdaptiveLights lights_;
  const Radiance radiance_;
};

/// Such a process; where the scene has no such environment, the usual one.
template <class Radiance>
std::unique_ptr<RenderProcess> adaptive_process(const Renderer& renderer, const RenderContext& context, Radiance radiance) {
  if (!AdaptiveLights(*renderer.light_sampler, context.scene).applies())
    return std::make_unique<RenderProcess>(renderer, context);
  return std::make_unique<AdaptiveLightsProcess<Radiance>>(renderer, context, std::move(radiance));
}

}  // namespace etendue
