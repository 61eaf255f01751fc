#include "etendue/exposed_tone_map.h"

#include <fmt/format.h>

#include <array>
#include <bit>

#include "luminance.h"

namespace etendue {
namespace {

// The automatic exposure maps the log-average luminance to middle grey, as a light meter does, with three modifications.
//
// Dark pixels. Lit objects in front of an almost black background should be as bright as in front of another background. Each
// pixel has the weight
//   w = 1 / (1 + (F / L)^2),   F = 2^-7 L_p,
// where L_p is the luminance that `percentile` percent of the lit pixels do not exceed: pixels far below F have almost no
// weight, and the weights change continuously with the pixels' values.
//
// Bright pixels. Luminances are limited to the one that `percentile` percent by weight do not exceed: lamps, their mirror
// images and fireflies illuminate a scene, but are not what is illuminated.
//
// Scenes that are bright or dark by nature. Snow should not become grey. Reinhard (2003, Parameter estimation for photographic
// tone reproduction, equation 4) shifts the key by the position of the mean between the darkest and the brightest luminance:
//   key = key_0 4^f,   f = (2 log L_mean - log L_low - log L_high) / (log L_high - log L_low).
// Instead of the minimum and the maximum, L_low and L_high are here the mean logarithms of the darkest and of the brightest
// tenth by weight, so that single pixels do not decide.
//
// key_0 = 0.5^2.2 = 0.22: half the code values of a display.
constexpr double floor_below = 0x1p-7, tenth = 0.1;
const double key_light = std::pow(0.5, 2.2);

/// A pixel's share of all weight, and the binary logarithm of its luminance.
struct Metered {
  double logarithm, share;
};

/// Sorts positive numbers up to relative differences of a millionth, by a radix sort of their first 33 bits: three digits of
/// 11 bits, the lowest first (positive doubles are ordered as their bits are). It takes a tenth of the time of std::sort for
/// the pixels of a picture; panels update the picture while a setting is being changed.
void sort_nearly(std::vector<double>& numbers) {
  constexpr int digit = 11, digits = 3;
  constexpr std::uint64_t mask = (1 << digit) - 1;
  std::vector<double> other(numbers.size());
  for (int d = 0; d < digits; ++d) {
    const auto place = [&](double x) { return (std::bit_cast<std::uint64_t>(x) >> (31 + d * digit)) & mask; };
    std::array<size_t, mask + 2> begin{};
    for (const double x : numbers) ++begin[place(x) + 1];
    for (size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
    for (const double x : numbers) other[begin[place(x)]++] = x;
    numbers.swap(other);
  }
}

/// The mean of the logarithms, given in increasing order, over the interval [from, to] of their cumulative shares, which sum
/// to 1.
double mean_between(const std::vector<Metered>& all, double from, double to) {
  double below = 0, sum = 0, share = 0;
  for (const Metered& m : all) {
    const double inside = std::min(below + m.share, to) - std::max(below, from);
    if (inside > 0) {
      sum += inside * m.logarithm;
      share += inside;
    }
    below += m.share;
  }
  return share > 0 ? sum / share : all.back().logarithm;
}

double automatic_factor(const Image& xyz, double percentile) {
  std::vector<double> luminances = positive_luminances(xyz);
  if (luminances.empty()) return 1;
  sort_nearly(luminances);
  const double floor = floor_below * luminances[rank_of(luminances.size(), percentile)];
  std::vector<Metered> all;
  all.reserve(luminances.size());
  double total = 0;
  for (const double l : luminances) {
    const double ratio = floor / l, weight = 1 / (1 + ratio * ratio);
    total += weight;
    all.push_back({std::log2(l), weight});
  }
  double mean = 0, share = 0, most = all.back().logarithm;
  for (Metered& m : all) {
    if (share < percentile / 100) most = m.logarithm;
    m.share /= total;
    m.logarithm = std::min(m.logarithm, most);
    mean += m.share * m.logarithm;
    share += m.share;
  }
  const double low = mean_between(all, 0, tenth), high = mean_between(all, 1 - tenth, 1);
  const double f = high - low > 1e-6 ? std::clamp((2 * mean - low - high) / (high - low), -1.0, 1.0) : 0;
  return key_light * std::exp2(2 * f - mean);
}

}  // namespace

void ExposedToneMap::describe(Description<ExposedToneMap>& d) {
  d.summary(
       "Tone maps that begin with an exposure, as a camera does: the picture is multiplied so that middle grey is 0.18. What "
       "was found automatically is written into the file as 'exposure'. Pieces of one picture and pictures of a film each "
       "find their own: give them one that is fixed.")
      .group("Exposure")
      .member<&ExposedToneMap::exposure>("exposure", "",
                                         "automatic: from the lit pixels' mean logarithm of luminance; lamps, fireflies and "
                                         "a black background change it little. fixed: as stops say",
                                         choices("automatic", "fixed"), Effect::retone)
      .member<&ExposedToneMap::stops>("stops", "1",
                                      "each doubles the light: added to what is automatic, or alone if fixed (at 0, "
                                      "luminance 1 stays 1)",
                                      range(-64, 64), Effect::retone, soft(-10, 10))
      .member<&ExposedToneMap::percentile>("percentile", "1",
                                           "of automatic exposure: percentage of the pixels with light that lamps and "
                                           "highlights leave; those count as the brightest of the rest, and what is far "
                                           "darker than it does not count",
                                           Range{0, 100, true}, Effect::retone, soft(90, 100), when("exposure", "automatic"));
}

static const Register<ExposedToneMap> registered;

double ExposedToneMap::exposure_factor(const Image& xyz) const {
  const double found = exposure == Exposure::automatic ? automatic_factor(xyz, double(percentile)) : 1;
  return std::clamp(found * std::exp2(double(stops)), 0x1p-300, 0x1p300);
}

void ExposedToneMap::map(Image& xyz) const {
  constexpr double most = 1e30;
  const double factor = exposure_factor(xyz);
  for (double& v : xyz.values) v = std::isnan(v) ? 0 : std::clamp(v * factor, -most, most);
  xyz.metadata.erase("exposure");
  if (exposure == Exposure::automatic) xyz.metadata["exposure"] = fmt::format("{:.2f} stops", std::log2(factor));
  develop(xyz);
}

}  // namespace etendue
