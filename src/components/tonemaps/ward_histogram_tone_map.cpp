#include "etendue/describe/color.h"
#include "etendue/exposed_tone_map.h"
#include "gamut.h"

namespace etendue {
namespace {

/// The smallest visible difference of luminance at an adaptation luminance [cd/m^2], from measurements of rods and cones (Ward
/// Larson et al. 1997, table 1).
double just_noticeable(double luminance) {
  const double a = std::log10(luminance);
  const double threshold = a < -3.94     ? -2.86
                           : a < -1.44   ? std::pow(0.405 * a + 1.6, 2.18) - 2.86
                           : a < -0.0184 ? a - 0.395
                           : a < 1.9     ? std::pow(0.249 * a + 0.65, 2.7) - 0.72
                                         : a - 1.255;
  return std::pow(10.0, threshold);
}

// The histogram counts the logarithms l = ln L of adaptation luminances, which are means over squares of one degree, in bins of
// width D. The cumulative share P(l) of those below l determines the displayed luminance:
//   ln L_d(l) = ln L_min + (ln L_max - ln L_min) P(l),
// so that luminances that do not occur take no part of the display's range. The slope of this curve,
// f(l) (ln L_max - ln L_min) / (T D) with f the count of a bin and T the total count, is limited by a ceiling: 1 (linear:
// contrasts are not exaggerated), or (human: differences that are invisible in the scene are invisible in the picture)
//   d ln L_d / d ln L <= (j(L_d) / L_d) / (j(L) / L),   j = just_noticeable.
// Counts above the ceiling are cut off repeatedly, as T and L_d change thereby, until almost nothing of T is cut. (The paper
// stops when less than 2.5 % of the original count is cut, which leaves scenes of a small range with more contrast than they
// have, by an amount that may depend on a single pixel.) If almost nothing is left, the scene has less range than the display,
// and its luminance is only multiplied by a factor: so that the brightest percent becomes white (linear), or so that
// differences are visible that are visible in the scene (human; Ward 1994, A contrast-based scalefactor for luminance display):
//   m = ((1.219 + (L_max / 2)^0.4) / (1.219 + L_a^0.4))^2.5   with the logarithmic mean L_a.
class Histogram {
 public:
  enum class Ceiling : std::uint8_t { human, linear, unlimited };

  Histogram(std::vector<double> luminances, double display_low, double display_high, Ceiling ceiling)
      : low_(std::log(display_low)), range_(std::log(display_high) - low_) {
    std::sort(luminances.begin(), luminances.end());
    if (luminances.empty()) luminances.push_back(display_high);
    first_ = std::log(luminances.front());
    counts_.assign(size_t((std::log(luminances.back()) - first_) / width) + 1, 0);
    for (const double l : luminances) counts_[size_t((std::log(l) - first_) / width)] += 1;
    accumulate();
    if (ceiling == Ceiling::unlimited || trim(ceiling)) return;
    factor_ = display_high / luminances[(luminances.size() - 1) * 99 / 100];
    if (ceiling == Ceiling::linear) return;
    double logarithms = 0;
    for (const double l : luminances) logarithms += std::log(l);
    const auto response = [](double l) { return 1.219 + std::pow(l, 0.4); };
    factor_ = std::pow(response(display_high / 2) / response(std::exp(logarithms / double(luminances.size()))), 2.5);
  }

  /// The luminance displayed for one of the scene, both in cd/m^2.
  double displayed(double luminance) const {
    return factor_ > 0 ? factor_ * luminance : std::exp(low_ + range_ * share(std::log(luminance)));
  }

 private:
  static constexpr double width = 0.05, least_left = 0.025, little_cut = 1e-4;

  double share(double l) const {
    const double at = (l - first_) / width;
    if (!(at > 0)) return 0;
    if (at >= double(counts_.size())) return 1;
    const auto bin = size_t(at);
    return below_[bin] + (at - double(bin)) * (below_[bin + 1] - below_[bin]);
  }

  void accumulate() {
    below_.assign(counts_.size() + 1, 0);
    for (size_t i = 0; i < counts_.size(); ++i) below_[i + 1] = below_[i] + counts_[i];
    total_ = below_.back();
    if (total_ > 0)
      for (double& b : below_) b /= total_;
  }

