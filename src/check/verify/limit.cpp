// Steps i = 0, 1, … of a consistent algorithm have a bias that shrinks with a known width w_i (ShrinkingBias): as w where a
// blur carries light over an edge, because the affected part of the picture is as wide as the blur, and as w^2 elsewhere (Knaus
// & Zwicker 2011). For each of both the mean over the samples between two marks is
//     y_j = y + b x_j + noise,     x_j the mean of w or of w^2 over those steps,
// and y is found by least squares: a sum c_j y_j with weights c_j that depend only on the w. So each pass gives one number with
// the same expectation as an unbiased renderer's, except that the true bias is between w and w^2, and passes are as independent
// as before: they are compared by the same tests. The mean of both estimates is the limit, and half of their difference counts
// as a standard error. (Fitting both terms at once would leave less doubt, but with five times the noise.)

#include "limit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "etendue/core/error.h"

namespace etendue::verify {

std::vector<double> limit_weights(const std::vector<double>& x, const std::vector<double>& variances) {
  // A line's value at 0, with weights 1 / v: y = (S_xx S_y - S_x S_xy) / (S S_xx - S_x^2).
  double s = 0, sx = 0, sxx = 0;
  for (size_t j = 0; j < x.size(); ++j) {
    s += 1 / variances[j];
    sx += x[j] / variances[j];
    sxx += x[j] * x[j] / variances[j];
  }
  const double determinant = s * sxx - sx * sx;
  if (!(determinant > 1e-12 * s * sxx)) return {};
  std::vector<double> weights;
  for (size_t j = 0; j < x.size(); ++j) weights.push_back((sxx - sx * x[j]) / variances[j] / determinant);
  return weights;
}

LimitOfPass::LimitOfPass(std::uint32_t samples, std::uint32_t samples_per_step,
                         const std::function<double(std::uint32_t)>& width) {
  for (std::uint32_t n = samples_per_step; n < samples; n *= 2) marks_.push_back(n);
  marks_.push_back(samples);
  std::vector<double> widths, squares, variances, counts;  // between marks
  for (size_t j = 0; j < marks_.size(); ++j) {
    const std::uint32_t begin = j == 0 ? 0 : marks_[j - 1], end = marks_[j];
    double w = 0, ww = 0, count = 0;
    for (std::uint32_t step = begin / samples_per_step; step * samples_per_step < end; ++step) {
      const double h = width(step), n = double(std::min(end, (step + 1) * samples_per_step) - step * samples_per_step);
      w += n * h;
      ww += n * h * h;
      count += n;
    }
    widths.push_back(w / count);
    squares.push_back(ww / count);
    counts.push_back(count);
    // The number of photons within r of a point is proportional to r^2.
    variances.push_back(1 / std::max(ww, 1e-300));
  }
  const std::vector<double> line = limit_weights(widths, variances), square = limit_weights(squares, variances);
  constexpr size_t fewest_marks = 4;
  if (marks_.size() < fewest_marks)
    throw Error(
        fmt::format("{} samples in each pass are too few to tell what a consistent renderer goes to: give it at least "
                    "{}, by more --samples or fewer --passes",
                    samples, 8 * samples_per_step));
  if (line.empty() || square.empty())
    throw Error("a renderer that says how its bias shrinks has the same bias in all steps: it goes nowhere");
  // Converts weights of the means y_j between marks to weights of the means m_j until marks: y_j = (n_j m_j - n_{j-1} m_{j-1})
  // / (n_j - n_{j-1}).
  const auto of_means = [&](const std::vector<double>& weights) {
    std::vector<double> result(weights.size());
    for (size_t j = 0; j < weights.size(); ++j) {
      result[j] += weights[j] * marks_[j] / counts[j];
      if (j > 0) result[j - 1] -= weights[j] * marks_[j - 1] / counts[j];
    }
    return result;
  };
  double error = 0, last = 0;
  for (size_t j = 0; j < counts.size(); ++j) {
    const double both = 0.5 * (line[j] + square[j]), share = counts[j] / samples;
    error += both * both * variances[j];
    last += share * share * variances[j];
  }
  noise_ = std::sqrt(error / last);
  by_width_ = of_means(line);
  by_square_ = of_means(square);
}

double LimitOfPass::sum(const std::vector<double>& weights, const std::vector<double>& means) {
  double total = 0;
  for (size_t j = 0; j < weights.size(); ++j) total += weights[j] * means[j];
  return total;
}

namespace {

/// The mean over tiles of the squared bias of the passes, relative to the squared mean; pass `left_out` is ignored. An unbiased
/// estimate from products of different passes' differences, less the variance of the truth.
double square_bias(const std::vector<std::vector<std::vector<double>>>& tiles, size_t mark, size_t left_out,
                   const std::vector<Estimate>& truth) {
  double total = 0, light = 0;
  for (size_t tile = 0; tile < truth.size(); ++tile) {
    double sum = 0, squares = 0, n = 0;
    for (size_t pass = 0; pass < tiles.size(); ++pass) {
      if (pass == left_out) continue;
      const double d = tiles[pass][mark][tile] - truth[tile].value;
      sum += d;
      squares += d * d;
      n += 1;
    }
    total += (sum * sum - squares) / (n * (n - 1)) - truth[tile].error * truth[tile].error;
    light += truth[tile].value * truth[tile].value;
  }
  return light > 0 ? total / light : 0;
}

}  // namespace

Convergence convergence(const std::vector<std::uint32_t>& marks, const std::vector<std::vector<std::vector<double>>>& tiles,
                        const std::vector<std::vector<double>>& truth) {
  std::vector<Estimate> means;
  for (size_t tile = 0; tile < truth.front().size(); ++tile) {
    std::vector<double> of_passes;
    for (const auto& pass : truth) of_passes.push_back(pass[tile]);
    means.push_back(mean_of(of_passes));
  }
  Convergence result;
  std::vector<std::vector<double>> squares(
      tiles.size() + 1);  // without each pass, and of all passes, at the marks where the bias is significant
  std::vector<double> samples;
  for (size_t mark = 0; mark < marks.size(); ++mark) {
    const double of_all = square_bias(tiles, mark, tiles.size(), means);
    std::vector<double> without;
    for (size_t pass = 0; pass < tiles.size(); ++pass) without.push_back(square_bias(tiles, mark, pass, means));
    const Estimate e = jackknife(of_all, without);
    result.samples.push_back(marks[mark]);
    const bool seen = e.value > 2 * e.error;
    result.bias.push_back(seen ? std::sqrt(e.value) : 0);
    result.error.push_back(seen ? 0.5 * e.error / std::sqrt(e.value) : std::sqrt(std::max(e.value, 0.0) + 2 * e.error));
    if (!seen) continue;
    samples.push_back(marks[mark]);
    for (size_t pass = 0; pass < tiles.size(); ++pass) squares[pass].push_back(without[pass]);
    squares.back().push_back(of_all);
  }
  constexpr size_t least = 3;
  if (samples.size() < least) return result;
  const std::optional<double> slope = exponent(samples, squares.back());
  std::vector<double> without;
  for (size_t pass = 0; pass < tiles.size(); ++pass)
    if (const std::optional<double> s = exponent(samples, squares[pass])) without.push_back(-0.5 * *s);
  if (slope && without.size() == tiles.size()) result.rate = jackknife(-0.5 * *slope, without);
  return result;
}

}  // namespace etendue::verify
