#pragma once
// Markov chains of primary samples: a step of a Metropolis renderer whose paths are functions of random numbers u in [0, 1).
//
// A chain proposes large steps, where all numbers are drawn anew, or small steps, where each is perturbed a little
// (transport/primary_sample_vectors.h). Both are symmetric, so a proposal v is accepted with the probability
//     a = min(1, I(v) / I(u)).
// Both u and v are added to the film, weighted with 1 - a and a; large steps are also weighted as independent samples
// (StateWeights in transport/metropolis.h). Each step of the render has chains of its own, which start with paths of a
// bootstrap pool (ChainStarts). So the expected value of a step is the integral of F for any number of mutations, and a step
// does not depend on earlier steps.

#include "etendue/describe/description.h"
#include "etendue/render/renderer.h"
#include "etendue/transport/light_groups.h"
#include "etendue/transport/metropolis.h"

namespace etendue {

struct ChainSettings {
  int mutations = 1, chains = 256;
  float bootstrap = 0.1f, large_steps = 0.3f, deviation = 0.01f;
  bool even_errors = true;
};

/// Describes these settings as members of a renderer.
template <auto mutations, auto chains, auto bootstrap, auto large_steps, auto even_errors, class R>
void describe_chain_starts(Description<R>& d) {
  d.group("Chains")
      .template member<mutations>("mutations_per_sample", "1", "mutations for each sample of a pixel", range(1, 32),
                                  soft(1, 32), logarithmic)
      .template member<even_errors>("even_errors", "",
                                    "whether chains come to dark parts of the picture as often as to bright ones, so that "
                                    "errors are alike relative to the "
                                    "light there; otherwise they come as often as there is light")
      .template member<large_steps>("large_steps", "1", "part of the mutations that are wholly new", range(0.01, 1))
      .template member<chains>("chains", "1", "Markov chains in each step of the render", range(2, 1 << 20), soft(16, 4096),
                               logarithmic)
      .template member<bootstrap>(
          "bootstrap", "1",
          "independent paths, for each mutation, by which brightness is measured and among which chains "
          "choose their first",
          range(1e-3, 2), soft(0.01, 1), logarithmic);
}
template <auto mutations, auto chains, auto bootstrap, auto large_steps, auto deviation, auto even_errors, class R>
void describe_chains(Description<R>& d) {
  describe_chain_starts<mutations, chains, bootstrap, large_steps, even_errors>(d);
  d.template member<deviation>("deviation", "1", "standard deviation by which small mutations move each number", range(1e-6, 1),
                               soft(1e-3, 0.1), logarithmic);
}

/// The interface of Markov chains, whatever their states are. Called from many threads at once.
class Chains {
 public:
  virtual ~Chains() = default;
  /// Evaluates the independent path that a seed determines.
  virtual void draw(std::uint64_t seed, Arena&, const std::atomic<bool>* abort, Contribution&) const = 0;
  /// Runs one chain. It starts with the path of seed `first` and adds so many weighted states to the film. `own_seed`
  /// determines all further random choices.
  virtual void run(std::uint64_t first, std::uint64_t own_seed, std::uint64_t states, const StateWeights&, const FilmWeights&,
                   ImageTile&, Arena&, const std::atomic<bool>* abort) const = 0;
};

/// Renders `paths` paths, with so many mutations for each, as splats. If `count_paths`, the film counts these paths; otherwise
/// another process must count them.
void run_chains(Schedule&, const ImageBuffer&, const ChainSettings&, const Chains&, std::uint64_t seed, std::uint64_t paths,
                bool count_paths);

/// The path contribution F(u) as a function of primary samples. Called from many threads at once.
class PathFunction {
 public:
  virtual void evaluate(const NumberSource&, Arena&, const std::atomic<bool>* abort, Contribution&) const = 0;

 protected:
  ~PathFunction() = default;
};

/// run_chains with chains of primary samples.
void mutate_primary_samples(Schedule&, const ImageBuffer&, const ChainSettings&, const PathFunction&, std::uint64_t seed,
                            std::uint64_t paths, bool count_paths);

/// A process whose chains mutate the paths of another process.
///
/// Paths of one and two segments (visible emitters, and direct light) are estimated better by samples that are well distributed
/// over the film. A third process may render these, sample by sample; the chains then carry the remaining light.
class MutatedPaths final : public RenderProcess, PathFunction {
 public:
  static constexpr int direct_length = 2;  ///< the longest path, in segments, that counts as direct

  /// `direct`: renders the paths up to `direct_length`, if it reports their lengths; null: the chains carry all light. `held`
  /// is kept alive as long as the process.
  MutatedPaths(const Renderer&, const RenderContext&, const ChainSettings&, std::unique_ptr<RenderProcess> paths,
               std::unique_ptr<RenderProcess> direct, Ref<Renderer> held = nullptr);

  void prepare_step(Schedule&, const Step&) override;
  void step(Schedule&, const Step&) override;
  Spectrum radiance(const Ray&, SampleContext&) const override;  ///< the direct light, from `direct_`
  CameraSample sample(int x, int y, std::uint32_t number, Arena&, const PathSink&) const override;

 private:
  const ChainSettings settings_;
  const PixelArea area_;
  const size_t lengths_;  ///< path lengths that are distinguished, the last for all longer ones
  const LightGroups groups_;
  const Ref<Renderer> held_;
  const std::unique_ptr<RenderProcess> paths_, direct_;

  /// Adds the light of a sample's own pixel by group and by light path expression.
  void add_labelled(const LightParts&, const CameraSample&, float share, Contribution&) const;
  int length_of(const Splat& splat) const { return SplatLabel::unpacked(splat.length, size_t(groups_.count())).length; }
  bool is_direct(int length) const { return direct_ && length >= 1 && length <= direct_length; }
  void evaluate(const NumberSource&, Arena&, const std::atomic<bool>* abort, Contribution&) const override;
};

}  // namespace etendue
