// Samplers and light samplers: uniformity, stratification, independence, reproducibility, probabilities.

#include "etendue/sampler.h"

#include <set>

#include "etendue/light_sampler.h"
#include "support/component_test_support.h"

namespace etendue {
namespace {

using test::create;

const char* const names[] = {"IndependentSampler",  "SobolSampler", "HaltonSampler",     "LatticeSampler",
                             "PairsInQuadsSampler", "Pmj02Sampler", "StratifiedSampler", "ZSobolSampler"};

TEST(Sampler, UniformOverDimensionsAndPixels) {
  const double significance = test::each_of(2 * std::size(names));
  for (const char* name : names) {
    const Ref<Sampler> sampler = create<Sampler>(name);
    // One number from each of many pixels and dimensions: independent samples for all samplers.
    constexpr size_t bins = 16, count = 100000;
    std::vector<double> single(bins), pairs(bins * bins);
    for (size_t i = 0; i < count; ++i) {
      const SampleKey key(7, int(i % 317), int(i / 317), std::uint32_t(i % 13));
      const std::uint32_t dimension = std::uint32_t(i % 29);
      const float x = sampler->number(key, dimension);
      const Point2 p = sampler->pair(key, dimension + 100);
      ASSERT_TRUE(x >= 0 && x < 1 && p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1);
      ++single[size_t(x * bins)];
      ++pairs[size_t(p.x * bins) * bins + size_t(p.y * bins)];
    }
    EXPECT_GT(test::chi_square(single, std::vector<double>(bins, double(count) / bins)), significance) << name;
    EXPECT_GT(test::chi_square(pairs, std::vector<double>(bins * bins, double(count) / (bins * bins))), significance) << name;
  }
}

// Two pairs of dimensions of the same samples, and the same dimensions of neighbouring pixels, must be independent.
TEST(Sampler, DimensionsAndPixelsAreIndependent) {
  const double significance = test::each_of(3 * std::size(names));
  for (const char* name : names) {
    const Ref<Sampler> sampler = create<Sampler>(name);
    constexpr size_t bins = 8, samples = 16, pixels = 2000;
    std::vector<double> dimensions(bins * bins), neighbours(bins * bins), seeds(bins * bins);
    for (size_t pixel = 0; pixel < pixels; ++pixel)
      for (size_t i = 0; i < samples; ++i) {
        // Only a few samples of each pixel: otherwise stratification would make the counts too even.
        if (mix_bits(pixel * samples + i) % 8) continue;
        const SampleKey key(1, int(pixel), 5, std::uint32_t(i)), below(1, int(pixel), 6, std::uint32_t(i)),
            other(2, int(pixel), 5, std::uint32_t(i));
        const auto bin = [](float x) { return size_t(x * bins); };
        const float x = sampler->pair(key, 0).x;
        ++dimensions[bin(x) * bins + bin(sampler->pair(key, 2).x)];
        ++neighbours[bin(x) * bins + bin(sampler->pair(below, 0).x)];
        ++seeds[bin(x) * bins + bin(sampler->pair(other, 0).x)];
      }
    for (const auto* counts : {&dimensions, &neighbours, &seeds}) {
      double total = 0;
      for (const double c : *counts) total += c;
      EXPECT_GT(test::chi_square(*counts, std::vector<double>(bins * bins, total / (bins * bins))), significance) << name;
    }
  }
}

// Also within a pixel: the mean squared correlation of n independent numbers is 1 / (n - 1), 0.067 here; under truly random
// nested permutations it is 0.099, as they are fewer than all permutations. Points with the same order in two dimensions would
// have more than 0.5, whatever their scrambling: as HaltonSampler's have in one dimension of two pixels, where it does no harm.
TEST(Sampler, SamplesOfAPixelAreShuffledBetweenDimensions) {
  constexpr int pixels = 2000, n = 16;
  for (const char* name : names) {
    const Ref<Sampler> sampler = create<Sampler>(name);
    double squares[3] = {};
    for (int pixel = 0; pixel < pixels; ++pixel) {
      double sums[4] = {}, products[3] = {}, own[4] = {};
      for (std::uint32_t i = 0; i < n; ++i) {
        const SampleKey key(5, pixel, 0, i), below(5, pixel, 1, i);
        const double x[4] = {double(sampler->pair(key, 0).x), double(sampler->pair(key, 2).x), double(sampler->number(key, 5)),
                             double(sampler->pair(below, 0).x)};
        for (size_t k = 0; k < 4; ++k) {
          sums[k] += x[k] / n;
          own[k] += x[k] * x[k] / n;
          if (k > 0) products[k - 1] += x[0] * x[k] / n;
        }
      }
      for (size_t k = 0; k < 3; ++k) {
        const double covariance = products[k] - sums[0] * sums[k + 1];
        squares[k] +=
            covariance * covariance / ((own[0] - sums[0] * sums[0]) * (own[k + 1] - sums[k + 1] * sums[k + 1])) / pixels;
      }
    }
    // The standard error of the mean of so many squares is 0.002. Orders of other kinds lie between; prime bases that differ
    // are stratified together, and so less correlated than independent numbers.
    const std::string sampler_name = name;
    const bool independent = sampler_name == "IndependentSampler", halton = sampler_name == "HaltonSampler";
    for (size_t k = 0; k < (halton ? 2 : 3); ++k) {
      if (independent || sampler_name == "SobolSampler")
        EXPECT_NEAR(squares[k], independent ? 1.0 / (n - 1) : 0.099, 0.01) << name;
      else
        EXPECT_LT(squares[k], 0.11) << name;
    }
  }
}

TEST(Sampler, SameArgumentsGiveSameNumbers) {
  for (const char* name : names) {
    const Ref<Sampler> one = create<Sampler>(name), two = create<Sampler>(name);
    std::set<float> different;
    for (std::uint32_t i = 0; i < 100; ++i) {
      const SampleKey key(3, 10, 20, i);
      EXPECT_EQ(one->pair(key, 4), two->pair(key, 4));
      EXPECT_EQ(one->number(key, 4), two->number(key, 4));
      different.insert(one->number(key, 4));
    }
    EXPECT_GT(different.size(), 95u) << name;
    NumberStream stream(*one, SampleKey(3, 10, 20, 5));
    NumberStream again = stream;
    const Point2 first = stream.next_pair();
    const float second = stream.next();
    EXPECT_EQ(again.next_pair(), first);
    EXPECT_EQ(again.next(), second);
    EXPECT_EQ(again.count(), 3u);
    // Streams forked under other names have their own numbers, whatever was drawn before.
    NumberStream other = stream.fork("other"), same = NumberStream(*one, SampleKey(3, 10, 20, 5)).fork("other");
    const Point2 others = other.next_pair();
    EXPECT_EQ(same.next_pair(), others);
    EXPECT_NE(others, first);
    EXPECT_NE(stream.fork("other", 1).next_pair(), others);
  }
}

TEST(Sampler, NumbersOfABounceAreThoseAskedForOneByOne) {
  for (const char* name : names) {
    const Ref<Sampler> sampler = create<Sampler>(name);
    for (const bool lights : {false, true})
      for (const bool lobes : {false, true})
        for (std::uint32_t i = 0; i < 100; ++i) {
          NumberStream at_once(*sampler, SampleKey(3, 10, 20, i)), single = at_once;
          at_once.skip(i * 7);
          single.skip(i * 7);
          const NumberStream::Bounce bounce = at_once.next_bounce(lights, lobes);
          const float light_choice = single.next();
          EXPECT_EQ(bounce.light_choice, lights ? light_choice : 0) << name;
          EXPECT_EQ(bounce.light_point, single.next_pair()) << name;
          const float lobe_choice = single.next();
          EXPECT_EQ(bounce.lobe_choice, lobes ? lobe_choice : 0) << name;
          EXPECT_EQ(bounce.direction, single.next_pair()) << name;
          EXPECT_EQ(at_once.count(), single.count());
        }
  }
}

// A (0,2)-sequence: each aligned block of 2^k samples has one point in each elementary interval of area 2^-k.
TEST(SobolSampler, OnePointInEachElementaryInterval) {
  const Ref<Sampler> sampler = create<Sampler>("SobolSampler");
  for (int pixel = 0; pixel < 4; ++pixel)
    for (const std::uint32_t dimension : {0u, 6u, 41u})
      for (int k = 0; k <= 12; ++k) {
        const std::uint32_t count = 1u << k;
        for (const std::uint32_t block : {0u, 5u}) {
          std::vector<Point2> points;
          std::vector<int> line(count);
          for (std::uint32_t i = 0; i < count; ++i) {
            const SampleKey key(11, pixel, 3, block * count + i);
            points.push_back(sampler->pair(key, dimension));
            ++line[size_t(sampler->number(key, dimension) * float(count))];
          }
          for (const int n : line) ASSERT_EQ(n, 1);
          for (int across = 0; across <= k; ++across) {
            const std::uint32_t columns = 1u << across, rows = count / columns;
            std::vector<int> cells(count);
            for (const Point2 p : points) ++cells[size_t(p.x * float(columns)) * rows + size_t(p.y * float(rows))];
            for (const int n : cells) ASSERT_EQ(n, 1) << "2^" << k << " points, " << columns << " columns";
          }
        }
      }
}

// Effect of stratification: the error of a smooth integral falls faster than with independent samples.
TEST(SobolSampler, IntegratesSmoothFunctionsBetter) {
  double errors[2] = {};
  for (int s = 0; s < 2; ++s) {
    const Ref<Sampler> sampler = create<Sampler>(names[s]);
    for (int pixel = 0; pixel < 50; ++pixel) {
      double sum = 0;
      for (std::uint32_t i = 0; i < 256; ++i) {
        const Point2 p = sampler->pair(SampleKey(1, pixel, 0, i), 0);
        sum += double(p.x) * double(p.y);
      }
      errors[s] += std::pow(sum / 256 - 0.25, 2);
    }
  }
  EXPECT_LT(errors[1], errors[0] / 100);
}

// ---- light samplers -------------------------------------------------------------------------------------------------

/// A scene that only lists its objects, without finding any hit.
class ListScene final : public Scene {
 public:
  bool find_nearest(const Ray&, Hit&) const override { return false; }
  bool find_any(const Ray&) const override { return false; }

