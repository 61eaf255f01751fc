#pragma once
// What Metropolis light transport is made of, whatever its paths are: what a path brings, where chains begin, and what their
// states count for.
//
// F(x) is the light that a path x brings to the film, and I(x), its brightness, the luminance of that. With b the integral of
// I, a Markov chain whose states have the density I / b may add b F / I for each of them (Veach & Guibas 1997, "Metropolis
// light transport"). It has that density in the limit only, unless it begins with it. M independent paths are drawn, and the
// chain begins with one of them, chosen in proportion to I; with W, the mean of their I, in the place of b each of its states
// then has the right mean, from the first on (Veach 1997, section 11.3.1): chains may be short, and nothing is thrown away.

#include <cstdint>
#include <span>
#include <vector>

#include "etendue/transport/sample_context.h"

namespace etendue {

/// v: how much brightness counts on each part of the film. With v in proportion to 1 / (the mean brightness there), a chain
/// comes to dark parts as often as to bright ones, and errors are alike relative to what is seen (Veach 1997, section 11.5,
/// "two-stage" Metropolis; Hoberock & Hart 2010, "Arbitrary importance functions for Metropolis light transport").
class FilmWeights {
 public:
  static constexpr int side = 16;  ///< parts along each side of the film
  static constexpr size_t cells = size_t(side) * side;
  /// The part of a film point, of an area that the film is divided in.
  static std::uint16_t cell(Point2 film, const PixelArea& area) {
    const auto along = [](float x, int size) { return int(clamp(x / float(size), 0, one_minus_epsilon) * side); };
    return std::uint16_t(along(film.y - float(area.y0), area.height()) * side + along(film.x - float(area.x0), area.width()));
  }
  /// Where it comes along a curve that keeps neighbours together (Morton 1966).
  static std::uint32_t order(std::uint16_t cell);

  /// 1 everywhere.
  FilmWeights() : weights_(cells, 1.0f) {}
  /// From estimates of the light in all cells: each is taken together with its neighbours.
  explicit FilmWeights(std::span<const double> light);
  float operator[](size_t cell) const { return weights_[cell]; }

 private:
  std::vector<float> weights_;
};

/// F(x): each part with its place on the film, and its luminance.
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
  /// `area`: see FilmWeights::cell. What is no finite number is bad, and none of its parts.
  void add(const Splat&, const PixelArea& area);
  /// I(x)
  static double brightness(std::span<const Brightness> parts, const FilmWeights& v) {
    double sum = 0;
    for (const Brightness& part : parts) sum += double(part.luminance) * double(v[part.cell]);
    return sum;
  }
  double brightness(const FilmWeights& v) const { return brightness(luminances, v); }
  /// Adds F, times a factor, to a film.
  void add_to(ImageTile&, double factor) const;
  /// Has the film count what is bad: once for each path.
  void report_bad(ImageTile&) const;
};

/// The independent paths that chains begin with.
class ChainStarts {
 public:
  /// A path of the pool, as far as it is kept: `order` tells paths apart that fall on different parts of the film.
  struct Path {
    std::uint64_t number = 0;
    double brightness = 0;
    std::uint32_t order = 0;
  };
  explicit ChainStarts(std::vector<Path>);

  /// W, the mean of I.
  double mean() const { return mean_; }
  /// Path number that a chain of so many begins with: each path begins as many chains as are its share of all brightness, up to
  /// rounding, which `u` in [0, 1), one number for all chains, settles. Chains of neighbouring numbers begin near each other on
  /// the film, so that they spread over all of it (systematic resampling: Kitagawa 1996).
  std::uint64_t begin(std::uint64_t chain, std::uint64_t chains, double u) const;

 private:
  std::vector<Path> paths_;
  std::vector<double> sums_;  ///< of the brightness of all paths up to each
  double mean_ = 0;
};

/// What a chain's states count for when part of its proposals is drawn anew, independently of its state: those are samples of
/// the whole integral as well, and are better where there is little light. N states of a chain, of which p N are proposed so,
/// find F with the densities N I / b and p N; the balance heuristic (Veach & Guibas 1995) gives
///     ([drawn anew] b + a W) F / (p b + I)
/// to the mean of N, a being the part of a state that its chain takes: 1 - acceptance and acceptance of the states before and
/// after a proposal (Veach & Guibas's expected values; Kelemen et al. 2002 have the same with W = b).
/// `b` need only be near the integral, but must not depend on what is weighted: it comes from other paths than W.
struct StateWeights {
  double W = 0, b = 0, p = 0;
  double scale = 1;  ///< of all

  double factor(bool drawn_anew, double part, double brightness) const {
    return scale * ((drawn_anew ? b : 0) + part * W) / (p * b + brightness);
  }
};

/// Throws an Error at the component if wavelengths do not follow from a number alone. Those that take turns over a pixel's
/// samples (GridWavelengths) cannot be mutated.
void require_mutable(const WavelengthSampler&, const Component&);

/// Uniform numbers for choices of the algorithm itself.
class ChoiceNumbers {
 public:
  explicit ChoiceNumbers(std::uint64_t seed) : seed_(seed) {}
  double next() { return double(mix_bits(seed_ + ++drawn_ * 0x9e3779b97f4a7c15ull) >> 11) * 0x1p-53; }

 private:
  std::uint64_t seed_, drawn_ = 0;
};

}  // namespace etendue
