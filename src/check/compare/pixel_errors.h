#pragma once
// Errors of images relative to a reference, and the part of the error that is bias. Images are X Y Z, three numbers per pixel.

#include <span>
#include <vector>

#include "statistics.h"

namespace etendue::comparing {

/// The reference that takes the place of the truth.
struct Reference {
  std::vector<double> mean;      ///< X Y Z of each pixel
  std::vector<double> variance;  ///< of these means; empty: the reference is taken as exact
  double variance_at(size_t i) const { return variance.empty() ? 0 : variance[i]; }
};

/// Weights 1 / (r^2 + e), with e so that black pixels do not dominate: that of `Comparison::relative_mean_square_error`
/// (film/image_tools.h).
std::vector<double> relative_weights(std::span<const double> reference);

/// mean w (x - r)^2; with a reference of known variance, this minus the reference's own noise, mean w var(r).
double relative_square_error(std::span<const float> picture, const Reference&, std::span<const double> weights);
/// mean 2 |x - r| / (|x| + |r|), from 0 to 2.
double symmetric_error(std::span<const float> picture, std::span<const double> reference);

/// Sums over the images of independent runs, for means, variances and biases.
class RunSums {
 public:
  explicit RunSums(size_t numbers) : sum_(numbers), squares_(numbers) {}
  void add(std::span<const float> picture);
  double runs() const { return runs_; }
  double mean(size_t i) const { return sum_[i] / runs_; }
  /// The variance of one run, unbiased.
  double variance(size_t i) const;
  /// The mean without one of the runs.
  double mean_without(size_t i, float of_run) const { return (sum_[i] - double(of_run)) / (runs_ - 1); }
  size_t size() const { return sum_.size(); }

  /// mean w var: the part of the error of one run that is due to its random numbers.
  double relative_variance(std::span<const double> weights) const;
  /// mean w (E x - r)^2, an unbiased estimate from the products of different runs' differences d from r,
  ///     ((sum d)^2 - sum d^2) / (K (K - 1)),
  /// less the variance of the reference. May be negative where there is next to no bias.
  double relative_square_bias(const Reference&, std::span<const double> weights) const;
  /// The same without one of the runs, for the jackknife.
  double relative_square_bias_without(std::span<const float> run, const Reference&, std::span<const double> weights) const;

 private:
  std::vector<double> sum_, squares_;
  double runs_ = 0;
};

}  // namespace etendue::comparing
