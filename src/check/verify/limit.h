#pragma once
// Estimates the limit of a consistent algorithm's means by extrapolation from its steps. docs/verify.md describes the method.

#include <functional>
#include <vector>

#include "agreement.h"
#include "estimate.h"

namespace etendue::verify {

/// Weights c_j with which sum c_j y_j estimates y of y_j = y + b x_j + noise of variance v_j, by least squares. Empty if all
/// x_j are equal.
std::vector<double> limit_weights(const std::vector<double>& x, const std::vector<double>& variances);

/// Divides the samples of a pass at the marks 1, 2, 4, … steps and its end, and computes the limit from the means at the marks.
class LimitOfPass {
 public:
  /// `width` is ShrinkingBias::bias_width. Throws Error if a pass has too few samples for the extrapolation.
  LimitOfPass(std::uint32_t samples, std::uint32_t samples_per_step, const std::function<double(std::uint32_t step)>& width);

  const std::vector<std::uint32_t>& marks() const { return marks_; }
  /// The limit, from the means of the pass until each mark, if the bias of a step is proportional to w or to w^2, respectively.
  double limit_by_width(const std::vector<double>& means) const { return sum(by_width_, means); }
  double limit_by_square(const std::vector<double>& means) const { return sum(by_square_, means); }
  /// The ratio of standard errors of the limit (the mean of both) and of the last mean, if all noise is due to photons.
  double noise() const { return noise_; }

 private:
  static double sum(const std::vector<double>& weights, const std::vector<double>& means);
  std::vector<std::uint32_t> marks_;
  std::vector<double> by_width_, by_square_;  // of the means
  double noise_ = 1;
};

/// The decrease of the bias relative to the mean, as the root mean square over tiles, at each mark.
struct Convergence {
  std::vector<double> samples;
  std::vector<double> bias;      ///< 0 where it is not significant
  std::vector<double> error;     ///< standard errors of `bias`
  std::optional<Estimate> rate;  ///< r of bias ~ N^-r; empty: not enough significant marks
};
/// `tiles[pass][mark]` are the means of all tiles; `truth[pass]` the reference means of independent passes.
Convergence convergence(const std::vector<std::uint32_t>& marks, const std::vector<std::vector<std::vector<double>>>& tiles,
                        const std::vector<std::vector<double>>& truth);

}  // namespace etendue::verify