 protected:
  void build(std::span<const SceneObject* const>) override {}
};

struct Lights {
  Ref<ListScene> scene = make<ListScene>();
  Lights() {
    for (const auto& [edge, watts] : {std::pair(1.0f, 10.0), {2.0f, 60.0}, {1.0f, 30.0}, {1.0f, 0.0}}) {
      auto square = make<test::TestSquare>(edge);
      if (watts > 0) square->emission = create<EmissionShader>("DiffuseEmission", {{"power", watts}});
      scene->objects.push_back(square);
    }
    scene->prepare();
  }
};

TEST(LightSampler, ProbabilitiesSumToOneAndAreKept) {
  const Lights lights;
  ASSERT_EQ(lights.scene->luminaires().size(), 3u);
  for (const char* name : {"UniformLightSampler", "PowerLightSampler"}) {
    const Ref<LightSampler> sampler = create<LightSampler>(name);
    EXPECT_EQ(sampler->choose(0.5f).luminaire, nullptr);
    sampler->build(*lights.scene);
    double sum = 0;
    std::vector<double> expected, counts(3);
    constexpr int count = 10000;
    for (const SceneObject* l : lights.scene->luminaires()) {
      sum += double(sampler->probability(*l)) / 2 + double(sampler->probability({}, {}, *l)) / 2;
      expected.push_back(count * double(sampler->probability({}, {}, *l)));
    }
    EXPECT_NEAR(sum, 1, 1e-6);
    for (int i = 0; i < count; ++i) {
      const LightChoice c = sampler->choose({}, {}, (float(i) + 0.5f) / count);
      ASSERT_NE(c.luminaire, nullptr);
      EXPECT_EQ(c.probability, sampler->probability({}, {}, *c.luminaire));
      ++counts[size_t(c.luminaire->luminaire_index())];
    }
    for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(counts[i], expected[i], 2.02) << name;  // two ranges of u at most
    EXPECT_EQ(sampler->probability(*lights.scene->objects[3]), 0);                     // no luminaire
    EXPECT_NE(sampler->choose(one_minus_epsilon).luminaire, nullptr);
  }
}

TEST(LightSampler, ByPower) {
  const Lights lights;
  const Ref<LightSampler> sampler = create<LightSampler>("PowerLightSampler");
  sampler->build(*lights.scene);
  const double wanted[] = {0.1, 0.6, 0.3};
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(sampler->probability(*lights.scene->luminaires()[i]), wanted[i], 1e-3);
    // At a surface point half of the choices are made regardless of power.
    EXPECT_NEAR(sampler->probability({}, {}, *lights.scene->luminaires()[i]), wanted[i] / 2 + 1 / 6.0, 1e-3);
  }
}

}  // namespace
}  // namespace etendue
