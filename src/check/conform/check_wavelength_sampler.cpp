// Checks of every wavelength sampler: wavelengths are in the visible range, follow their stated pdfs, and give an unbiased
// colour of a spectrum.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "conformance.h"
#include "etendue/describe/bands.h"
#include "etendue/wavelength_sampler.h"
#include "statistics.h"

namespace etendue::conform {
namespace {

/// The number of samples at a wavelength (or in an interval), and the sum of their 1 / pdf [nm].
struct Cell {
  double low = 0, high = 0;  // [nm]
  double count = 0, inverse = 0;
  /// The probability of the cell according to the pdfs of its samples, by E[1/p | cell] = width / P(cell).
  double probability() const { return count > 0 ? (high - low) * count / inverse : 0; }
};

class WavelengthTrial {
 public:
  explicit WavelengthTrial(Trial& t) : trial(t), sampler_(t.part<WavelengthSampler>()) {}

  void check() {
    if (in_bands(sampler_.sample({}, 0))) return check_bands();
    draw();
    if (usable_) find_support();
    if (!usable_) return;
    for (size_t lane = 0; lane < size_t(spectrum_size); ++lane) check_lane(lane);
    check_white();
  }

 private:
  /// Draws the samples of some pixels, in order as in a render.
  void draw() {
    constexpr int per_pixel = 4096;
    const int pixels = std::max(1, trial.samples(40));
    for (int i = 0; i < pixels; ++i) {
      SampleKey key(1, int(trial.random() % 1000), int(trial.random() % 1000), 0);
      for (int s = 0; s < per_pixel; ++s, ++key.sample) {
        const float u = s == 0 ? 0 : s == 1 ? one_minus_epsilon : trial.uniform();
        const Wavelengths w = sampler_.sample(key, u), again = sampler_.sample(key, u);
        for (int k = 0; k < spectrum_size; ++k) {
          trial.expect(again[k] == w[k] && again.pdf(k) == w.pdf(k), "the same sample has the same wavelengths");
          usable_ &= trial.expect(w[k] >= wavelength_low && w[k] <= wavelength_high, "wavelengths lie in [360, 830] nm",
                                  [&] { return fmt::format("{} nm for u = {}", w[k], u); });
          usable_ &= trial.expect(w.pdf(k) > 0 && std::isfinite(w.pdf(k)), "densities are finite and more than 0",
                                  [&] { return fmt::format("{} at {} nm", w.pdf(k), w[k]); });
        }
        drawn_.push_back(w);
      }
    }
  }

  /// Paths in bands all carry the same ones, and the RGB (1, 1, 1) is the white of their space.
  void check_bands() {
    const Wavelengths first = sampler_.sample({}, 0);
    for (int i = 0; i < std::max(8, trial.samples(100)); ++i) {
      const SampleKey key(1, int(trial.random() % 1000), int(trial.random() % 1000), i);
      const Wavelengths w = sampler_.sample(key, trial.uniform());
      trial.expect(in_bands(w) && &space_of_bands(w) == &space_of_bands(first), "all samples have the same bands");
    }
    const auto& white = space_of_bands(first).white;
    const Xyz c = to_xyz(Spectrum(1.0f), first);
    trial.expect(std::abs(c.y - 1) < 1e-5 && std::abs(c.x - white[0] / white[1]) < 1e-5, "equal components are the white",
                 [&] { return fmt::format("X Y Z are {:.5f} {:.5f} {:.5f}", c.x, c.y, c.z); });
  }

  /// Finds the support of the distribution: an interval, or so few single wavelengths that each gets a cell of its own.
  void find_support() {
    std::map<float, int> distinct;
    constexpr size_t most = 5000;
    for (const Wavelengths& w : drawn_)
      for (int k = 0; k < spectrum_size && distinct.size() <= most; ++k) ++distinct[w[k]];
    double low = infinity, high = 0;
    for (const Wavelengths& w : drawn_)
      for (int k = 0; k < spectrum_size; ++k) low = std::min(low, double(w[k])), high = std::max(high, double(w[k]));
    discrete_ = distinct.size() <= most;
    constexpr double narrowest = 5;  // [nm]: in a narrower interval the floats are too coarse for a test
    if (distinct.size() > 1 && high - low < narrowest) {
      usable_ = false;
      trial.not_tried("wavelengths follow the density", fmt::format("they lie within {:.3g} nm", high - low));
      return;
    }
    if (!discrete_) {
      constexpr int cells = 96;
      for (int i = 0; i < cells; ++i)
        cells_.push_back({std::lerp(low, high, double(i) / cells), std::lerp(low, high, double(i + 1) / cells)});
      return;
    }
    // Cells end midway between neighbours; the first and the last cell are symmetric about their wavelengths.
    std::vector<double> at;
    for (const auto& [lambda, count] : distinct) at.push_back(double(lambda));
    if (at.size() == 1) {  // the width of its cell follows only from the pdf
      const double half = 0.5 / double(drawn_.front().pdf(0));
      cells_.push_back({at[0] - half, at[0] + half});
      return;
    }
    for (size_t i = 0; i < at.size(); ++i) {
      const double below = i > 0 ? at[i] - at[i - 1] : at[1] - at[0], above = i + 1 < at.size() ? at[i + 1] - at[i] : below;
      cells_.push_back({at[i] - below / 2, at[i] + above / 2});
    }
  }

