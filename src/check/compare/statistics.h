#pragma once
// The statistics of a comparison, on numbers alone: estimates with their errors, curves, and tests of which variant is better.
// docs/compare.md describes the method.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "check/verify/estimate.h"

namespace etendue::comparing {

using verify::Estimate;
using verify::exponent;
using verify::exponent_of_mean;
using verify::jackknife;
using verify::mean_of;

/// The confidence interval of a positive quantity, by Student's t and symmetric on a logarithmic scale, where the standard
/// error of the logarithm is error / value. Empty: the error is unknown.
struct Band {
  double low = 0, high = 0;
};
std::optional<Band> band(const Estimate&, double probability);

/// Interpolates a curve through points (x ascending, y): linearly in logarithms, or in the values where a y is not positive.
/// Empty outside of the points.
std::optional<double> read_curve(std::span<const double> x, std::span<const double> y, double at);

// ---- who is better
// -------------------------------------------------------------------------------------------------------------

/// The comparison of two variants on one scene.
struct Contest {
  size_t scene = 0, a = 0, b = 0;
  double ratio = 1;      ///< geometric mean of a's errors over that of b's
  double p = 1;          ///< Welch's t-test of the logarithms, two-sided
  double corrected = 1;  ///< p corrected for all contests of all scenes (Holm)
  bool significant = false;
};

/// Tests all pairs of variants of all scenes: errors[scene][variant][run]. Variants with an empty list are left out.
std::vector<Contest> contests(const std::vector<std::vector<std::vector<double>>>& errors, double significance);

/// The variant with the smallest geometric mean error on a scene, and whether it is significantly better than every other.
struct Winner {
  std::optional<size_t> variant;
  bool significant = false;
};
Winner winner(const std::vector<std::vector<double>>& errors_of_scene, const std::vector<Contest>&, size_t scene);

/// The geometric mean of ratios over scenes with its relative standard error, from the logarithms of the ratios.
struct GeometricMean {
  double value = 1, relative_error = 0;
  size_t scenes = 0;
};
GeometricMean geometric_mean(std::span<const Estimate> logarithms);
/// The logarithm of the ratio of two lists' geometric means, with its standard error.
Estimate log_ratio(std::span<const double> a, std::span<const double> b);

}  // namespace etendue::comparing
