#pragma once
// Numbers that were estimated from independent runs, with their errors.

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

/// The mean of independent numbers. One alone has no error that is known.
Estimate mean_of(std::span<const double>);

/// An estimate from all runs, with its standard error by the jackknife (Quenouille 1956, Tukey 1958): from the same estimate
/// without each of the n runs in turn, (n - 1)/n sum (x_i - mean x)^2.
Estimate jackknife(double of_all, std::span<const double> without_each);

/// The exponent of y = c x^s by least squares of logarithms. Points that are not positive are left out; empty when fewer than
/// two different x are left.
std::optional<double> exponent(std::span<const double> x, std::span<const double> y);

/// The exponent of the runs' mean y, errors[run][point] at x[point], with its error by the jackknife over the runs: the points
/// of one run are not independent of each other, the runs are.
std::optional<Estimate> exponent_of_mean(std::span<const double> x, const std::vector<std::vector<double>>& runs);

}  // namespace etendue::verify
