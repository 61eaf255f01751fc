#pragma once
// Renderer (an integrator): an algorithm, as it is described. It starts a process that does the work.

#include <memory>

#include "etendue/describe/component.h"
#include "etendue/describe/description.h"
#include "etendue/film/film.h"
#include "etendue/light_sampler.h"
#include "etendue/render/process.h"
#include "etendue/sampler.h"
#include "etendue/transport/path_classes.h"

namespace etendue {

/// Light that a renderer cannot find in a scene, and what can.
struct Advice {
  PathClass kind;
  std::string lost;                  ///< "light of 'lamp' that 'ball' throws onto 'floor' (caustics)"
  std::vector<std::string> instead;  ///< classes of renderers that find it; empty: nothing known does
};

/// What the mean of many renders is.
enum class Expectation : std::uint8_t {
  unbiased,    ///< the truth, whatever the number of samples
  consistent,  ///< the truth in the limit of many samples
  biased,      ///< something near it
};

class Renderer : public Component {
 public:
  using Interface = Renderer;
  using Parent = Component;
  static void describe(Description<Renderer>&);

  int samples = 64;  ///< per pixel
  Ref<Sampler> sampler;
  Ref<LightSampler> light_sampler;
  float map_filter = 0;  ///< maps are averaged over so many pixels; a bias

  /// A process of this renderer. It must be prepared, and stay as it is as long as the process runs.
  std::unique_ptr<RenderProcess> start(const RenderContext&) const;

  /// Radiance [W m^-2 sr^-1 nm^-1] that arrives along a camera ray, one sample of it. All there is to say for an algorithm that
  /// follows each ray by itself.
  virtual Spectrum radiance(const RenderContext&, const Ray&, SampleContext&) const;

  /// How many samples of each pixel a step takes; `usual` is what fits the picture's size. A function of that and the members
  /// alone.
  virtual std::uint32_t samples_per_step(std::uint32_t usual) const { return usual; }
  /// Whether a step needs those before it: then no part of a render can be made by itself (RenderSettings::steps and
  /// Render::add refuse it), and a replay renders all steps before.
  virtual bool steps_depend() const { return false; }
  virtual Expectation expectation() const { return Expectation::unbiased; }
  /// Whether its samples bring light to other places of the film than their own (SampleContext::splat).
  virtual bool splats() const { return false; }
  /// How its samples depend on one another, which says what the film may tell of their error.
  virtual Estimator estimator() const { return Estimator::independent; }
  /// What makes expectations differ from the truth, in words for the user: what `expectation` says, and `map_filter`. Empty:
  /// nothing does.
  std::string bias() const;
  /// The kinds of light it finds, as its members are.
  virtual PathClasses finds() const { return all_paths; }
  /// What it cannot find of any scene, in words for the user; empty: nothing is left out.
  std::string limits() const;
  /// What it cannot find of the light that a given scene has; empty: nothing is missed. Renderers for which this is empty
  /// must agree.
  std::vector<Advice> misses(const SceneTraits&) const;

 protected:
  Renderer();
  /// Of a renderer inside, whose samples this one takes: fails where the description says of them in there what only counts
  /// out here, and would have no effect.
  void refuse_samples_of(const Renderer& inner) const;
  /// What `start` makes, when sampler and light sampler are ready. By default a process that asks `radiance`.
  virtual std::unique_ptr<RenderProcess> begin(const RenderContext&) const;
};

}  // namespace etendue
