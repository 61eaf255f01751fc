#pragma once
// Chains of mutated numbers: what a step of a Metropolis renderer does whose paths are functions of numbers u in [0, 1).
//
// A chain goes on by large steps, all numbers drawn anew, or small ones, each moved a little (transport/number_vectors.h). Both
// are symmetric, so a proposal v is accepted with the probability
//     a = min(1, I(v) / I(u)),
// and u and v are both added to the film, weighted with 1 - a and a, and with what large steps are worth by themselves
// (StateWeights in transport/metropolis.h). Each step of the render has chains of its own, that begin with paths of a pool
// (ChainStarts): so its mean is the integral of F, whatever the number of mutations, and it depends on nothing before it.

#include "etendue/describe/description.h"
#include "etendue/render/schedule.h"
#include "etendue/transport/metropolis.h"

namespace etendue {

struct ChainSettings {
  int chains = 256;
  float bootstrap = 0.1f, large_steps = 0.3f, deviation = 0.01f;
  bool even_errors = true;
};

/// Those, as members of a renderer.
template <auto chains, auto bootstrap, auto large_steps, auto deviation, auto even_errors, class R>
void describe_chains(Description<R>& d) {
  d.group("Chains")
      .template member<even_errors>(
          "even_errors", "",
          "whether chains come to dark parts of the picture as often as to bright ones, so that errors "
          "are alike relative to the light there; otherwise they come as often as there is light")
      .template member<large_steps>("large_steps", "1", "part of the mutations that are wholly new", range(0.01, 1))
      .template member<deviation>("deviation", "1", "standard deviation by which small mutations move each number",
                                  range(1e-6, 1), soft(1e-3, 0.1), logarithmic)
      .template member<chains>("chains", "1", "Markov chains in each step of the render", range(2, 1 << 20), soft(16, 4096),
                               logarithmic)
      .template member<bootstrap>(
          "bootstrap", "1",
          "independent paths, for each mutation, by which brightness is measured and among which chains "
          "choose their first",
          range(1e-4, 100), soft(0.01, 1), logarithmic);
}

/// F(u). Called from many threads at once.
class PathFunction {
 public:
  virtual void evaluate(const NumberSource&, Arena&, const std::atomic<bool>* abort, Contribution&) const = 0;

 protected:
  ~PathFunction() = default;
};

/// Brings to the film, as splats that count as `mutations` paths, what so many mutations find of the integral of F. The
/// film counts the paths if wanted; if not, something else must.
void mutate_numbers(Schedule&, const ImageBuffer&, const ChainSettings&, const PathFunction&, std::uint64_t seed,
                    std::uint64_t mutations, bool count_paths);

}  // namespace etendue
