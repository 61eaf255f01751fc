// What holds of every reconstruction filter.

#include <fmt/format.h>

#include "conformance.h"
#include "etendue/filter.h"

namespace etendue::conform {

namespace {

void check_filter(Trial& trial) {
  const Filter& filter = trial.part<Filter>();
  const float radius = filter.radius();
  if (!trial.expect(radius > 0 && radius < 1000, "the radius is positive and finite",
                    [&] { return fmt::format("{}", radius); }))
    return;

  // The midpoint rule over the whole support.
  constexpr int steps = 101;
  double sum = 0;
  for (int i = 0; i < steps; ++i)
    for (int k = 0; k < steps; ++k) {
      const float x = radius * (2 * (float(i) + 0.5f) / steps - 1), y = radius * (2 * (float(k) + 0.5f) / steps - 1);
      const float w = filter.weight(x, y);
      trial.expect(std::isfinite(w), "weights are finite", [&] { return fmt::format("{} at ({}, {})", w, x, y); });
      sum += double(w) / (steps * steps);
      for (const float other : {filter.weight(-x, y), filter.weight(x, -y), filter.weight(-x, -y)})
        trial.expect(std::abs(w - other) <= 1e-5f * std::abs(w) + 1e-7f, "the filter is symmetric",
                     [&] { return fmt::format("{} at ({}, {}), {} opposite", w, x, y, other); });
    }
  trial.expect(sum > 1e-30, "weights have a positive sum", [&] { return fmt::format("their mean is {}", sum); });
  trial.expect(filter.weight(0, 0) > 0, "the centre counts", [&] { return fmt::format("{}", filter.weight(0, 0)); });

  for (int i = trial.samples(4000); i > 0; --i) {
    // Mostly points just outside the support, in one direction or both.
    const float away = radius * (1 + 1e-5f) + (trial.uniform() < 0.5f ? 1e-3f : 3) * trial.uniform();
    const float beyond = trial.uniform() < 0.5f ? away : -away, any = 2 * radius * (2 * trial.uniform() - 1);
    const float x = trial.uniform() < 0.5f ? beyond : any, y = x == beyond ? any : beyond;
    const float w = filter.weight(x, y);
    trial.expect(w == 0, "weights are zero beyond the radius",
                 [&] { return fmt::format("{} at ({}, {}), radius {}", w, x, y, radius); });
  }
}

const RegisterCheck<Filter> registered(check_filter);

}  // namespace
}  // namespace etendue::conform
