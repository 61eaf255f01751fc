// The film against integrals computed here in double precision: filters with all members away from their defaults, the film's
// table of them to a fraction of a per cent, splats in crops and at borders, path lengths, variances and features.

#include <gtest/gtest.h>

#include <random>

#include "etendue/film/film.h"
#include "etendue/filter.h"
#include "support/component_test_support.h"

namespace etendue {
namespace {

using test::create;
using test::Setting;
using Formula = std::function<double(double)>;

struct Case {
  std::string name;
  std::vector<Setting> settings;
  double radius;
  Formula along;  // the papers' formulas, as functions of the distance along one axis
};

double sinc(double x) { return x == 0 ? 1 : std::sin(M_PI * x) / (M_PI * x); }

/// Mitchell & Netravali 1988, eq. 8.
double cubic(double x, double B, double C) {
  x = std::abs(x);
  if (x < 1) return ((12 - 9 * B - 6 * C) * x * x * x + (-18 + 12 * B + 6 * C) * x * x + 6 - 2 * B) / 6;
  if (x < 2) return ((-B - 6 * C) * x * x * x + (6 * B + 30 * C) * x * x + (-12 * B - 48 * C) * x + 8 * B + 24 * C) / 6;
  return 0;
}

const std::vector<Case>& cases() {
  static const std::vector<Case> all = {
      {"BoxFilter", {{"radius", 1.3}}, 1.3, [](double x) { return std::abs(x) <= 1.3 ? 1.0 : 0.0; }},
      {"TriangleFilter", {{"radius", 1.7}}, 1.7, [](double x) { return std::max(0.0, 1.7 - std::abs(x)); }},
      {"GaussianFilter",
       {{"radius", 2.25}, {"deviation", 0.8}},
       2.25,
       [](double x) { return std::max(0.0, std::exp(-x * x / (2 * 0.64)) - std::exp(-2.25 * 2.25 / (2 * 0.64))); }},
      {"MitchellFilter",
       {{"radius", 2.5}, {"b", 0.2}, {"c", 0.55}},
       2.5,
       [](double x) { return cubic(x * 2 / 2.5, 0.2, 0.55); }},
      {"LanczosFilter", {{"radius", 2.0}}, 2, [](double x) { return std::abs(x) < 2 ? sinc(x) * sinc(x / 2) : 0.0; }}};
  return all;
}

TEST(FilmNumbers, FiltersAreThoseOfThePapers) {
  for (const Case& c : cases()) {
    const Ref<Filter> f = create<Filter>(c.name, c.settings);
    EXPECT_FLOAT_EQ(f->radius(), float(c.radius));
    const double centre = double(f->weight(0, 0)) / (c.along(0) * c.along(0));
    for (double x = -c.radius - 0.3; x < c.radius + 0.3; x += 0.137)
      for (const double y : {0.0, 0.41, -1.21})
        EXPECT_NEAR(double(f->weight(float(x), float(y))), centre * c.along(x) * c.along(y), 2e-6) << c.name << " " << x;
  }
}

const Wavelengths& lambda() {
  static const Wavelengths w = test::wavelengths(500);
  return w;
}
double unit() { return to_xyz(Spectrum(1.0f), lambda()).y; }

Ref<ImageBuffer> picture(const Case& c, int width, int height, const std::vector<int>& crop = {}) {
  auto buffer = make<ImageBuffer>();
  buffer->width = width;
  buffer->height = height;
  buffer->crop = crop;
  buffer->filter = create<Filter>(c.name, c.settings);
  return buffer;
}

/// The integral of a filter along one axis.
double whole(const Case& c) {
  constexpr int steps = 20000;
  double sum = 0;
  for (int i = 0; i < steps; ++i) sum += c.along(c.radius * (2 * (i + 0.5) / steps - 1)) * 2 * c.radius / steps;
  return sum;
}

// A splat contributes its weight over the filter's integral to each pixel around it. The film's table of the filter has 64
// cells within the radius, whose errors cancel over many positions. Compared in twelve bins by distance from the pixel's
// centre, and in total to 0.3 %.
TEST(FilmNumbers, PixelsWeighSplatsByTheFilter) {
  for (const Case& c : cases()) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(0, 1);
    constexpr size_t bins = 13;  // of a tenth of the radius each, up to 1.2 inclusive
    std::array<double, bins> got{}, expected{}, size{};
    const double norm = whole(c) * whole(c);
    const Ref<ImageBuffer> buffer = picture(c, 13, 13);
    buffer->prepare();
    Film film(*buffer);
    constexpr int count = 4000;
    for (int i = 0; i < count; ++i) {
      const double x = 6 + uniform(random), y = 6 + uniform(random);
      film.clear();
      ImageTile tile;
      tile.begin(*buffer, buffer->area());
      for (int k = 0; k < 169; ++k) tile.count_path();
      tile.splat({float(x), float(y)}, 6, 6, 0, Spectrum(1.0f), lambda(), 1);
      film.merge(tile);
      const Image image = film.develop();
      for (int py = 3; py <= 9; ++py)
        for (int px = 3; px <= 9; ++px) {
          const double dx = std::abs(x - px - 0.5), dy = std::abs(y - py - 0.5);
          const auto bin = size_t(std::min(std::max(dx, dy) / c.radius, 1.2) * 10);
          const double w = c.along(dx) * c.along(dy) / norm;
          got[bin] += image.at(px, py, 1) / unit();
          expected[bin] += w;
          size[bin] += std::abs(w);
        }
    }
    double all = 0, all_expected = 0, largest = 0;
    for (size_t i = 0; i < bins; ++i) largest = std::max(largest, size[i]);
    for (size_t i = 0; i < bins; ++i) {
      all += got[i];
      all_expected += expected[i];
      EXPECT_NEAR(got[i], expected[i], 6e-3 * size[i] + 2e-3 * largest) << c.name << " " << i;
    }
    EXPECT_NEAR(all, all_expected, 3e-3 * all_expected) << c.name;
  }
}

/// The integral of a filter around a pixel's centre over the part within the film [x0, x1) x [y0, y1).
double integral(const Case& c, int px, int py, int x0, int y0, int x1, int y1) {
  const auto along = [&](double low, double high) {
    low = std::max(low, -c.radius), high = std::min(high, c.radius);
    constexpr int steps = 20000;
    double sum = 0;
    for (int i = 0; i < steps; ++i) sum += c.along(low + (high - low) * (i + 0.5) / steps) * (high - low) / steps;
    return sum;
  };
  return along(x0 - px - 0.5, x1 - px - 0.5) * along(y0 - py - 0.5, y1 - py - 0.5);
}

// Light that is splatted evenly over the film of a crop, with a contribution of 1 from each path: the mean radiance is the same
// in every pixel, and a single splat contributes f / integral of f over the film, times the picture's number of pixels, to each
// pixel near it.
TEST(FilmNumbers, SplatsInACropAndAtItsBorders) {
  for (const Case& c : cases()) {
    if (c.name == "BoxFilter") continue;  // its edges lie within cells
    const std::vector<int> crop = {3, 2, 12, 9};
    for (const Point2 at : {Point2{7.3f, 5.6f}, {3.2f, 2.1f}, {11.8f, 5.4f}, {6.4f, 8.9f}}) {
      const Ref<ImageBuffer> buffer = picture(c, 20, 15, crop);
      buffer->path_lengths = 3;
      buffer->prepare();
      Film film(*buffer);
      ImageTile tile;
      tile.begin(*buffer, buffer->area());
      constexpr int paths = 63;
      for (int i = 0; i < paths; ++i) tile.count_path();
      tile.splat(at, 5, 5, 0, Spectrum(1.0f), lambda(), 2);
      tile.splat({19, 14}, 5, 5, 0, Spectrum(1.0f), lambda(), 2);  // beyond the filter's radius: no contribution
      film.merge(tile);
      const Image image = film.develop();
      double largest = 0;
      for (int y = 2; y < 9; ++y)
        for (int x = 3; x < 12; ++x) {
          const double expected = unit() * 20 * 15 / paths * c.along(double(at.x) - x - 0.5) * c.along(double(at.y) - y - 0.5) /
                                  integral(c, x, y, 0, 0, 20, 15);
          largest = std::max(largest, std::abs(expected));
          const double got = image.at(x - 3, y - 2, 1);
          EXPECT_NEAR(got, expected, 0.03 * unit() * 20 * 15 / paths * 0.3 + 0.02 * std::abs(expected)) << c.name << x << y;
          // By path length: all of it is in the layer of the second length.
          EXPECT_NEAR(image.at(x - 3, y - 2, 3 + 3 + 1), got, 1e-12);
          EXPECT_EQ(image.at(x - 3, y - 2, 3 + 1), 0);
        }
    }
    // Uniform light over the film: every pixel of the crop has all of it, to 0.3 %.
    const Ref<ImageBuffer> buffer = picture(c, 20, 15, crop);
    buffer->prepare();
    Film film(*buffer);
    ImageTile tile;
    tile.begin(*buffer, buffer->area());
    constexpr int side = 50;
    for (int y = 0; y < 15 * side; ++y)
      for (int x = 0; x < 20 * side; ++x)
        tile.splat({(float(x) + 0.5f) / side, (float(y) + 0.5f) / side}, 5, 5, 0, Spectrum(1.0f), lambda(), 1);
    for (int i = 0; i < 20 * 15 * side * side; ++i) tile.count_path();
    film.merge(tile);
    const Image image = film.develop();
    for (int y = 0; y < 7; ++y)
      for (int x = 0; x < 9; ++x) EXPECT_NEAR(image.at(x, y, 1), unit(), 3e-3 * unit()) << c.name << " " << x << " " << y;
  }
}

// The variance of the mean of n samples is sum (x - mean)^2 / (n (n - 1)).
TEST(FilmNumbers, Variance) {
  auto buffer = make<ImageBuffer>();
  buffer->width = buffer->height = 2;
  buffer->filter = create<Filter>("BoxFilter");
  buffer->layers = {"variance", "samples"};
  buffer->prepare();
  Film film(*buffer);
  ImageTile tile;
  tile.begin(*buffer, buffer->area());
  const double values[] = {1, 3, 4, 8};
  for (std::uint32_t i = 0; i < 4; ++i) tile.contribute({0.5f, 0.5f}, 0, 0, i, Spectrum(float(values[i])), lambda());
  film.merge(tile);
  const Image image = film.develop();
  ASSERT_EQ(image.channels, (std::vector<std::string>{"X", "Y", "Z", "variance.Y", "samples.N"}));
  EXPECT_NEAR(image.at(0, 0, 1), 4 * unit(), 1e-6);
  EXPECT_NEAR(image.at(0, 0, 3), (9 + 1 + 0 + 16) / 12.0 * unit() * unit(), 1e-6);
  EXPECT_EQ(image.at(0, 0, 4), 4);
}

}  // namespace
}  // namespace etendue
