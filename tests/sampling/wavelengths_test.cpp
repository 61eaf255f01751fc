// Wavelength samplers and the estimate of XYZ from the few wavelengths of a path.

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include "etendue/describe/color.h"
#include "etendue/describe/registry.h"
#include "etendue/wavelength_sampler.h"

namespace etendue {
namespace {

Ref<WavelengthSampler> make_sampler(const char* name, const std::map<std::string, Value>& members = {}) {
  const Ref<Component> c = Registry::instance().create(name);
  for (const auto& [member, value] : members) set(*c, member, value);
  prepare_tree(*c);
  return ref_cast<WavelengthSampler>(c);
}
Value number(double x) { return Value(Number{x}); }

std::vector<std::pair<const char*, Color>> light() {
  return {{"flat", flat_spectrum(1)},
          {"D65", illuminant_spectrum("D65")},
          {"F11", illuminant_spectrum("F11")},
          {"rgb", rgb_color("srgb", 0.8, 0.2, 0.05)},
          {"black body", scaled_spectrum(1e-3, blackbody_spectrum(3000))},
          {"line", table_spectrum({505, 510, 515}, {0, 40, 0})}};
}

/// The expected value of the estimate, by the midpoint rule at 0.1 nm.
Xyz integral(const SpectralFunction& s, double low, double high) {
  Xyz sum;
  for (double w = low + 0.05; w < high; w += 0.1)
    sum += 0.1 / observer_y_integral() * double(s.at(float(w), ColorUse::radiance)) * observer(float(w));
  return sum;
}

struct Mean {
  double sum = 0, squares = 0;
  int n = 0;
  void add(double x) {
    sum += x;
    squares += x * x;
    ++n;
  }
  double mean() const { return sum / n; }
  double error() const { return std::sqrt(std::max(0.0, squares / n - mean() * mean()) / n); }
};

/// A z-test of the estimate of X, Y and Z against the integral, with all wavelengths and with the hero alone. 36 comparisons
/// for each sampler at 4.5 standard errors: a correct sampler fails with probability 2.5e-4, and, as the seed is fixed, always
/// or never.
void expect_unbiased(const WavelengthSampler& sampler, double low, double high) {
  constexpr int samples = 40000;
  for (const auto& [name, color] : light()) {
    const Xyz expected = integral(*color, low, high);
    for (const bool single : {false, true}) {
      std::mt19937 random(7);
      Mean mean[3];
      for (int i = 0; i < samples; ++i) {
        Wavelengths w = sampler.sample({1, i, 0, std::uint32_t(i % 16)}, to_unit_float(std::uint32_t(random())));
        const Spectrum s = color->evaluate(w, ColorUse::radiance);
        const Xyz c = to_xyz(single ? w.drop_secondary() * s : s, w);
        mean[0].add(c.x);
        mean[1].add(c.y);
        mean[2].add(c.z);
      }
      const double exact[3] = {expected.x, expected.y, expected.z};
      // The additional thousandth of a per cent is for rounding where all samples agree.
      for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(mean[i].mean(), exact[i], 4.5 * mean[i].error() + 1e-5 * exact[i])
            << name << " component " << i << " single " << single;
    }
  }
}

TEST(HeroWavelengths, EstimateIsUnbiased) {
  expect_unbiased(*make_sampler("HeroWavelengths"), 360, 830);
  expect_unbiased(*make_sampler("HeroWavelengths", {{"distribution", Value(std::string("uniform"))}}), 360, 830);
  expect_unbiased(*make_sampler("HeroWavelengths", {{"low", number(420)}, {"high", number(680)}}), 420, 680);
}

TEST(HeroWavelengths, DensityIsThatOfTheDistribution) {
  // E[1/p] is the length of the range; p itself is near 1/cosh^2 over its integral.
  const auto sampler = make_sampler("HeroWavelengths");
  Mean inverse;
  const auto shape = [](double w) { return std::pow(std::cosh(0.0072 * (w - 538)), -2); };
  double norm = 0;
  for (double w = 360.5; w < 830; ++w) norm += shape(w);
  for (int i = 0; i < 1024 * 64; ++i) {
    const Wavelengths w = sampler->sample({}, (float(i) + 0.5f) / (1024 * 64));
    for (int k = 0; k < spectrum_size; ++k) {
      EXPECT_GE(w[k], 360);
      EXPECT_LE(w[k], 830);
      inverse.add(1 / double(w.pdf(k)));
      EXPECT_NEAR(w.pdf(k) * norm / shape(double(w[k])), 1, 0.035);  // constant within a cell, 4 nm wide at the red end
    }
  }
  EXPECT_NEAR(inverse.mean(), 470, 0.01);
}

TEST(HeroWavelengths, SpreadsTheOthers) {
  const auto sampler = make_sampler("HeroWavelengths", {{"distribution", Value(std::string("uniform"))}});
  const Wavelengths w = sampler->sample({}, 0.3f);
  for (int i = 0; i < spectrum_size; ++i) {
    const double u = std::fmod(0.3 + double(i) / spectrum_size, 1.0);
    EXPECT_NEAR(w[i], 360 + 470 * u, 1e-3);
    EXPECT_NEAR(w.pdf(i), 1 / 470.0, 1e-7);
  }
  for (const float u : {0.0f, one_minus_epsilon, 1.0f}) EXPECT_TRUE(sampler->sample({}, u)[0] <= 830);
}

TEST(GridWavelengths, EstimateIsUnbiased) {
  // Over random pixels, against the limit of the Riemann sum: the grid is so fine that the sum is the integral.
  expect_unbiased(*make_sampler("GridWavelengths", {{"count", number(1880)}}), 360, 830);
}

TEST(GridWavelengths, EveryPointIsUsedEqually) {
  for (const int count : {40, 42, 7, 4, 3, 1}) {
    const auto sampler =
        make_sampler("GridWavelengths", {{"count", number(count)}, {"low", number(400)}, {"high", number(700)}});
    for (const std::uint32_t first : {0u, 13u}) {
      std::map<float, int> used, heroes;
      std::map<std::string, Xyz> sums;
      for (int i = 0; i < count; ++i) {
        const Wavelengths w = sampler->sample({5, 3, 9, first + std::uint32_t(i)}, 0.5f);
        ++heroes[w.hero()];
        for (int k = 0; k < spectrum_size; ++k) {
          ++used[w[k]];
          EXPECT_FLOAT_EQ(w.pdf(k), 1 / 300.0f);
        }
        for (const auto& [name, color] : light()) sums[name] += 1.0 / count * to_xyz(color->evaluate(w, ColorUse::radiance), w);
      }
      EXPECT_EQ(int(heroes.size()), count);
      EXPECT_EQ(int(used.size()), count);
      for (const auto& [wavelength, times] : used) EXPECT_EQ(times, spectrum_size) << count;
      // One round of samples gives exactly the Riemann sum over the cells.
      for (const auto& [name, color] : light()) {
        Xyz expected;
        for (const auto& [w, times] : used)
          expected += 300.0 / count / observer_y_integral() * double(color->at(w, ColorUse::radiance)) * observer(w);
        EXPECT_NEAR(sums[name].y, expected.y, 1e-4 * expected.y + 1e-6) << name << count;
      }
    }
  }
}

TEST(GridWavelengths, QuarterRoundUsesEveryPointOnce) {
  const auto sampler = make_sampler("GridWavelengths", {{"count", number(10 * spectrum_size)}});
  std::map<float, int> used;
  for (std::uint32_t i = 0; i < 10; ++i) {
    const Wavelengths w = sampler->sample({5, 3, 9, 100 + i}, 0);
    for (int k = 0; k < spectrum_size; ++k) ++used[w[k]];
  }
  EXPECT_EQ(int(used.size()), 10 * spectrum_size);
}

TEST(WavelengthSamplers, RefuseAnEmptyRange) {
  for (const char* name : {"HeroWavelengths", "GridWavelengths"}) {
    EXPECT_THROW(make_sampler(name, {{"low", number(600)}, {"high", number(600)}}), Error);
    EXPECT_THROW(make_sampler(name, {{"low", number(300)}}), Error);
    EXPECT_THROW(make_sampler(name, {{"high", number(900)}}), Error);
  }
  EXPECT_THROW(make_sampler("GridWavelengths", {{"count", number(0)}}), Error);
}

TEST(SpectrumXyz, OfOneWavelength) {
  Wavelengths w;
  w.place(0, 555.25f, 0.5f);
  const Xyz c = to_xyz(Spectrum(3), w);
  const double scale = 3 / (0.5 * spectrum_size * observer_y_integral());
  EXPECT_NEAR(c.x, scale * observer(555.25f).x, 1e-8);
  EXPECT_NEAR(c.y, scale * observer(555.25f).y, 1e-8);
  EXPECT_NEAR(c.z, scale * observer(555.25f).z, 1e-8);
}

}  // namespace
}  // namespace etendue
