#pragma once
// Renderer (an integrator): the description of an algorithm. It starts a RenderProcess that does the work.

#include <memory>

#include "etendue/describe/component.h"
#include "etendue/describe/description.h"
#include "etendue/film/film.h"
#include "etendue/light_sampler.h"
#include "etendue/render/process.h"
#include "etendue/sampler.h"
#include "etendue/transport/path_classes.h"

namespace etendue {

/// A kind of light that a renderer cannot find in a scene, and the renderers that can.
struct Advice {
  PathClass kind;
  std::string lost;                  ///< "light of 'lamp' that 'ball' throws onto 'floor' (caustics)"
  std::vector<std::string> instead;  ///< classes of renderers that find it; empty: no known renderer does
};

/// How the expected value of a render is related to the correct picture.
enum class Expectation : std::uint8_t {
  unbiased,    ///< correct for any number of samples
  consistent,  ///< correct in the limit of many samples
  biased,      ///< an approximation
};

class Renderer : public Component {
 public:
  using Interface = Renderer;
  using Parent = Component;
  static void describe(Description<Renderer>&);

  int samples = 64;  ///< per pixel
  Ref<Sampler> sampler;
  Ref<LightSampler> light_sampler;
  float map_filter = 0;  ///< maps are averaged over this many pixels; a bias

  /// A process of this renderer, which must be prepared and stay unchanged as long as the process runs.
  std::unique_ptr<RenderProcess> start(const RenderContext&) const;

  /// A one-sample estimate of the radiance [W m^-2 sr^-1 nm^-1] along a camera ray. An algorithm that treats each ray
  /// independently overrides only this.
  virtual Spectrum radiance(const RenderContext&, const Ray&, SampleContext&) const;

  /// Samples of each pixel per step; `usual` is the number that fits the picture's size. Depends on `usual` and the members
  /// alone.
  virtual std::uint32_t samples_per_step(std::uint32_t usual) const { return usual; }
  /// Whether a step needs the steps before it. Then a part of a render cannot be made separately (RenderSettings::steps and
  /// Render::add throw Error), and a replay renders all earlier steps.
  virtual bool steps_depend() const { return false; }
  virtual Expectation expectation() const { return Expectation::unbiased; }
  /// Whether its samples contribute to other film points than their own (splat_light in transport/light_groups.h).
  virtual bool splats() const { return false; }
  /// How its samples depend on one another, which determines how the film can estimate their error.
  virtual Estimator estimator() const { return Estimator::independent; }
  /// A text for the user with the sources of bias: what `expectation` returns, and `map_filter`. Empty: there is no bias.
  std::string bias() const;
  /// The kinds of light it finds, with its present members.
  virtual PathClasses finds() const { return all_paths & ~fluorescence; }
  /// The kinds of light that it finds in no scene, as a text for the user; empty: it finds all.
  std::string limits() const;
  /// The kinds of light that it misses in a given scene; empty: none. Renderers for which this is empty must converge to the
  /// same picture.
  std::vector<Advice> misses(const SceneTraits&) const;

 protected:
  Renderer();
  /// Throws Error if the description of a renderer within this one sets members about samples, which have no effect there
  /// because this renderer takes the samples.
  void refuse_samples_of(const Renderer& inner) const;
  /// Implements `start`, after the sampler and the light sampler are built. By default a process that calls `radiance`.
  virtual std::unique_ptr<RenderProcess> begin(const RenderContext&) const;
};

}  // namespace etendue
