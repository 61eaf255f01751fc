#include "statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "check/verify/agreement.h"
#include "check/verify/student.h"

namespace etendue::comparing {
namespace {

constexpr double unknown = std::numeric_limits<double>::infinity();

/// Logarithms of errors; an error of zero (of a deterministic result) is replaced by the smallest positive number.
std::vector<double> logarithms(std::span<const double> numbers) {
  std::vector<double> logs;
  for (const double x : numbers) logs.push_back(std::log(std::max(x, std::numeric_limits<double>::min())));
  return logs;
}

}  // namespace

std::optional<Band> band(const Estimate& e, double probability) {
  if (!(e.value > 0) || !std::isfinite(e.error) || !(e.freedom > 0)) return {};
  const double half = verify::student_upper_quantile((1 - probability) / 2, e.freedom) * e.error / e.value;
  return Band{e.value * std::exp(-half), e.value * std::exp(half)};
}

std::optional<double> read_curve(std::span<const double> x, std::span<const double> y, double at) {
  if (x.empty() || !(at >= x.front()) || !(at <= x.back())) return {};
  const auto after = size_t(std::lower_bound(x.begin(), x.end(), at) - x.begin());
  if (x[after] == at) return y[after];
  const size_t before = after - 1;
  const bool logarithmic = x[before] > 0 && y[before] > 0 && y[after] > 0;
  if (!logarithmic) return y[before] + (y[after] - y[before]) * (at - x[before]) / (x[after] - x[before]);
  const double t = std::log(at / x[before]) / std::log(x[after] / x[before]);
  return y[before] * std::pow(y[after] / y[before], t);
}

Estimate log_ratio(std::span<const double> a, std::span<const double> b) {
  const Estimate la = mean_of(logarithms(a)), lb = mean_of(logarithms(b));
  const double va = la.error * la.error, vb = lb.error * lb.error, sum = va + vb;
  // The degrees of freedom of Welch & Satterthwaite.
  return {la.value - lb.value, std::sqrt(sum), sum > 0 ? sum * sum / (va * va / la.freedom + vb * vb / lb.freedom) : 1};
}

std::vector<Contest> contests(const std::vector<std::vector<std::vector<double>>>& errors, double significance) {
  std::vector<Contest> all;
  std::vector<double> p;
  for (size_t scene = 0; scene < errors.size(); ++scene)
    for (size_t a = 0; a < errors[scene].size(); ++a)
      for (size_t b = a + 1; b < errors[scene].size(); ++b) {
        if (errors[scene][a].empty() || errors[scene][b].empty()) continue;
        const Estimate difference = log_ratio(errors[scene][a], errors[scene][b]);
        Contest c{scene, a, b, std::exp(difference.value)};
        if (!std::isfinite(difference.error))
          c.p = 1;
        else if (difference.error > 0)
          c.p = verify::student_two_sided(difference.value / difference.error, difference.freedom);
        else
          c.p = difference.value == 0 ? 1 : 0;
        p.push_back(c.p);
        all.push_back(c);
      }
  const std::vector<double> corrected = verify::holm(p, std::vector<double>(p.size(), 1.0));
  for (size_t i = 0; i < all.size(); ++i) {
    all[i].corrected = corrected[i];
    all[i].significant = corrected[i] <= significance;
  }
  return all;
}

Winner winner(const std::vector<std::vector<double>>& errors, const std::vector<Contest>& all, size_t scene) {
  Winner best;
  double least = unknown;
  for (size_t v = 0; v < errors.size(); ++v) {
    if (errors[v].empty()) continue;
    const double mean = mean_of(logarithms(errors[v])).value;
    if (mean < least) best.variant = v, least = mean;
  }
  bool any = false;
  best.significant = true;
  for (const Contest& c : all)
    if (best.variant && c.scene == scene && (c.a == *best.variant || c.b == *best.variant)) {
      any = true;
      best.significant = best.significant && c.significant;
    }
  best.significant = best.significant && any;
  return best;
}

GeometricMean geometric_mean(std::span<const Estimate> logs) {
  GeometricMean mean;
  double sum = 0, variance = 0;
  for (const Estimate& e : logs) sum += e.value, variance += e.error * e.error;
  mean.scenes = logs.size();
  if (logs.empty()) return mean;
  mean.value = std::exp(sum / double(logs.size()));
  mean.relative_error = std::sqrt(variance) / double(logs.size());
  return mean;
}

}  // namespace etendue::comparing
