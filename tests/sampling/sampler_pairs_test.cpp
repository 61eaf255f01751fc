// Samplers: pairs of neighbouring dimensions, pairs across dimensions, samples with high indices, and the distributions of
// wavelengths.

#include <gtest/gtest.h>

#include <set>

#include "etendue/describe/color.h"
#include "etendue/sampler.h"
#include "etendue/wavelength_sampler.h"
#include "support/component_test_support.h"

namespace etendue {
namespace {

using test::create;

const std::vector<std::string> samplers = {"SobolSampler",        "IndependentSampler", "HaltonSampler",     "LatticeSampler",
                                           "PairsInQuadsSampler", "Pmj02Sampler",       "StratifiedSampler", "ZSobolSampler"};

/// A chi-square test of pairs of numbers in n x n cells. Padded dimensions of well-distributed points are uniform in coarse
/// cells but show their strata in fine ones, so only independent numbers are tested with fine cells.
void expect_even(const std::string& what, const std::function<Point2(int)>& pair, int count, double significance) {
  const bool independent = what.starts_with("Independent");
  const size_t n = independent ? 64 : 16;
  std::vector<double> counts(n * n), expected(n * n, double(count) / double(n * n));
  for (int i = 0; i < count; ++i) {
    const Point2 p = pair(i);
    ASSERT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1);
    ++counts[size_t(p.x * float(n)) * n + size_t(p.y * float(n))];
  }
  // Nested orders of the points are fewer than all orders, so that in one pixel of a hundred they are as uneven as independent
  // numbers are in one of millions.
  EXPECT_GT(test::chi_square(counts, expected), independent ? significance : 1e-16) << what;
}

// Any two numbers of a sample fill the square evenly, over the samples of a pixel and over the pixels: the numbers of one pair,
// of two adjacent dimensions, and the first and second numbers of two pairs, near and far apart.
TEST(SamplerPairs, TwoNumbersOfASampleFillTheSquare) {
  constexpr int count = 32768;
  const double significance = test::each_of(2 * 60);
  for (const std::string& name : samplers) {
    const Ref<Sampler> s = create<Sampler>(name);
    for (const bool over_pixels : {false, true}) {
      const auto key = [&](int i) {
        return over_pixels ? SampleKey(3, i % 256, i / 256, 5) : SampleKey(3, 17, 40, std::uint32_t(i));
      };
      for (const std::uint32_t d : {0u, 1u, 2u, 3u, 6u, 7u, 13u, 100u, 1u << 20, 3u << 20}) {
        const std::string where = name + (over_pixels ? " over pixels, " : ", ") + std::to_string(d);
        expect_even(where + ": a pair", [&](int i) { return s->pair(key(i), d); }, count, significance);
        expect_even(
            where + ": numbers side by side", [&](int i) { return Point2{s->number(key(i), d), s->number(key(i), d + 1)}; },
            count, significance);
        expect_even(
            where + ": a number and a pair's first",
            [&](int i) { return Point2{s->number(key(i), d), s->pair(key(i), d + 1).x}; }, count, significance);
        expect_even(
            where + ": first numbers of two pairs",
            [&](int i) { return Point2{s->pair(key(i), d).x, s->pair(key(i), d + 2).x}; }, count, significance);
        expect_even(
            where + ": second and first", [&](int i) { return Point2{s->pair(key(i), d).y, s->pair(key(i), d + 2).x}; }, count,
            significance);
        expect_even(
            where + ": second numbers of two pairs",
            [&](int i) { return Point2{s->pair(key(i), d).y, s->pair(key(i), d + 2).y}; }, count, significance);
      }
    }
  }
}

TEST(SamplerPairs, TwoPairsAtOnceAreThoseOneByOne) {
  for (const std::string& name : samplers) {
    const Ref<Sampler> s = create<Sampler>(name);
    for (std::uint32_t n = 0; n < 400; ++n) {
      const SampleKey key(n, int(n) * 3, int(n), n * 7919);
      const auto both = s->two_pairs(key, n, n + 5);
      EXPECT_EQ(both.first, s->pair(key, n));
      EXPECT_EQ(both.second, s->pair(key, n + 5));
    }
  }
}

// Points with high indices are as well distributed as the first ones, and differ from them: each aligned block of 2^k has one
// point in each strip.
TEST(SamplerPairs, HighSampleNumbers) {
  const Ref<Sampler> s = create<Sampler>("SobolSampler");
  for (const std::uint32_t begin : {0u, 1u << 16, 3u << 17, 1u << 24, 0x80000000u, 0xfffffc00u}) {
    constexpr int count = 1024;
    for (const std::uint32_t d : {0u, 7u}) {
      std::vector<int> numbers(count), first(count), second(count);
      std::vector<std::vector<int>> intervals(11, std::vector<int>(count));
      for (std::uint32_t i = 0; i < count; ++i) {
        const SampleKey key(1, 4, 9, begin + i);
        const Point2 p = s->pair(key, d);
        ++numbers[size_t(s->number(key, d) * count)];
        for (size_t k = 0; k <= 10; ++k) {
          const size_t columns = size_t(1) << k, rows = count / columns;
          ++intervals[k][size_t(p.x * float(columns)) * rows + size_t(p.y * float(rows))];
        }
      }
      for (int i = 0; i < count; ++i) {
        EXPECT_EQ(numbers[size_t(i)], 1) << begin << " " << d;
        for (size_t k = 0; k <= 10; ++k) EXPECT_EQ(intervals[k][size_t(i)], 1) << begin << " " << d << " " << k;
      }
      if (HasFailure()) return;
    }
  }
  // Also for very many points: the second coordinate's matrix is Pascal's triangle beyond its first 16 rows.
  for (const std::uint32_t begin : {0u, 1u << 20}) {
    constexpr size_t bits = 17, count = size_t(1) << bits;
    for (const size_t k : {size_t(1), size_t(5), size_t(9), size_t(12), size_t(16)}) {
      std::vector<bool> taken(count);
      size_t twice = 0;
      for (std::uint32_t i = 0; i < count; ++i) {
        const Point2 p = s->pair(SampleKey(1, 4, 9, begin + i), 2);
        const size_t columns = size_t(1) << k, rows = count / columns;
        const size_t cell = size_t(p.x * float(columns)) * rows + size_t(p.y * float(rows));
        twice += taken[cell];
        taken[cell] = true;
      }
      EXPECT_EQ(twice, 0u) << begin << " " << k;
    }
  }
  // No point of one block is a point of another, except by chance: few of 4096 floats are equal.
  for (const std::string& name : samplers) {
    const Ref<Sampler> sampler = create<Sampler>(name);
    std::set<float> seen;
    for (const std::uint32_t begin : {0u, 1u << 16, 1u << 20, 1u << 28})
      for (std::uint32_t i = 0; i < 1024; ++i) seen.insert(sampler->number(SampleKey(1, 4, 9, begin + i), 3));
    EXPECT_GT(seen.size(), 4080u) << name;
  }
}

// The two numbers of a pair are scrambled independently. Of an aligned block of four points, two lie in the halves where the
// first digits of x and y agree. For each of these two, the second digits of x and y agree or not; with independent scramblings
// (Owen 1995) both do the same with probability 1/2, with a common scrambling of x and y the result is the same for all pixels.
TEST(SamplerPairs, BothNumbersAreScrambledOnTheirOwn) {
  const Ref<Sampler> s = create<Sampler>("SobolSampler");
  for (const std::uint32_t begin : {0u, 4096u})
    for (const bool agreeing : {false, true}) {
      constexpr int count = 4096;
      int alike = 0;
      for (int i = 0; i < count; ++i) {
        int found = 0, parity = 0;
        for (std::uint32_t k = 0; k < 4; ++k) {
          const Point2 p = s->pair(SampleKey(1, i % 64, i / 64, begin + k), 4);
          const int x = int(4 * p.x), y = int(4 * p.y);
          if ((x / 2 == y / 2) != agreeing) continue;
          ++found;
          parity ^= (x ^ y) & 1;
        }
        ASSERT_EQ(found, 2);
        alike += parity == 0;
      }
      EXPECT_NEAR(alike, count / 2, 4.5 * std::sqrt(count) / 2) << begin << " " << agreeing;
    }
}

// Samples do not share numbers, in whatever dimensions.
TEST(SamplerPairs, NumbersAreNotSharedBetweenSamplesAndDimensions) {
  for (const std::string& name : samplers) {
    const Ref<Sampler> s = create<Sampler>(name);
    std::set<float> seen;
    for (std::uint32_t n = 0; n < 64; ++n)
      for (std::uint32_t d = 0; d < 64; ++d) seen.insert(s->number(SampleKey(2, 5, 6, n), d));
    EXPECT_GT(seen.size(), 4085u) << name;
    std::set<std::pair<float, float>> pairs;
    for (std::uint32_t n = 0; n < 64; ++n)
      for (std::uint32_t d = 0; d < 64; ++d) {
        const Point2 p = s->pair(SampleKey(2, 5, 6, n), d);
        pairs.insert({p.x, p.y});
        EXPECT_GT(std::abs(p.x - p.y), 0) << name;
      }
    EXPECT_EQ(pairs.size(), 4096u) << name;
  }
}

// ---- wavelengths
// -----------------------------------------------------------------------------------------------------------------

// Radziszewski et al. 2009: p is proportional to 1 / cosh^2(0.0072 (lambda - 538)).
TEST(WavelengthNumbers, VisibleDistributionIsThePapersAlsoWhenCut) {
  const struct {
    double low, high;
  } ranges[] = {{360, 830}, {450, 700}, {500, 830}};
  for (const auto& r : ranges) {
    const Ref<WavelengthSampler> s = create<WavelengthSampler>("HeroWavelengths", {{"low", r.low}, {"high", r.high}});
    double norm = 0;
    for (double l = r.low + 0.05; l < r.high; l += 0.1) norm += 0.1 / std::pow(std::cosh(0.0072 * (l - 538)), 2);
    for (int i = 0; i < 200; ++i) {
      const Wavelengths w = s->sample(SampleKey(1, 2, 3, std::uint32_t(i)), (float(i) + 0.5f) / 200);
      for (int k = 0; k < spectrum_size; ++k) {
        EXPECT_GE(double(w[k]), r.low);
        EXPECT_LE(double(w[k]), r.high);
        const double p = 1 / std::pow(std::cosh(0.0072 * (double(w[k]) - 538)), 2) / norm;
        EXPECT_NEAR(double(w.pdf(k)), p, 3e-3 * p + 8e-6) << w[k];
      }
    }
    // Samples follow that pdf: the fraction u of it lies below the wavelength of u.
    for (const float u : {0.1f, 0.5f, 0.9f}) {
      const double l = double(s->sample(SampleKey(1, 2, 3, 0), u).hero());
      double below = 0;
      for (double x = r.low + 0.05; x < l; x += 0.1) below += 0.1 / std::pow(std::cosh(0.0072 * (x - 538)), 2) / norm;
      EXPECT_NEAR(below, double(u), 2e-3);
    }
  }
  const Ref<WavelengthSampler> uniform =
      create<WavelengthSampler>("HeroWavelengths", {{"low", 400.0}, {"high", 700.0}, {"distribution", "uniform"}});
  const Wavelengths w = uniform->sample(SampleKey(1, 2, 3, 0), 0.125f);
  for (int k = 0; k < spectrum_size; ++k) {
    EXPECT_NEAR(w.pdf(k), 1 / 300.0f, 1e-6f);
    double expected = 400 + 300 * (0.125 + double(k) / spectrum_size);
    if (expected >= 700) expected -= 300;
    EXPECT_NEAR(double(w[k]), expected, 0.02);
  }
}

TEST(WavelengthNumbers, GridTakesCentresOfItsCellsEvenlyApart) {
  const Ref<WavelengthSampler> s =
      create<WavelengthSampler>("GridWavelengths", {{"count", 16.0}, {"low", 400.0}, {"high", 720.0}});
  std::map<int, int> counts;
  for (std::uint32_t i = 0; i < 16; ++i) {
    const Wavelengths w = s->sample(SampleKey(1, 2, 3, i), 0);
    for (int k = 0; k < spectrum_size; ++k) {
      const double cell = (double(w[k]) - 410) / 20;
      EXPECT_NEAR(cell, std::round(cell), 1e-4);
      ++counts[int(std::lround(cell))];
      EXPECT_NEAR(w.pdf(k), 1 / 320.0f, 1e-7f);
      double apart = double(w[k]) - double(w[0]);
      if (apart < 0) apart += 320;
      EXPECT_NEAR(apart, 320.0 / spectrum_size * k, 1e-3);
    }
  }
  EXPECT_EQ(counts.size(), 16u);
  for (const auto& [cell, count] : counts) EXPECT_EQ(count, spectrum_size) << cell;
}

}  // namespace
}  // namespace etendue
