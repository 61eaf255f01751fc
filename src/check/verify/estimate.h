#pragma once
// Estimates from independent runs, with standard errors.

#include <optional>
#include <span>
#include <vector>

namespace etendue::verify {

/// A number that was estimated from independent runs.
struct Estimate {
  double value = 0;
  double error = 0;    ///< standard error; infinite: unknown
  double freedom = 0;  ///< degrees of freedom of that error
};

/// The mean of independent numbers. The error of a single number is unknown.
Estimate mean_of(std::span<const double>);

/// An estimate from all runs, with its standard error by the jackknife (Quenouille 1956, Tukey 1958). Its square is, with x_i
/// the same estimate without run i of n, (n - 1)/n sum (x_i - mean x)^2.
Estimate jackknife(double of_all, std::span<const double> without_each);

/// The exponent of y = c x^s by least squares of the logarithms. Points that are not positive are ignored; empty if fewer than
/// two different x remain.
std::optional<double> exponent(std::span<const double> x, std::span<const double> y);

/// The exponent of the runs' mean y, runs[run][point] at x[point], with its error by the jackknife over the runs, because the
/// points of one run are not independent, but the runs are.
std::optional<Estimate> exponent_of_mean(std::span<const double> x, const std::vector<std::vector<double>>& runs);

}  // namespace etendue::verify
