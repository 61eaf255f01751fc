#pragma once
// Common parts of Metropolis light transport, in path space and in primary sample space: the contribution of a path, the paths
// with which chains start, and the weights of their states.
//
// F(x) is the contribution of a path x to the film, and I(x), its brightness, the luminance of F. With b the integral of I, a
// Markov chain whose states have the pdf I / b adds b F / I for each state (Veach & Guibas 1997, "Metropolis light transport").
// A chain has that pdf in the limit only, unless its first state has it. So M independent paths are sampled, and a chain starts
// with one of them, chosen in proportion to I. With W, the mean of their I, in place of b, the contribution of each state then
// has the right expectation, from the first state on (Veach 1997, section 11.3.1): chains may be short, and no burn-in is
// discarded.

#include <cstdint>
#include <span>
#include <vector>

#include "etendue/transport/sample_context.h"

namespace etendue {

/// v: the weight of brightness in each cell of the film. With v in proportion to 1 / (the mean brightness of the cell), a chain
/// visits dark cells as often as bright ones, and the relative errors are about equal (Veach 1997, section 11.5, "two-stage"
/// Metropolis; Hoberock & Hart 2010, "Arbitrary importance functions for Metropolis light transport").
class FilmWeights {
 public:
  static constexpr int side = 16;  ///< cells along each side of the film
  static constexpr size_t cells = size_t(side) * side;
  /// The cell of a film point, for a film that covers an area of pixels.
  static std::uint16_t cell(Point2 film, const PixelArea& area) {
    const auto along = [](float x, int size) { return int(clamp(x / float(size), 0, one_minus_epsilon) * side); };
    return std::uint16_t(along(film.y - float(area.y0), area.height()) * side + along(film.x - float(area.x0), area.width()));
  }
  /// The index of a cell along the Z-order curve, on which neighbours stay close (Morton 1966).
  static std::uint32_t order(std::uint16_t cell);

  /// 1 everywhere.
  FilmWeights() : weights_(cells, 1.0f) {}
  /// From estimates of the light in all cells, each averaged with its neighbours.
  explicit FilmWeights(std::span<const double> light);
  float operator[](size_t cell) const { return weights_[cell]; }

 private:
  std::vector<float> weights_;
};

/// F(x): the splats of a path, each with its luminance.
struct Contribution {
  std::vector<Splat> parts, bad;
  struct Brightness {
    float luminance = 0;
    std::uint16_t cell = 0;  ///< of FilmWeights
  };
  std::vector<Brightness> luminances;

  void clear() {
    parts.clear();
    bad.clear();
    luminances.clear();
  }
  /// `area`: see FilmWeights::cell. A splat that is not finite is stored in `bad`, not in `parts`.
  void add(const Splat&, const PixelArea& area);
  /// I(x), weighted with v.
  static double brightness(std::span<const Brightness> parts, const FilmWeights& weights) {
    double sum = 0;
    for (const Brightness& part : parts) sum += double(part.luminance) * double(weights[part.cell]);
    return sum;
  }
  double brightness(const FilmWeights& weights) const { return brightness(luminances, weights); }
  /// Adds F, times a factor, to the film.
  void add_to(ImageTile&, double factor) const;
  /// Adds the splats that are not finite, so that the film counts them: once for each path.
  void report_bad(ImageTile&) const;
};

/// The independent paths with which chains start.
class ChainStarts {
 public:
  /// A path: its number, by which it can be made again, its I, and its order along the film (FilmWeights::order).
  struct Path {
    std::uint64_t number = 0;
    double brightness = 0;
    std::uint32_t order = 0;
  };
  explicit ChainStarts(std::vector<Path>);

  /// W, the mean of I.
  double mean() const { return mean_; }
  /// The number of the path with which chain number `chain` of `chains` starts. Each path starts a number of chains in
  /// proportion to its brightness, up to rounding, which `u` in [0, 1) decides, the same number for all chains. Chains of
  /// neighbouring numbers start close to each other on the film, so that the chains spread over all of it (systematic
  /// resampling: Kitagawa 1996).
  std::uint64_t begin(std::uint64_t chain, std::uint64_t chains, double u) const;

 private:
  std::vector<Path> paths_;
  std::vector<double> sums_;  ///< prefix sums of the brightness
  double mean_ = 0;
};

/// The weights of a chain's states, of which a part p is proposed by large steps, independently of the state. Such proposals
/// are also samples of the whole integral, and better ones where there is little light. Of N states of a chain, p N are
/// proposed this way: the chain samples F with the density N I / b and the large steps with p N; the balance heuristic (Veach &
/// Guibas 1995) gives
///     ([drawn anew] b + a W) F / (p b + I)
/// as the contribution to the mean of N. a is the part of the state that the chain takes: 1 - acceptance for the state before a
/// proposal, acceptance for the proposal (the expected values of Veach & Guibas; Kelemen et al. 2002 have the same with W = b).
/// `b` need only be close to the integral, but must not depend on the weighted samples: it comes from other paths than W.
struct StateWeights {
  double W = 0, b = 0, p = 0;
  double scale = 1;  ///< factor of all weights

  double factor(bool drawn_anew, double part, double brightness) const {
    return scale * ((drawn_anew ? b : 0) + part * W) / (p * b + brightness);
  }
};

/// Throws Error at the component unless the wavelengths are a function of one random number alone. Samplers that stratify them
/// over the samples of a pixel (GridWavelengths) cannot be mutated.
void require_mutable(const WavelengthSampler&, const Component&);

/// Uniform random numbers for the choices of the algorithm itself, such as acceptance.
class ChoiceNumbers {
 public:
  explicit ChoiceNumbers(std::uint64_t seed) : seed_(seed) {}
  double next() { return double(mix_bits(seed_ + ++drawn_ * 0x9e3779b97f4a7c15ull) >> 11) * 0x1p-53; }

 private:
  std::uint64_t seed_, drawn_ = 0;
};

}  // namespace etendue
