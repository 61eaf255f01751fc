#pragma once
// The statistics of whether renderers agree, on numbers alone. docs/verify.md describes the method.

#include <string>
#include <vector>

#include "etendue/film/image_buffer.h"

namespace etendue::verify {

/// A part of the light: paths of one length, in one channel.
struct Layer {
  int length = 0;  ///< segments of the paths; 0: all lengths together
  char channel = 'Y';
};

/// The layout of the means that are measured in each pass: layers x places. The places are the tiles, followed by the whole
/// picture.
struct Layout {
  std::vector<PixelArea> tiles;
  std::vector<Layer> layers;  ///< the first is all lengths together, Y
  int lengths = 0;            ///< number of path lengths distinguished; the last includes all longer paths

  /// The layout for an image of these pixels; tiles at the right and lower edge may be smaller.
  static Layout of(const PixelArea&, int tile, int lengths);

  size_t places() const { return tiles.size() + 1; }
  size_t whole() const { return tiles.size(); }
  size_t count() const { return layers.size() * places(); }
  size_t index(size_t layer, size_t place) const { return layer * places() + place; }
  PixelArea area(size_t place) const;
  double pixels(size_t place) const { return double(area(place).width()) * double(area(place).height()); }
};

/// The measurements of one renderer: independent passes, each with the means of a whole render.
struct Measured {
  std::string name;
  std::vector<std::vector<double>> passes;  ///< for each pass layout.count() means, at layout.index(layer, place)
  bool tells_lengths = true;                ///< false: path lengths are unknown, so only all lengths together are compared
  /// The systematic error of the passes' mean, as a standard error, at layout.index; empty: none. Extrapolated limits of
  /// consistent renderers have one (limit.h).
  std::vector<double> systematic;
};

enum class Verdict : std::uint8_t { agrees, undecided, disagrees };

/// The reason why a difference that a plain t-test finds significant is not counted.
enum class Doubt : std::uint8_t {
  none,
  one_pass,    ///< one pass holds more than half of the light that a renderer found in all passes
  rare_events  ///< few rare events could explain the difference: too few were seen for all of them to be expected
};

/// One comparison of two means.
struct MeanTest {
  size_t layer = 0, place = 0;
  double mean_a = 0, mean_b = 0;
  double z = 0;          ///< signed as a - b: the standard normal quantile that corresponds to `p`
  double plain_p = 1;    ///< of the unmodified Welch's t-test
  double p = 1;          ///< of the test corrected for skewed distributions
  double corrected = 1;  ///< p corrected for all tests of all pairs (Holm)
  Verdict verdict = Verdict::agrees;
  Doubt doubt = Doubt::none;
  double ratio() const { return mean_b != 0 ? mean_a / mean_b : (mean_a == 0 ? 1 : HUGE_VAL); }
};

struct PairAgreement {
  size_t a = 0, b = 0;          ///< indices in the list of renderers
  std::vector<MeanTest> tests;  ///< of layers x places, at layout.index; by length only if both renderers distinguish lengths
  Verdict verdict = Verdict::agrees;
  bool by_length = true;
  /// The smallest difference of the mean Y of the whole picture, relative to it, that is detected with a probability of 95 %.
  double noticeable = 0;
};

struct Agreement {
  double significance = 0;
  size_t tests = 0;
  std::vector<PairAgreement> pairs;
  bool disagrees() const;
};

/// Compares each pair of renderers. The probability that any disagreement is reported when all expectations are equal is at
/// most the significance. Each renderer needs at least 3 passes.
Agreement compare(const Layout&, const std::vector<Measured>&, double significance);

/// Holm's step-down correction with weights: corrects the p-values p_i so that rejecting all hypotheses with a result <= s
/// makes any error with a probability of at most s, however the p-values depend on each other. Weights are positive.
std::vector<double> holm(const std::vector<double>& p, const std::vector<double>& weights);

/// Mean and unbiased second and third central moments (k-statistics) of a place in a renderer's passes.
struct Moments {
  double count = 0, mean = 0, variance = 0, third = 0;
  bool one_pass = false;  ///< see Doubt
  /// Standard error of the mean.
  double error() const;
};
Moments moments(const Layout&, const Measured&, size_t layer, size_t place);

}  // namespace etendue::verify
