#pragma once
// What the means of a consistent algorithm go to: extrapolated from its steps. docs/verify.md tells how.

#include <functional>
#include <vector>

#include "agreement.h"
#include "estimate.h"

namespace etendue::verify {

/// Weights c_j, with which sum c_j y_j estimates y of y_j = y + b x_j + noise of variance v_j, by least squares. Empty when all
/// x_j are equal.
std::vector<double> limit_weights(const std::vector<double>& x, const std::vector<double>& variances);

/// The samples of a pass, divided at 1, 2, 4, … and at its end, and what makes its limit of the means at those.
class LimitOfPass {
 public:
  /// `width` is ShrinkingBias::bias_width. Throws Error when a pass is too short to tell.
  LimitOfPass(std::uint32_t samples, std::uint32_t samples_per_step, const std::function<double(std::uint32_t step)>& width);

  const std::vector<std::uint32_t>& marks() const { return marks_; }
  /// From the means of the pass until each mark: the limit if the bias of a step is proportional to w, and if to w^2.
  double limit_by_width(const std::vector<double>& means) const { return sum(by_width_, means); }
  double limit_by_square(const std::vector<double>& means) const { return sum(by_square_, means); }
  /// The standard error of the mean of both over that of the last mean, if photons alone make noise.
  double noise() const { return noise_; }

 private:
  static double sum(const std::vector<double>& weights, const std::vector<double>& means);
  std::vector<std::uint32_t> marks_;
  std::vector<double> by_width_, by_square_;  // of the means
  double noise_ = 1;
};

/// How the bias goes away: relative to the mean, root mean square over the tiles, at each mark.
struct Convergence {
  std::vector<double> samples;
  std::vector<double> bias;      ///< 0 where it is lost in noise
  std::vector<double> error;     ///< standard error of these
  std::optional<Estimate> rate;  ///< r of bias ~ N^-r; empty: it cannot be told
};
/// `tiles[pass][mark]` are the means of all tiles; `truth` what they should be, of independent passes.
Convergence convergence(const std::vector<std::uint32_t>& marks, const std::vector<std::vector<std::vector<double>>>& tiles,
                        const std::vector<std::vector<double>>& truth);

}  // namespace etendue::verify
