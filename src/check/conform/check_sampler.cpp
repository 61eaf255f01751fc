// Checks of every sampler: numbers in [0, 1), reproducible, uniform, independent across dimensions, pixels and seeds, and
// spread over the samples of a pixel.

#include "etendue/sampler.h"

#include <fmt/format.h>

#include <set>

#include "conformance.h"
#include "statistics.h"

namespace etendue::conform {
namespace {

void check_range(Trial& trial, const Sampler& sampler) {
  const auto inside = [](float x) { return x >= 0 && x < 1; };
  for (int i = trial.samples(20000); i > 0; --i) {
    const SampleKey key(trial.random(), int(trial.random() % 5000), int(trial.random() % 5000),
                        std::uint32_t(trial.random() >> (trial.uniform() < 0.5f ? 56 : 32)));
    const auto dimension = std::uint32_t(trial.random() % 1000);
    const float x = sampler.number(key, dimension);
    const Point2 p = sampler.pair(key, dimension);
    const auto where = [&] { return fmt::format("sample {}, dimension {}: {}, ({}, {})", key.sample, dimension, x, p.x, p.y); };
    trial.expect(inside(x) && inside(p.x) && inside(p.y), "numbers lie in [0, 1)", where);
    trial.expect(sampler.number(key, dimension) == x && sampler.pair(key, dimension) == p,
                 "the same arguments give the same numbers", where);
    const auto other = std::uint32_t(trial.random() % 1000);
    const Sampler::Pairs pairs = sampler.two_pairs(key, dimension, other);
    trial.expect(pairs.first == p && pairs.second == sampler.pair(key, other), "two pairs at once are those of two calls",
                 where);
  }
}

/// Tests one number in each of many pixels and dimensions, which are as independent as possible.
void check_uniform(Trial& trial, const Sampler& sampler) {
  constexpr size_t bins = 16;
  const size_t count = size_t(trial.samples(100000));
  std::vector<double> single(bins), pairs(bins * bins);
  double mean = 0, square_mean = 0;
  for (size_t i = 0; i < count; ++i) {
    const SampleKey key(7, int(i % 317), int(i / 317), std::uint32_t(i % 13));
    const auto dimension = std::uint32_t(i % 29);
    const float x = sampler.number(key, dimension);
    const Point2 p = sampler.pair(key, dimension + 100);
    if (!(x >= 0 && x < 1 && p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1)) return;  // reported by check_range
    ++single[size_t(x * bins)];
    ++pairs[size_t(p.x * bins) * bins + size_t(p.y * bins)];
    mean += double(x) / double(count);
    square_mean += double(x) * double(x) / double(count);
  }
  const auto expect = [&](const std::vector<double>& counts, const char* what) {
    const double p = statistics::chi_square(counts, std::vector<double>(counts.size(), double(count) / double(counts.size())));
    trial.expect(p > Trial::significance, "numbers are uniform", [&] { return fmt::format("{}: p = {:.2g}", what, p); });
  };
  expect(single, "numbers over 16 intervals");
  expect(pairs, "pairs over 16 x 16 squares");
  // Variances of x and x^2 are 1/12 and 4/45.
  const double n = double(count);
  trial.expect(std::abs(mean - 0.5) < Trial::significant_errors * std::sqrt(1 / (12 * n)) &&
                   std::abs(square_mean - 1.0 / 3) < Trial::significant_errors * std::sqrt(4 / (45 * n)),
               "the means of x and x^2 are 1/2 and 1/3", [&] { return fmt::format("{:.6f} and {:.6f}", mean, square_mean); });
}

/// Tests the independence of dimensions, neighbouring pixels, and seeds.
void check_independent(Trial& trial, const Sampler& sampler) {
  constexpr size_t bins = 8;
  const auto pixels = size_t(trial.samples(16000));
  std::vector<double> dimensions(bins * bins), neighbours(bins * bins), seeds(bins * bins);
  for (size_t pixel = 0; pixel < pixels; ++pixel) {
    // Only one sample per pixel: with several, stratification would make the counts too even for the test.
    const auto i = std::uint32_t(mix_bits(pixel) % 16);
    const SampleKey key(1, int(pixel), 5, i), below(1, int(pixel), 6, i), other(2, int(pixel), 5, i);
    const auto bin = [](float x) { return std::min(size_t(std::max(x, 0.0f) * bins), bins - 1); };
    const size_t x = bin(sampler.pair(key, 0).x) * bins;
    ++dimensions[x + bin(sampler.pair(key, 2).x)];
    ++neighbours[x + bin(sampler.pair(below, 0).x)];
    ++seeds[x + bin(sampler.pair(other, 0).x)];
  }
  const std::pair<const std::vector<double>*, const char*> tests[] = {
      {&dimensions, "two dimensions of a sample"}, {&neighbours, "neighbouring pixels"}, {&seeds, "two seeds"}};
  for (const auto& [counts, what] : tests) {
    const double p = statistics::chi_square(*counts, std::vector<double>(bins * bins, double(pixels) / (bins * bins)));
    trial.expect(p > Trial::significance, "dimensions, pixels and seeds are independent",
                 [&, w = what] { return fmt::format("{}: p = {:.2g}", w, p); });
  }
  std::set<float> different;
  for (std::uint32_t i = 0; i < 256; ++i) different.insert(sampler.number(SampleKey(3, 10, 20, i), 4));
  trial.expect(different.size() > 240, "samples of a pixel differ",
               [&] { return fmt::format("256 samples have {} different numbers", different.size()); });
}

/// The squared L2 star discrepancy of points in the unit square (Warnock 1972):
///   D = 1/9 - 2/n sum (1 - x^2)(1 - y^2)/4 + 1/n^2 sum sum (1 - max(x, x'))(1 - max(y, y')).
double discrepancy(const std::vector<Point2>& points) {
  double once = 0, twice = 0;
  for (const Point2& p : points) {
    once += (1 - double(p.x * p.x)) * (1 - double(p.y * p.y)) / 4;
    for (const Point2& q : points) twice += double(1 - std::max(p.x, q.x)) * double(1 - std::max(p.y, q.y));
  }
  const double n = double(points.size());
  return 1.0 / 9 - 2 * once / n + twice / (n * n);
}

/// Tests that a pixel's samples have no larger discrepancy than random ones, whose expected squared discrepancy is (1/4 - 1/9)
/// / n.
void check_spread(Trial& trial, const Sampler& sampler) {
  constexpr std::uint32_t n = 64;
  for (const std::uint32_t dimension : {0u, 2u, 6u, 20u}) {
    statistics::Mean mean;
    for (int pixel = trial.samples(200); pixel > 0; --pixel) {
      std::vector<Point2> points;
      for (std::uint32_t i = 0; i < n; ++i) points.push_back(sampler.pair(SampleKey(9, pixel, 3, i), dimension));
      mean.add(discrepancy(points));
    }
    const double of_random = (0.25 - 1.0 / 9) / n;
    trial.expect(mean.mean() < of_random + Trial::significant_errors * mean.error(),
                 "samples of a pixel are spread no worse than random ones", [&] {
                   return fmt::format("dimension {}: squared discrepancy {:.3g} ± {:.2g}, of random points {:.3g}", dimension,
                                      mean.mean(), mean.error(), of_random);
                 });
  }
}

/// Tests that the samples of one pixel have orders of their own in different dimensions: otherwise the mean over a pixel's
/// samples would not converge to the integral over both dimensions, although each sample, and each dimension, is uniform. The
/// mean squared correlation of n independent numbers is 1 / (n - 1), that of nested random permutations somewhat more.
void check_shuffled(Trial& trial, const Sampler& sampler) {
  constexpr std::uint32_t n = 64;
  const int pixels = trial.samples(200);
  for (const auto& [one, two] : {std::pair{0u, 2u}, {0u, 7u}, {7u, 10u}, {10u, 13u}, {13u, 16u}}) {
    double squares = 0;
    for (int pixel = 0; pixel < pixels; ++pixel) {
      double x = 0, y = 0, xx = 0, yy = 0, xy = 0;
      for (std::uint32_t i = 0; i < n; ++i) {
        const SampleKey key(11, pixel, 8, i);
        const auto u = double(sampler.pair(key, one).x) - 0.5, v = double(sampler.pair(key, two).y) - 0.5;
        x += u / n, y += v / n, xx += u * u / n, yy += v * v / n, xy += u * v / n;
      }
      const double variances = (xx - x * x) * (yy - y * y);
      squares += variances > 0 ? (xy - x * y) * (xy - x * y) / variances / pixels : 0;
    }
    trial.expect(squares < 0.15, "samples of a pixel are independent between dimensions", [&, a = one, b = two] {
      return fmt::format("dimensions {} and {}: mean squared correlation {:.3f}", a, b, squares);
    });
  }
}

void check_sampler(Trial& trial) {
  const Sampler& sampler = trial.part<Sampler>();
  check_range(trial, sampler);
  check_uniform(trial, sampler);
  check_independent(trial, sampler);
  check_spread(trial, sampler);
  check_shuffled(trial, sampler);
}

const RegisterCheck<Sampler> registered(check_sampler);

}  // namespace
}  // namespace etendue::conform
