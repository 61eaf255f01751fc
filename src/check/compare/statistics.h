#pragma once
// The mathematics of a comparison, on numbers alone: estimates with their errors, curves, and who is better.
// docs/compare.md tells the whole of it.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace etendue::comparing {

/// A number that was estimated from independent runs.
struct Estimate {
  double value = 0;
  double error = 0;    ///< standard error; infinite: unknown
  double freedom = 0;  ///< degrees of freedom of that error
};

/// The mean of independent numbers. One alone has no error that is known.
Estimate mean_of(std::span<const double>);

/// An estimate from all runs, with its standard error by the jackknife (Quenouille 1956, Tukey 1958): from the same estimate
/// without each of the n runs in turn, (n - 1)/n sum (x_i - mean x)^2.
Estimate jackknife(double of_all, std::span<const double> without_each);

/// The interval that holds a positive quantity with a probability, by Student's t and symmetric on a logarithmic scale, where
/// the standard error of the logarithm is error / value. Empty: nothing is known.
struct Band {
  double low = 0, high = 0;
};
std::optional<Band> band(const Estimate&, double probability);

/// What a curve through points (x rising, y) has at a place: a line between neighbours on logarithmic scales, on plain ones
/// where a y is not positive. Empty outside of the points.
std::optional<double> read_curve(std::span<const double> x, std::span<const double> y, double at);

/// The exponent of y = c x^s by least squares of logarithms. Points that are not positive are left out; empty when fewer than
/// two different x are left.
std::optional<double> exponent(std::span<const double> x, std::span<const double> y);

/// The exponent of the runs' mean y, errors[run][point] at x[point], with its error by the jackknife over the runs: the points
/// of one run are not independent of each other, the runs are.
std::optional<Estimate> exponent_of_mean(std::span<const double> x, const std::vector<std::vector<double>>& runs);

// ---- who is better
// -------------------------------------------------------------------------------------------------------------

/// Two variants on one scene.
struct Contest {
  size_t scene = 0, a = 0, b = 0;
  double ratio = 1;      ///< geometric mean of a's errors over that of b's
  double p = 1;          ///< Welch's t-test of the logarithms, two-sided
  double corrected = 1;  ///< for all contests of all scenes together (Holm)
  bool significant = false;
};

/// All pairs of variants of all scenes: errors[scene][variant][run]. An empty list of runs takes no part.
std::vector<Contest> contests(const std::vector<std::vector<std::vector<double>>>& errors, double significance);

/// The variant with the smallest geometric mean error on a scene, and whether it is significantly better than every other.
struct Winner {
  std::optional<size_t> variant;
  bool significant = false;
};
Winner winner(const std::vector<std::vector<double>>& errors_of_scene, const std::vector<Contest>&, size_t scene);

/// The geometric mean of ratios over scenes with its relative standard error, from those of the logarithms of each.
struct GeometricMean {
  double value = 1, relative_error = 0;
  size_t scenes = 0;
};
GeometricMean geometric_mean(std::span<const Estimate> logarithms);
/// The logarithm of the ratio of two lists' geometric means, with its standard error.
Estimate log_ratio(std::span<const double> a, std::span<const double> b);

}  // namespace etendue::comparing