  size_t cell_of(float lambda) const {
    const auto next =
        std::upper_bound(cells_.begin(), cells_.end(), double(lambda), [](double x, const Cell& c) { return x < c.low; });
    return next == cells_.begin() ? 0 : size_t(next - cells_.begin()) - 1;
  }

  /// Tests that each of a path's wavelengths by itself follows the pdf.
  void check_lane(size_t lane) {
    std::vector<Cell> cells = cells_;
    for (const Wavelengths& w : drawn_) {
      Cell& c = cells[cell_of(w[int(lane)])];
      c.count += 1;
      c.inverse += 1 / double(w.pdf(int(lane)));
    }
    double sum = 0;
    const double n = double(drawn_.size());
    std::vector<double> counts, expected;
    for (const Cell& c : cells) {
      sum += c.probability();
      counts.push_back(c.count);
      expected.push_back(n * c.probability());
    }
    // The probability of an empty cell is unknown: it is what the sum lacks to 1. The tolerance is that of single precision.
    trial.expect(std::abs(sum - 1) < 1e-3, "densities integrate to 1", [&] {
      return fmt::format("{} over {} to {} nm, of wavelength {}", sum, cells.front().low, cells.back().high, lane);
    });
    const double p = statistics::chi_square(counts, expected);
    trial.expect(p > Trial::significance, "wavelengths follow the density", [&] {
      return fmt::format("p = {:.3g} of {} wavelengths in {} cells, of wavelength {}", p, n, cells.size(), lane);
    });
  }

  /// The mean estimate of the colour of a spectrum that is 1 everywhere must be its colour, over the wavelengths in the
  /// support.
  void check_white() {
    Xyz exact;
    if (discrete_) {
      for (const Cell& c : cells_) add(exact, observer(float((c.low + c.high) / 2)), c.high - c.low);
    } else {
      constexpr int steps = 20000;
      const double low = cells_.front().low, step = (cells_.back().high - low) / steps;
      for (int i = 0; i < steps; ++i) add(exact, observer(float(low + (i + 0.5) * step)), step);
    }
    statistics::Mean x, y, z;
    for (const Wavelengths& w : drawn_) {
      const Xyz estimate = to_xyz(Spectrum(1.0f), w);
      x.add(estimate.x), y.add(estimate.y), z.add(estimate.z);
    }
    const std::pair<const statistics::Mean*, double> all[] = {{&x, exact.x}, {&y, exact.y}, {&z, exact.z}};
    for (const auto& [mean, truth] : all)
      trial.expect(std::abs(mean->mean() - truth) < Trial::significant_errors * mean->error() + 1e-3 * (truth + 0.01),
                   "the mean colour of a constant spectrum is its colour",
                   [&, m = mean, t = truth] { return fmt::format("{:.5f} ± {:.5f}, not {:.5f}", m->mean(), m->error(), t); });
  }
  static void add(Xyz& sum, const Xyz& o, double width) {
    const double factor = width / observer_y_integral();
    sum.x += factor * o.x, sum.y += factor * o.y, sum.z += factor * o.z;
  }

  Trial& trial;
  const WavelengthSampler& sampler_;
  std::vector<Wavelengths> drawn_;
  std::vector<Cell> cells_;
  bool usable_ = true, discrete_ = false;
};

void check_wavelength_sampler(Trial& trial) { WavelengthTrial(trial).check(); }

const RegisterCheck<WavelengthSampler> registered(check_wavelength_sampler);

}  // namespace
}  // namespace etendue::conform
