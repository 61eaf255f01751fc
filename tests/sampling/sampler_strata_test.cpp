// The strata that each sampler promises, by their definitions: (0,m,2)-nets in base 2, (0,m,4)-nets in base 4, intervals in
// prime bases, cells of a grid, the dual lattice, and nets over squares of pixels.

#include <gtest/gtest.h>

#include <complex>
#include <map>

#include "etendue/sampler.h"
#include "support/component_test_support.h"

namespace etendue {
namespace {

using test::create;

std::vector<Point2> pairs(const Sampler& s, SampleKey key, std::uint32_t first, std::uint32_t count, std::uint32_t dimension) {
  std::vector<Point2> points;
  for (key.sample = first; points.size() < count; ++key.sample) points.push_back(s.pair(key, dimension));
  return points;
}

/// The largest number of points in an elementary interval of area 2^-m, for 2^m points: 1 for a (0,m,2)-net.
int fullest_interval(const std::vector<Point2>& points) {
  int fullest = 0;
  for (size_t columns = 1; columns <= points.size(); columns *= 2) {
    const size_t rows = points.size() / columns;
    std::vector<int> counts(points.size());
    for (const Point2& p : points)
      fullest = std::max(fullest, ++counts[size_t(p.x * float(columns)) * rows + size_t(p.y * float(rows))]);
  }
  return fullest;
}

// Each aligned block of 2^m samples is a (0,m,2)-net in base 2, in every pair of dimensions of every walk. ZSobolSampler's
// blocks lie within its ranges of samples; Pmj02Sampler's within its tables.
TEST(SamplerStrata, PairsAreNets) {
  const std::pair<const char*, std::vector<test::Setting>> samplers[] = {
      {"SobolSampler", {}}, {"PairsInQuadsSampler", {}}, {"Pmj02Sampler", {}}, {"ZSobolSampler", {{"samples", 4096.0}}}};
  for (const auto& [name, settings] : samplers) {
    const Ref<Sampler> s = create<Sampler>(name, settings);
    for (const std::uint32_t dimension : {0u, 7u, 10u, 13u, 61u, 1000u})
      for (int pixel = 0; pixel < 3; ++pixel) {
        SampleKey key(4, 3 * pixel, 17, 0);
        if (pixel == 2) key = NumberStream(*s, key).fork("light").key();
        for (std::uint32_t m = 0; m <= 12; ++m)
          for (const std::uint32_t block : {0u, 1u, 2u, 3u, 5u, 6u, 7u, 101u}) {
            if (block > 0 && (std::string(name) == "Pmj02Sampler" || (block + 1) << m > 4096)) continue;
            ASSERT_EQ(fullest_interval(pairs(*s, key, block << m, 1u << m, dimension)), 1)
                << name << " " << dimension << " " << pixel << ": block " << block << " of 2^" << m;
          }
      }
  }
}

// The first 4^m points, and each aligned block of as many, have one point in each of the boxes 4^-a x 4^-b x 4^-c x 4^-d with
// a + b + c + d = m: film and first luminaire, a bounce's direction and the next luminaire.
TEST(SamplerStrata, QuadsAreNetsInBase4) {
  const Ref<Sampler> s = create<Sampler>("PairsInQuadsSampler");
  const auto fullest_box = [](const std::vector<std::array<float, 4>>& points, std::uint32_t m) {
    int fullest = 0;
    for (std::uint32_t a = 0; a <= m; ++a)
      for (std::uint32_t b = 0; a + b <= m; ++b)
        for (std::uint32_t c = 0; a + b + c <= m; ++c) {
          const std::uint32_t digits[4] = {a, b, c, m - a - b - c};
          std::vector<int> counts(points.size());
          for (const auto& p : points) {
            size_t box = 0;
            for (size_t i = 0; i < 4; ++i) {
              const size_t cells = size_t(1) << (2 * digits[i]);
              box = box * cells + size_t(p[i] * float(cells));
            }
            fullest = std::max(fullest, ++counts[box]);
          }
        }
    return fullest;
  };
  const auto quad = [&](std::uint32_t one, std::uint32_t two, std::uint32_t m, std::uint32_t block) {
    std::vector<std::array<float, 4>> points;
    for (std::uint32_t i = 0; i < 1u << (2 * m); ++i) {
      const SampleKey key(9, 40, 50, (block << (2 * m)) + i);
      const Point2 p = s->pair(key, one), q = s->pair(key, two);
      points.push_back({p.x, p.y, q.x, q.y});
    }
    return fullest_box(points, m);
  };
  const std::pair<std::uint32_t, std::uint32_t> quads[] = {{0, 7}, {10, 13}, {16, 19}, {5, 8}, {600003, 600006}};
  for (const auto& [one, two] : quads)
    for (std::uint32_t m = 0; m <= 6; ++m)
      for (const std::uint32_t block : {0u, 1u, 3u, 1234u})
        ASSERT_EQ(quad(one, two, m, block), 1) << one << " " << two << ": block " << block << " of 4^" << m;
  // Pairs of different quads are no net together.
  EXPECT_GT(quad(10, 7, 4, 0), 1);
}

/// Whether each of `cells` cells of [0, 1) has one of as many numbers. Numbers are rounded down to multiples of 2^-24, which
/// takes few of them into the cell before.
bool one_in_each(const std::vector<float>& numbers, std::uint32_t cells) {
  std::vector<int> counts(cells);
  std::vector<std::uint32_t> later;
  for (const float x : numbers) {
    const auto cell = std::uint32_t(double(x) * cells), last = std::uint32_t((double(x) + 0x1p-24) * cells);
    cell == last || last == cells ? void(++counts[cell]) : later.push_back(cell);
  }
  for (const std::uint32_t cell : later) ++counts[counts[cell] ? cell + 1 : cell];
  return std::ranges::all_of(counts, [](int c) { return c == 1; });
}

// Any b^k consecutive samples have one number in each interval of length b^-k, and any b^k c^l samples one point in each box.
TEST(SamplerStrata, HaltonPointsAreStratifiedInPrimeBases) {
  const Ref<Sampler> s = create<Sampler>("HaltonSampler");
  const std::uint32_t primes[] = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29};
  for (std::uint32_t d = 0; d < 10; ++d)
    for (std::uint32_t cells = primes[d]; cells < 3000; cells *= primes[d])
      for (const std::uint32_t block : {0u, 1u, 5u}) {
        std::vector<float> numbers;
        for (std::uint32_t i = 0; i < cells; ++i) numbers.push_back(s->number(SampleKey(1, 2, 3, block * cells + i), d));
        ASSERT_TRUE(one_in_each(numbers, cells)) << "base " << primes[d] << ", " << cells << " cells";
      }
  // The two-dimensional boxes hold for consecutive samples from any one on.
  for (const auto& [d, columns, rows] : {std::array<std::uint32_t, 3>{0, 16, 27}, {0, 64, 3}, {1, 27, 25}, {2, 5, 49}})
    for (const std::uint32_t first : {0u, 1u, 1000u}) {
      std::vector<int> counts(size_t(columns) * rows);
      for (const Point2& p : pairs(*s, SampleKey(1, 2, 3, 0), first, columns * rows, d))
        ++counts[size_t((double(p.x) + 0x1p-25) * columns) * rows + size_t((double(p.y) + 0x1p-25) * rows)];
      for (const int count : counts) ASSERT_EQ(count, 1) << d << " " << columns << " x " << rows << " from " << first;
    }
}

TEST(SamplerStrata, StratifiedCellsHaveOneSampleEach) {
  const Ref<Sampler> s = create<Sampler>("StratifiedSampler", {{"x", 5.0}, {"y", 3.0}});
  for (const std::uint32_t block : {0u, 1u, 77u})
    for (const std::uint32_t dimension : {0u, 5u, 900u}) {
      std::vector<int> cells(15), intervals(15);
      for (std::uint32_t i = 0; i < 15; ++i) {
        const SampleKey key(1, 8, 9, block * 15 + i);
        const Point2 p = s->pair(key, dimension);
        ++cells[size_t(p.x * 5) * 3 + size_t(p.y * 3)];
        ++intervals[size_t(s->number(key, dimension) * 15)];
      }
      EXPECT_EQ(cells, std::vector<int>(15, 1)) << block << " " << dimension;
      EXPECT_EQ(intervals, std::vector<int>(15, 1)) << block << " " << dimension;
    }
}

// The mean of exp(2 pi i h x) over the points is 0 but for the h of the dual lattice, where its modulus is 1. The shortest of
// these is at least 0.7 times as long as that of the best lattice of any kind, sqrt(2 n / sqrt(3)).
TEST(SamplerStrata, LatticesHaveLongDualVectors) {
  const Ref<Sampler> s = create<Sampler>("LatticeSampler");
  for (std::uint32_t n = 8; n <= 512; n *= 2)
    for (const std::uint32_t block : {0u, 3u}) {
      const std::vector<Point2> points = pairs(*s, SampleKey(1, 5, 5, 0), block * n, n, 7);
      const int range = int(std::ceil(std::sqrt(2 * n / std::sqrt(3.0))));
      double shortest = 1e9;
      for (int h = -range; h <= range; ++h)
        for (int k = 0; k <= range; ++k) {
          std::complex<double> sum = 0;
          for (const Point2& p : points) sum += std::polar(1.0, 2 * 3.14159265358979 * (h * double(p.x) + k * double(p.y)));
          const double modulus = std::abs(sum) / n;
          // Numbers are multiples of 2^-24, which matters by 2 pi h 2^-24.
          ASSERT_TRUE(modulus < 1e-3 || modulus > 1 - 1e-3) << n << ": " << h << ", " << k << ": " << modulus;
          if (modulus > 0.5 && (h || k)) shortest = std::min(shortest, std::hypot(double(h), double(k)));
        }
      EXPECT_GE(shortest, 0.7 * std::sqrt(2 * n / std::sqrt(3.0))) << n;
    }
}

/// Samples `first` ... `first + count - 1` of each pixel of a square.
std::vector<Point2> of_square(const Sampler& s, int x0, int y0, int size, std::uint32_t first, std::uint32_t count,
                              std::uint32_t dimension) {
  std::vector<Point2> points;
  for (int y = y0; y < y0 + size; ++y)
    for (int x = x0; x < x0 + size; ++x)
      for (const Point2& p : pairs(s, SampleKey(11, x, y, 0), first, count, dimension)) points.push_back(p);
  return points;
}

// The n samples of each of the pixels of an aligned square of 4^l are together a net, and so are further n, 2 n, 4 n, ...
// samples.
TEST(SamplerStrata, SquaresOfPixelsShareANet) {
  for (const std::uint32_t n : {1u, 4u, 8u}) {
    const Ref<Sampler> s = create<Sampler>("ZSobolSampler", {{"samples", double(n)}});
    for (const int size : {1, 2, 4, 8, 16})
      for (const auto& [x, y] : {std::pair{0, 0}, {3, 5}, {100, 7}, {4095, 2000}})
        for (const std::uint32_t dimension : {0u, 7u, 500u}) {
          ASSERT_EQ(fullest_interval(of_square(*s, x * size, y * size, size, 0, n, dimension)), 1) << n << " " << size;
          ASSERT_EQ(fullest_interval(of_square(*s, x * size, y * size, size, n, n, dimension)), 1) << n << " " << size;
          ASSERT_EQ(fullest_interval(of_square(*s, x * size, y * size, size, 4 * n, 4 * n, dimension)), 1) << n << " " << size;
        }
  }
  // Squares that are not aligned share none, and pixels of other samplers do not.
  const Ref<Sampler> s = create<Sampler>("ZSobolSampler", {{"samples", 4.0}});
  EXPECT_GT(fullest_interval(of_square(*s, 3, 3, 8, 0, 4, 0)), 1);
  EXPECT_GT(fullest_interval(of_square(*create<Sampler>("SobolSampler"), 0, 0, 8, 0, 4, 0)), 1);
}

// The order of the squares is random for each pair of dimensions: all 24 orders of four pixels occur equally often. (The order
// of four pixels with one sample each is the order of their quarters of the unit square.)
TEST(SamplerStrata, OrdersOfPixelsAreRandom) {
  const Ref<Sampler> s = create<Sampler>("ZSobolSampler", {{"samples", 1.0}});
  std::map<std::vector<int>, double> orders;
  constexpr int count = 4800;
  for (int i = 0; i < count; ++i) {
    std::vector<int> order;
    for (const Point2& p : of_square(*s, 2 * (i % 20), 2 * (i / 20 % 20), 2, 0, 1, std::uint32_t(2 * (i / 400))))
      order.push_back(int(2 * p.x) + 2 * int(2 * p.y));
    ++orders[order];
  }
  ASSERT_EQ(orders.size(), 24u);
  std::vector<double> counts;
  for (const auto& [order, n] : orders) counts.push_back(n);
  EXPECT_GT(test::chi_square(counts, std::vector<double>(24, count / 24.0)), test::each_of(1));
}

/// The mean distance of points to the nearest other one on the torus, times sqrt(n): 0.5 for random points, at most 1.07.
double nearest_distance(const std::vector<Point2>& points) {
  double sum = 0;
  for (const Point2& p : points) {
    double nearest = 1;
    for (const Point2& q : points) {
      if (&p == &q) continue;
      const auto along = [](float a, float b) { return std::min(std::abs(a - b), 1 - std::abs(a - b)); };
      nearest = std::min(nearest, double(std::hypot(along(p.x, q.x), along(p.y, q.y))));
    }
    sum += nearest;
  }
  return sum / std::sqrt(double(points.size()));
}

// With blue noise the first n points are farther apart than those of random nets, which SobolSampler's are.
TEST(SamplerStrata, BlueNoiseKeepsPointsApart) {
  const Ref<Sampler> apart = create<Sampler>("Pmj02Sampler"), sobol = create<Sampler>("SobolSampler");
  set(*apart, "blue_noise", Value(true));
  for (const auto& [n, gain] : {std::pair{8u, 1.3}, {32u, 1.03}, {128u, 1.03}}) {
    double ours = 0, random = 0;
    for (int i = 0; i < 400; ++i) {
      ours += nearest_distance(pairs(*apart, SampleKey(2, i, 3, 0), 0, n, 4)) / 400;
      random += nearest_distance(pairs(*sobol, SampleKey(2, i, 3, 0), 0, n, 4)) / 400;
    }
    EXPECT_GT(ours, gain * random) << n << ": " << random;
  }
}

}  // namespace
}  // namespace etendue