  /// Cuts off the counts above the ceiling. False: almost nothing is left.
  bool trim(Ceiling ceiling) {
    const double all = total_;
    for (int i = 0; i < 1000; ++i) {
      if (total_ < least_left * all) return false;
      double cut = 0;
      for (size_t bin = 0; bin < counts_.size(); ++bin) {
        const double l = first_ + (double(bin) + 0.5) * width;
        double slope = 1;
        if (ceiling == Ceiling::human) {
          const double scene = std::exp(l), display = displayed(scene);
          slope = just_noticeable(display) / display / (just_noticeable(scene) / scene);
        }
        const double most = slope * total_ * width / range_;
        cut += std::max(0.0, counts_[bin] - most);
        counts_[bin] = std::min(counts_[bin], most);
      }
      const bool little = cut <= little_cut * total_;
      accumulate();
      if (little) break;
    }
    return true;
  }

  double low_, range_, first_ = 0, total_ = 0;
  double factor_ = 0;                   ///< multiplies the luminance; 0: the histogram's curve is used
  std::vector<double> counts_, below_;  ///< counts of the bins; cumulative share below the beginning of each bin
};

/// Adaptation luminances: the means of luminance [cd/m^2] over squares of `side` pixels, without black squares.
std::vector<double> adaptations(const Image& xyz, int side, double scale) {
  constexpr double dimmest = 1e-4;  // [cd/m^2]; less is invisible
  std::vector<double> all;
  for (int y = 0; y < xyz.height; y += side)
    for (int x = 0; x < xyz.width; x += side) {
      double sum = 0;
      int count = 0;
      for (int j = y; j < std::min(y + side, xyz.height); ++j)
        for (int i = x; i < std::min(x + side, xyz.width); ++i, ++count) sum += std::max(0.0, xyz.at(i, j, 1));
      if (sum > 0) all.push_back(std::max(dimmest, scale * sum / count));
    }
  return all;
}

class WardHistogramToneMap final : public ExposedToneMap {
  Histogram::Ceiling ceiling = Histogram::Ceiling::human;
  float display_maximum = 100, display_minimum = 1;
  float degrees = 40;

 public:
  WardHistogramToneMap() { exposure = Exposure::fixed; }
  static void describe(Description<WardHistogramToneMap>& d) {
    d.summary(
         "Gives each luminance as much of the display's range as there is of it in the picture, without showing more contrast "
         "than an eye would see there. It takes luminances as they are, in cd/m^2: a night is dark and flat. Colours are kept "
         "as by ReinhardToneMap.",
         "Ward Larson, Rushmeier & Piatko 1997, A visibility matching tone reproduction operator for high dynamic range scenes")
        .group("Curve")
        .member<&WardHistogramToneMap::ceiling>("ceiling", "",
                                                "most contrast shown: human, what an eye sees; linear, that of the scene; "
                                                "unlimited, histogram equalization",
                                                choices("human", "linear", "unlimited"), Effect::retone)
        .group("Display")
        .member<&WardHistogramToneMap::display_maximum>("display_maximum", "cd/m^2", "luminance of the display's white",
                                                        range(1, 1e5), Effect::retone, soft(50, 2000), logarithmic)
        .member<&WardHistogramToneMap::display_minimum>("display_minimum", "cd/m^2", "luminance of the display's black",
                                                        range(0.0001, 1e4), Effect::retone, soft(0.001, 10), logarithmic)
        .member<&WardHistogramToneMap::degrees>("degrees", "deg",
                                                "angle across which the picture is seen; an eye adapts to the mean over one",
                                                range(1, 180), Effect::retone, soft(10, 120));
  }

  void prepare() override {
    if (!(display_maximum >= 2 * display_minimum)) fail("display_maximum", "must be at least twice the minimum");
  }

 protected:
  void develop(Image& xyz) const override {
    const double candelas = 683 * observer_y_integral();  // [cd/m^2] of Y = 1
    const double low = double(display_minimum), high = double(display_maximum);
    const int side = std::max(1, int(std::lround(double(xyz.width) / double(degrees))));
    const Histogram histogram(adaptations(xyz, side, candelas), low, high, ceiling);
    for (size_t i = 0; i + 2 < xyz.values.size(); i += 3) {
      double* v = &xyz.values[i];
      // The display's black is always present, so the displayed light is what is added to it.
      const double shown = v[1] > 0 ? (histogram.displayed(candelas * v[1]) - low) / (high - low) : 0;
      const double scale = shown > 0 ? std::min(shown, 1.0) / v[1] : 0;
      for (int c = 0; c < 3; ++c) v[c] *= scale;
    }
    draw_into_gamut(xyz, rgb_space(color_space));
  }
};

static const Register<WardHistogramToneMap> registered;

}  // namespace
}  // namespace etendue
