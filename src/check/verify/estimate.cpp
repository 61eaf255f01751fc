#include "estimate.h"

#include <cmath>
#include <limits>

namespace etendue::verify {
namespace {

constexpr double unknown = std::numeric_limits<double>::infinity();

}  // namespace

Estimate mean_of(std::span<const double> numbers) {
  const double n = double(numbers.size());
  if (numbers.empty()) return {0, unknown, 0};
  double sum = 0, squares = 0;
  for (const double x : numbers) sum += x;
  const double mean = sum / n;
  for (const double x : numbers) squares += (x - mean) * (x - mean);
  return {mean, n > 1 ? std::sqrt(squares / (n - 1) / n) : unknown, n - 1};
}

Estimate jackknife(double of_all, std::span<const double> without_each) {
  const double n = double(without_each.size());
  if (n < 2) return {of_all, unknown, 0};
  const Estimate mean = mean_of(without_each);  // its error is sqrt(sum / (n - 1) / n)
  return {of_all, mean.error * (n - 1), n - 1};
}

std::optional<double> exponent(std::span<const double> x, std::span<const double> y) {
  double n = 0, sx = 0, sy = 0;
  const auto each = [&](auto&& use) {
    for (size_t i = 0; i < x.size(); ++i)
      if (x[i] > 0 && y[i] > 0) use(std::log(x[i]), std::log(y[i]));
  };
  each([&](double lx, double ly) { n += 1, sx += lx, sy += ly; });
  if (n < 2) return {};
  double xx = 0, xy = 0;
  each([&](double lx, double ly) { xx += (lx - sx / n) * (lx - sx / n), xy += (lx - sx / n) * (ly - sy / n); });
  if (!(xx > 1e-12)) return {};
  return xy / xx;
}

std::optional<Estimate> exponent_of_mean(std::span<const double> x, const std::vector<std::vector<double>>& runs) {
  const auto without = [&](size_t left_out) {
    std::vector<double> mean(x.size());
    for (size_t run = 0; run < runs.size(); ++run)
      for (size_t i = 0; run != left_out && i < x.size(); ++i) mean[i] += runs[run][i];
    return exponent(x, mean);
  };
  const std::optional<double> all = without(runs.size());
  if (!all) return {};
  std::vector<double> without_each;
  for (size_t run = 0; run < runs.size(); ++run)
    if (const std::optional<double> s = without(run)) without_each.push_back(*s);
  return jackknife(*all, without_each.size() == runs.size() ? without_each : std::vector<double>());
}

}  // namespace etendue::verify
