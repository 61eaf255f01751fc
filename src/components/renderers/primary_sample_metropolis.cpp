// Metropolis light transport in primary sample space (Kelemen, Szirmay-Kalos, Antal & Csonka 2002, "A simple and robust
// mutation strategy for the Metropolis light transport algorithm"), around any renderer.
//
// A path is a function of primary samples u in [0, 1): those of its film point, lens point, time and wavelengths, and all that
// the inner renderer draws (RenderProcess::path). F(u) is the contribution of the path to the film. Chains of vectors u sample
// F in proportion to its brightness (render/primary_sample_chains.h); the mean is that of the inner renderer.
//
// Paths of one and two segments (visible emitters and direct light) are better estimated by samples that are well distributed
// over the film: with `direct` the inner renderer estimates them that way, and the chains carry the remaining light.

#include "etendue/render/follows_polarization.h"
#include "etendue/render/primary_sample_chains.h"

namespace etendue {

class PrimarySampleMetropolis final : public Renderer, public FollowsPolarization {
 public:
  Ref<Renderer> inner = ref_cast<Renderer>(Registry::instance().create("BidirectionalPathTracer"));
  bool direct = true;
  int mutations_per_sample = ChainSettings().mutations, chains = ChainSettings().chains;
  float bootstrap = ChainSettings().bootstrap, large_steps = ChainSettings().large_steps, deviation = ChainSettings().deviation;
  bool even_errors = ChainSettings().even_errors;

  static void describe(Description<PrimarySampleMetropolis>& d) {
    d.summary(
         "Metropolis light transport in primary sample space: mutates the numbers that another renderer's paths are made of.",
         "Kelemen et al. 2002; Veach & Guibas 1997")
        .without("light_sampler", "the renderer inside chooses luminaires (inner.light_sampler)")
        .without("map_filter", "the renderer inside has it (inner.map_filter)")
        .member<&PrimarySampleMetropolis::inner>(
            "inner", "",
            "the renderer whose paths are mutated; how many samples there are and their sampler are said out here, and refused "
            "in there")
        .member<&PrimarySampleMetropolis::direct>(
            "direct", "",
            "whether paths of one or two segments are found by the renderer inside, sample by sample, and not by chains");
    describe_chains<&PrimarySampleMetropolis::mutations_per_sample, &PrimarySampleMetropolis::chains,
                    &PrimarySampleMetropolis::bootstrap, &PrimarySampleMetropolis::large_steps,
                    &PrimarySampleMetropolis::deviation, &PrimarySampleMetropolis::even_errors>(d);
  }

  void prepare() override { map_filter = inner ? inner->map_filter : 0; }
  PathClasses finds() const override { return inner ? inner->finds() : no_paths; }
  /// Chains are made of the whole light alone, without its Stokes vector.
  bool follows_polarization() const override { return inner && etendue::follows_polarization(*inner); }
  bool keeps_stokes() const override { return false; }
  Expectation expectation() const override { return inner ? inner->expectation() : Expectation::unbiased; }
  bool splats() const override { return true; }
  Estimator estimator() const override { return Estimator::correlated; }

 private:
  std::unique_ptr<RenderProcess> begin(const RenderContext&) const override;
};

namespace {

/// A copy of the inner renderer whose max_depth, if it has that member, is that of direct light.
Ref<Renderer> for_direct_light(const Renderer& inner) {
  const Ref<Renderer> renderer = ref_cast<Renderer>(copy(inner));
  if (renderer->class_info().find("max_depth")) {
    const Value written = get(*renderer, "max_depth");
    const auto* longest = written.as<Number>();
    if (longest && longest->value > MutatedPaths::direct_length)
      set(*renderer, "max_depth", Value(Number{MutatedPaths::direct_length}));
  }
  prepare_tree(*renderer);
  return renderer;
}

}  // namespace

std::unique_ptr<RenderProcess> PrimarySampleMetropolis::begin(const RenderContext& context) const {
  if (!inner) fail("inner", "needs a renderer whose paths it mutates");
  if (inner->estimator() == Estimator::correlated)
    fail("inner", "has no paths that could be mutated: those of a step share light that the numbers of one do not make");
  if (inner->steps_depend()) fail("inner", "learns in its own steps, of which none are taken here: only its paths are");
  refuse_samples_of(*inner);
  const Ref<Renderer> short_paths = direct ? for_direct_light(*inner) : nullptr;
  return std::make_unique<MutatedPaths>(
      *this, context, ChainSettings{mutations_per_sample, chains, bootstrap, large_steps, deviation, even_errors},
      inner->start(context), direct ? short_paths->start(context) : nullptr, short_paths);
}

static const Register<PrimarySampleMetropolis> registered;

}  // namespace etendue
