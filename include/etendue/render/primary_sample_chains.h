#pragma once
// Chains of mutated numbers: what a step of a Metropolis renderer does whose paths are functions of numbers u in [0, 1).
//
// A chain goes on by large steps, all numbers drawn anew, or small ones, each moved a little
// (transport/primary_sample_vectors.h). Both are symmetric, so a proposal v is accepted with the probability
//     a = min(1, I(v) / I(u)),
// and u and v are both added to the film, weighted with 1 - a and a, and with what large steps are worth by themselves
// (StateWeights in transport/metropolis.h). Each step of the render has chains of its own, that begin with paths of a pool
// (ChainStarts): so its mean is the integral of F, whatever the number of mutations, and it depends on nothing before it.

#include "etendue/describe/description.h"
#include "etendue/render/renderer.h"
#include "etendue/transport/metropolis.h"

namespace etendue {

struct ChainSettings {
  int mutations = 1, chains = 256;
  float bootstrap = 0.1f, large_steps = 0.3f, deviation = 0.01f;
  bool even_errors = true;
};

/// Those, as members of a renderer.
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

/// Chains of whatever states. Called from many threads at once.
class Chains {
 public:
  virtual ~Chains() = default;
  /// The independent path of a seed.
  virtual void draw(std::uint64_t seed, Arena&, const std::atomic<bool>* abort, Contribution&) const = 0;
  /// One chain, that begins with the path of seed `first` and adds to the film what so many states are worth. `own_seed`: of
  /// all it chooses further.
  virtual void run(std::uint64_t first, std::uint64_t own_seed, std::uint64_t states, const StateWeights&, const FilmWeights&,
                   ImageTile&, Arena&, const std::atomic<bool>* abort) const = 0;
};

/// Brings to the film, as splats that count as `paths` paths, what chains find with so many mutations for each. The film counts
/// the paths if wanted; if not, something else must.
void run_chains(Schedule&, const ImageBuffer&, const ChainSettings&, const Chains&, std::uint64_t seed, std::uint64_t paths,
                bool count_paths);

/// F(u). Called from many threads at once.
class PathFunction {
 public:
  virtual void evaluate(const NumberSource&, Arena&, const std::atomic<bool>* abort, Contribution&) const = 0;

 protected:
  ~PathFunction() = default;
};

/// The same with chains of numbers.
void mutate_primary_samples(Schedule&, const ImageBuffer&, const ChainSettings&, const PathFunction&, std::uint64_t seed,
                            std::uint64_t paths, bool count_paths);

/// A process whose chains mutate the paths of another process.
///
/// What paths of one and two segments bring (luminaires seen, and light straight from them) is better found by samples that are
/// well spread over the film. A third process may find that, sample by sample; the chains carry the rest then.
class MutatedPaths final : public RenderProcess, PathFunction {
 public:
  static constexpr int direct_length = 2;  ///< the most segments of what counts as direct

  /// `direct`: light of such paths as it tells it by length; null: the chains carry all. `held` is kept as long as the process.
  MutatedPaths(const Renderer&, const RenderContext&, const ChainSettings&, std::unique_ptr<RenderProcess> paths,
               std::unique_ptr<RenderProcess> direct, Ref<Renderer> held = nullptr);

  void prepare_step(Schedule&, const Step&) override;
  void step(Schedule&, const Step&) override;
  Spectrum radiance(const Ray&, SampleContext&) const override;  ///< the direct light
  CameraSample sample(int x, int y, std::uint32_t number, Arena&, const PathRequest&) const override;

 private:
  const ChainSettings settings_;
  const PixelArea area_;
  const size_t lengths_;  ///< that are told apart, the last for all longer ones
  const Ref<Renderer> held_;
  const std::unique_ptr<RenderProcess> paths_, direct_;

  bool is_direct(int length) const { return direct_ && length >= 1 && length <= direct_length; }
  void evaluate(const NumberSource&, Arena&, const std::atomic<bool>* abort, Contribution&) const override;
};

}  // namespace etendue
