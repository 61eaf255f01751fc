// Checks of every phase function.

#include "etendue/phase_function.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "conformance.h"
#include "statistics.h"

namespace etendue::conform {
namespace {

// A chi-square test in cells over h = 1 - cos(theta) that hold about the same number of samples, so that narrow peaks are
// resolved as well as the rest. The expected shares are integrals of 2 pi value(h) by the midpoint rule.
void check_phase_function(Trial& trial) {
  const PhaseFunction& phase = trial.part<PhaseFunction>();
  const auto draw = [&](int count) {
    std::vector<float> list;
    for (; count > 0; --count) {
      const float h = phase.sample(trial.uniform());
      trial.expect(h >= 0 && h <= 2, "drawn angles are angles", [&] { return fmt::format("1 - cos = {}", h); });
      trial.expect(phase.value(h) > 0 && phase.value(h) < infinity, "drawn angles have a density",
                   [&] { return fmt::format("{} at 1 - cos = {}", phase.value(h), h); });
      list.push_back(std::clamp(h, 0.0f, 2.0f));
    }
    return list;
  };
  std::vector<float> first = draw(trial.samples(8000));
  std::ranges::sort(first);
  constexpr size_t cells = 64;
  std::vector<double> borders{0};
  for (size_t k = 1; k < cells; ++k) borders.push_back(double(first[k * first.size() / cells]));
  borders.push_back(2);
  borders.erase(std::unique(borders.begin(), borders.end()), borders.end());

  const std::vector<float> drawn = draw(trial.samples(32000));
  std::vector<double> expected, counts(borders.size() - 1);
  double sum = 0;
  for (size_t k = 0; k + 1 < borders.size(); ++k) {
    constexpr int steps = 400;
    double share = 0;
    for (int i = 0; i < steps; ++i) {
      const float value = phase.value(float(std::lerp(borders[k], borders[k + 1], (i + 0.5) / steps)));
      trial.expect(value >= 0 && value < infinity, "values are neither negative nor infinite",
                   [&] { return fmt::format("{}", value); });
      share += double(value) * 2 * double(pi) * (borders[k + 1] - borders[k]) / steps;
    }
    sum += share;
    expected.push_back(share * double(drawn.size()));
  }
  for (const float h : drawn) {
    const auto above = std::upper_bound(borders.begin() + 1, borders.end() - 1, double(h));
    ++counts[size_t(above - borders.begin()) - 1];
  }
  trial.expect(std::abs(sum - 1) < 3e-3, "the phase function integrates to 1", [&] { return fmt::format("{:.5f}", sum); });
  const double p = statistics::chi_square(counts, expected, 10);
  trial.expect(p > Trial::significance, "drawn angles follow the phase function", [&] { return fmt::format("p = {:.2g}", p); });
}

const RegisterCheck<PhaseFunction> registered(check_phase_function);

}  // namespace
}  // namespace etendue::conform
