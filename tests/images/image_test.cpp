// The film.

#include <gtest/gtest.h>

#include <random>

#include "etendue/film/film.h"
#include "film/surface_film.h"
#include "support/component_test_support.h"
#include "support/filter_support.h"

namespace etendue::test {
namespace {

const Wavelengths wavelengths({450, 530, 600, 650}, {1 / 470.0f, 1 / 470.0f, 1 / 470.0f, 1 / 470.0f});

Ref<ImageBuffer> make_buffer(int width, int height, const Ref<Filter>& filter = nullptr) {
  auto buffer = make<ImageBuffer>();
  buffer->width = width;
  buffer->height = height;
  if (filter) buffer->filter = filter;
  buffer->prepare();
  return buffer;
}

struct Sample {
  Point2 film;
  float value;
};

/// `count` random samples in each pixel; one list per pixel.
std::vector<std::vector<Sample>> random_samples(const PixelArea& area, int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::vector<std::vector<Sample>> samples;
  for (int y = area.y0; y < area.y1; ++y)
    for (int x = area.x0; x < area.x1; ++x) {
      auto& pixel = samples.emplace_back();
      for (int i = 0; i < count; ++i) {
        const Point2 film{float(x) + uniform(random), float(y) + uniform(random)};
        pixel.push_back({film, uniform(random) * 3});
      }
    }
  return samples;
}

/// Renders the samples in tiles of a size, merged in order, as one step.
void render(const ImageBuffer& buffer, Film& film, const std::vector<std::vector<Sample>>& samples, int tile_size) {
  const PixelArea& all = buffer.area();
  ImageTile tile;
  for (int y0 = all.y0; y0 < all.y1; y0 += tile_size)
    for (int x0 = all.x0; x0 < all.x1; x0 += tile_size) {
      const PixelArea area{x0, y0, std::min(x0 + tile_size, all.x1), std::min(y0 + tile_size, all.y1)};
      tile.begin(buffer, area);
      for (int y = area.y0; y < area.y1; ++y)
        for (int x = area.x0; x < area.x1; ++x) {
          std::uint32_t i = 0;
          for (const Sample& s : samples[size_t(y - all.y0) * size_t(all.width()) + size_t(x - all.x0)]) {
            tile.count_path();
            tile.contribute(s.film, x, y, i++, Spectrum(s.value), wavelengths);
          }
        }
      film.merge(tile);
    }
  film.end_step();
}

TEST(Film, ConstantStaysConstantUnderEveryFilter) {
  // Samples on a lattice that gives every cell of the filters' tables a number of samples proportional to its size, so that
  // sums are integrals, also at the border.
  const Xyz expected = to_xyz(Spectrum(0.7f), wavelengths);
  for (const auto& f : all_filters()) {
    const auto buffer = make_buffer(9, 7, f);
    Film film(*buffer);
    std::vector<std::vector<Sample>> samples;
    constexpr int n = 128;
    for (int pixel = 0; pixel < 9 * 7; ++pixel) {
      auto& own = samples.emplace_back();
      for (int i = 0; i < n * n; ++i)
        own.push_back({{float(pixel % 9) + (float(i % n) + 0.5f) / n, float(pixel / 9) + (float(i / n) + 0.5f) / n}, 0.7f});
    }
    render(*buffer, film, samples, 4);
    const Image image = film.develop();
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        EXPECT_NEAR(image.at(x, y, 0), expected.x, 1e-6 * expected.x) << name(*f);
        EXPECT_NEAR(image.at(x, y, 1), expected.y, 1e-6 * expected.y) << name(*f);
        EXPECT_NEAR(image.at(x, y, 2), expected.z, 1e-6 * expected.z) << name(*f);
      }
  }
}

TEST(Film, TableGivesTheFiltersOwnWeights) {
  // Only one sample near the centre of a pixel and one near its edge: the pixel's value is their sum weighted by the filter,
  // over twice the filter's integral over that pixel.
  for (const auto& f : all_filters()) {
    const auto buffer = make_buffer(7, 7, f);
    Film film(*buffer);
    ImageTile tile;
    tile.begin(*buffer, buffer->area());
    tile.contribute({3.4f, 3.7f}, 3, 3, 0, Spectrum(1.0f), wavelengths);
    tile.contribute({3.9f, 3.2f}, 3, 3, 1, Spectrum(3.0f), wavelengths);
    film.merge(tile);
    // The table's weights: those of the filter at the middles of the 64 cells within its radius.
    const float cell = f->radius() / 64;
    const auto weight = [&](float dx, float dy) {
      return double(
          f->weight((std::floor(std::abs(dx) / cell) + 0.5f) * cell, (std::floor(std::abs(dy) / cell) + 0.5f) * cell));
    };
    constexpr int fine = 400;  // the filter's integral over the pixel
    double share = 0;
    for (int i = 0; i < fine * fine; ++i)
      share += weight((float(i % fine) + 0.5f) / fine - 0.5f, (float(i / fine) + 0.5f) / fine - 0.5f) / (fine * fine);
    const double a = weight(-0.1f, 0.2f), b = weight(0.4f, -0.3f);
    const double y = to_xyz(Spectrum(1.0f), wavelengths).y;
    EXPECT_NEAR(film.develop().at(3, 3, 1), y * (a + 3 * b) / (2 * share), 4e-3 * y) << name(*f);
    EXPECT_EQ(film.develop().at(0, 0, 1) != 0, f->radius() > 3) << name(*f);
  }
}

TEST(Film, TilesDoNotShow) {
  for (const char* filter : {"BoxFilter", "GaussianFilter", "MitchellFilter"}) {
    const auto buffer = make_buffer(16, 16, make_filter(filter));
    Film one(*buffer), many(*buffer), again(*buffer);
    const auto samples = random_samples(buffer->area(), 8, 7);
    render(*buffer, one, samples, 16);
    render(*buffer, many, samples, 4);
    render(*buffer, again, samples, 4);
    const Image a = one.develop(), b = many.develop();
    for (size_t i = 0; i < a.values.size(); ++i) EXPECT_NEAR(a.values[i], b.values[i], 1e-12 * std::abs(a.values[i]) + 1e-15);
    EXPECT_EQ(many.save_state(), again.save_state()) << filter;
    EXPECT_EQ(one.samples(), 16u * 16 * 8);
  }
}

TEST(Film, VarianceOfTheMean) {
  // Uniform values in [0, 3): variance 9/12 each, so 0.75/n of the mean of n. Over 1024 pixels the relative deviation of
  // the mean estimate is below sqrt(2/n/1024) < 1 %; 4 % is four of them.
  const auto buffer = make_buffer(32, 32, make_filter("BoxFilter"));
  buffer->layers = {"variance", "samples"};
  buffer->prepare();
  Film film(*buffer);
  render(*buffer, film, random_samples(buffer->area(), 16, 3), 8);
  const Image image = film.develop();
  ASSERT_EQ(image.channels, (std::vector<std::string>{"X", "Y", "Z", "variance.Y", "samples.N"}));
  double mean = 0;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      mean += image.at(x, y, 3) / 1024;
      EXPECT_EQ(image.at(x, y, 4), 16);
    }
  const double unit = to_xyz(Spectrum(1.0f), wavelengths).y;
  EXPECT_NEAR(mean / (unit * unit * 0.75 / 16), 1, 0.04);
  // standard error over mean: sqrt(0.75 / 16) / 1.5 = 0.144; the mean of the ratio is a little off by its curvature
  EXPECT_NEAR(film.relative_error(), 0.144, 0.01);

  Film once(*buffer);
  EXPECT_TRUE(std::isinf(once.relative_error()));
  render(*buffer, once, random_samples(buffer->area(), 1, 3), 8);
  EXPECT_TRUE(std::isinf(once.relative_error()));
  render(*buffer, once, random_samples(buffer->area(), 1, 4), 8);
  EXPECT_TRUE(std::isfinite(once.relative_error()));
}

TEST(Film, BadSamplesAreCountedLocatedAndBlack) {
  for (const char* filter : {"BoxFilter", "GaussianFilter"}) {
    const auto buffer = make_buffer(8, 8, make_filter(filter));
    Film film(*buffer);
    ImageTile tile;
    tile.begin(*buffer, buffer->area());
    const float nan = std::numeric_limits<float>::quiet_NaN();
    Spectrum partly(1.0f);
    partly.set(2, nan);
    tile.contribute({3.5f, 2.5f}, 3, 2, 5, partly, wavelengths);
    tile.contribute({4.5f, 2.5f}, 4, 2, 6, Spectrum(infinity), wavelengths);
    tile.contribute({5.5f, 2.5f}, 5, 2, 7, Spectrum(-1.0f), wavelengths);
    tile.contribute({nan, 2.5f}, 6, 2, 8, Spectrum(1.0f), wavelengths);
    tile.contribute({6.5f, 3.5f}, 6, 3, 9, Spectrum(1.0f), wavelengths, nan);
    Spectrum rounding(1.0f);
    rounding.set(1, -1e-7f);
    tile.contribute({1.5f, 6.5f}, 1, 6, 9, rounding, wavelengths);  // rounding only: not bad
    Wavelengths single = wavelengths;
    single.drop_secondary();
    tile.contribute({5.5f, 6.5f}, 5, 6, 9, partly, single);  // nor is this: the NaN is of a dropped wavelength
    tile.splat({2.5f, 3.5f}, 4, 5, 11, Spectrum(nan), wavelengths, 2);
    film.merge(tile);
    EXPECT_EQ(film.bad_samples(), 6u);
    const auto& bad = film.first_bad_samples();
    ASSERT_EQ(bad.size(), 6u);
    EXPECT_EQ(bad[0].kind, BadSample::Kind::not_a_number);
    EXPECT_EQ(bad[0].x, 3);
    EXPECT_EQ(bad[0].y, 2);
    EXPECT_EQ(bad[0].sample, 5u);
    EXPECT_EQ(bad[1].kind, BadSample::Kind::infinite);
    EXPECT_EQ(bad[2].kind, BadSample::Kind::negative);
    EXPECT_EQ(bad[3].x, 6);
    EXPECT_EQ(bad[5].sample, 11u);
    EXPECT_EQ(bad[5].y, 5);
    const Image image = film.develop();
    for (const double v : image.values) EXPECT_TRUE(std::isfinite(v) && v >= 0);
    EXPECT_EQ(image.at(4, 2, 1), 0);
    EXPECT_GT(image.at(1, 6, 1), 0);
    EXPECT_GT(image.at(5, 6, 1), 0);
  }
  const auto buffer = make_buffer(8, 8);
  Film film(*buffer);
  ImageTile tile;
  tile.begin(*buffer, buffer->area());
  for (unsigned i = 0; i < 100; ++i) tile.contribute({1, 1}, 1, 1, i, Spectrum(-1.0f), wavelengths);
  film.merge(tile);
  EXPECT_EQ(film.bad_samples(), 100u);
  EXPECT_EQ(film.first_bad_samples().size(), 32u);
}

TEST(Film, SplatsOfAnEvenFilmAreEvenUpToTheEdge) {
  // 100 x 100 splats per pixel on a lattice, one of each path: every filter must reproduce the value, also at the edge, where
  // part of the filter lies outside.
  for (const auto& f : all_filters()) {
    const auto buffer = make_buffer(6, 5, f);
    Film film(*buffer);
    ImageTile tile;
    tile.begin(*buffer, buffer->area());
    constexpr int n = 100;
    for (int j = 0; j < 5 * n; ++j)
      for (int i = 0; i < 6 * n; ++i) {
        tile.count_path();
        tile.splat({(float(i) + 0.5f) / n, (float(j) + 0.5f) / n}, 0, 0, 0, Spectrum(2.0f), wavelengths, 1);
      }
    film.merge(tile);
    const double expected = to_xyz(Spectrum(2.0f), wavelengths).y;
    const Image image = film.develop();
    for (int y = 0; y < 5; ++y)
      for (int x = 0; x < 6; ++x) EXPECT_NEAR(image.at(x, y, 1), expected, 0.02 * expected) << name(*f) << x << ' ' << y;
  }
}

TEST(Film, StateRoundTrip) {
  const auto buffer = make_buffer(9, 7);
  Film a(*buffer), b(*buffer);
  const auto samples = random_samples(buffer->area(), 4, 5), more = random_samples(buffer->area(), 4, 6);
  render(*buffer, a, samples, 4);
  ImageTile tile;
  tile.begin(*buffer, buffer->area());
  tile.splat({1.2f, 3.4f}, 1, 3, 0, Spectrum(1.0f), wavelengths, 2);
  tile.contribute({1, 1}, 1, 1, 3, Spectrum(-1.0f), wavelengths);
  a.merge(tile);
  a.end_step();
  const std::vector<std::byte> state = a.save_state();
  b.load_state(state);
  EXPECT_EQ(b.save_state(), state);
  EXPECT_EQ(a.develop().values, b.develop().values);
  EXPECT_EQ(b.first_bad_samples().at(0).sample, 3u);
  render(*buffer, a, more, 4);
  render(*buffer, b, more, 4);
  EXPECT_EQ(a.save_state(), b.save_state());

  const std::vector<std::byte> before = b.save_state();
  for (size_t length = 0; length < state.size(); length += length < 100 ? 1 : 97)
    EXPECT_THROW(b.load_state(std::span(state).first(length)), Error) << length;
  std::vector<std::byte> longer = state;
  longer.push_back({});
  EXPECT_THROW(b.load_state(longer), Error);
  EXPECT_EQ(b.save_state(), before);
  const auto refused = [&](const Ref<ImageBuffer>& other, Estimator estimator) {
    Film film(*other, estimator);
    EXPECT_THROW(film.load_state(state), Error);
    EXPECT_THROW(film.add_state(state), Error);
  };
  refused(make_buffer(7, 9), Estimator::independent);
  const auto layered = make_buffer(9, 7);
  layered->path_lengths = 2;
  layered->prepare();
  refused(layered, Estimator::independent);
  refused(make_buffer(9, 7, make_filter("BoxFilter")), Estimator::independent);
  refused(buffer, Estimator::correlated);
}

TEST(Film, CropIsThePartOfThePicture) {
  const auto buffer = make_buffer(20, 10, make_filter("BoxFilter"));
  Film film(*buffer);
  const auto samples = random_samples(buffer->area(), 4, 9);
  render(*buffer, film, samples, 8);
  const auto part = make_buffer(20, 10, make_filter("BoxFilter"));
  part->crop = {5, 2, 11, 9};
  part->prepare();
  Film part_film(*part);
  std::vector<std::vector<Sample>> inner;
  for (int y = 2; y < 9; ++y)
    for (int x = 5; x < 11; ++x) inner.push_back(samples[size_t(y * 20 + x)]);
  render(*part, part_film, inner, 4);
  const Image whole = film.develop(), crop = part_film.develop();
  ASSERT_EQ(crop.width, 6);
  ASSERT_EQ(crop.height, 7);
  for (int y = 0; y < 7; ++y)
    for (int x = 0; x < 6; ++x) EXPECT_EQ(crop.at(x, y, 1), whole.at(x + 5, y + 2, 1));
  EXPECT_EQ(crop.metadata.at("crop_x"), "5");
  EXPECT_EQ(crop.metadata.at("full_height"), "10");
  EXPECT_EQ(crop.metadata.at("color_space"), "xyz");

  for (const std::vector<int>& wrong : {std::vector{1, 2, 3}, {5, 2, 5, 9}, {-1, 0, 4, 4}, {0, 0, 21, 4}}) {
    part->crop = wrong;
    EXPECT_THROW(part->prepare(), Error);
  }
}

TEST(SurfaceFilm, LayersAreMeansOfTheFirstHits) {
  const auto buffer = make_buffer(4, 4);
  buffer->filter = create<Filter>("BoxFilter");
  buffer->layers = {"albedo", "normal", "depth", "object", "coverage"};
  buffer->prepare();
  SurfaceFilm film(*buffer);
  const auto met = [](const Vector3& albedo, const Vector3& normal, double depth, int object) {
    FirstSurface s;
    s.key = 1;
    s.albedo = albedo;
    s.normal = normal;
    s.depth = depth;
    s.object = object;
    return s;
  };
  std::vector<SurfaceTile> tiles(2);
  tiles[0].begin(*buffer, buffer->area(), 0);
  tiles[0].add({1.1f, 2.5f}, 1, 2, 4, met({0.2f, 0.4f, 0.6f}, {0, 0, 1}, 3, 5));
  tiles[0].add({1.4f, 2.5f}, 1, 2, 2, met({0.4f, 0.4f, 0.6f}, {0, 1, 0}, 5, 6));
  tiles[0].add({1.9f, 2.5f}, 1, 2, 9, {});  // met nothing
  tiles[1].begin(*buffer, buffer->area(), 0);
  tiles[1].add({1.6f, 2.5f}, 1, 2, 3, met({0.4f, 0.4f, 0.6f}, {0, 1, 0}, 7, 8));
  film.take(tiles);
  film.end_step();
  Image image(4, 4, {"X"});
  film.snapshot()->add_channels(image);
  ASSERT_EQ(image.channels.size(), 10u);
  EXPECT_EQ(image.channels[1], "albedo.R");
  EXPECT_NEAR(image.at(1, 2, 1), 1.0 / 4, 1e-6);
  EXPECT_NEAR(image.at(1, 2, 5), 0.5, 1e-6);
  EXPECT_NEAR(image.at(1, 2, 7), 5, 1e-6);  // the mean of 3, 5, 7: a sample that met nothing has no depth
  EXPECT_EQ(image.at(1, 2, 8), 6);          // of the sample nearest to the centre, of two that are so of the first
  EXPECT_EQ(image.at(1, 2, 9), 0.75);
  EXPECT_EQ(image.at(0, 0, 7), 0);
  // A step that is dropped leaves nothing.
  const std::vector<std::byte> before = film.save_state();
  film.take(tiles);
  film.drop_step();
  film.end_step();
  EXPECT_TRUE(film.save_state() == before);
  buffer->layers = {"albdo"};
  EXPECT_THROW(buffer->prepare(), Error);
}

TEST(Film, PreparingAgainKeepsThePictureUnlessTheFilmChanged) {
  const auto buffer = make_buffer(6, 6);
  Film film(*buffer);
  render(*buffer, film, random_samples(buffer->area(), 2, 1), 6);
  const Image before = film.develop();
  buffer->layers = {"variance"};
  buffer->prepare();
  EXPECT_TRUE(film.follow(*buffer, Estimator::independent));
  const Image after = film.develop();
  for (int x = 0; x < 6; ++x) EXPECT_EQ(after.at(x, 3, 1), before.at(x, 3, 1));
  EXPECT_EQ(after.channels.size(), 4u);
  buffer->filter = make_filter("BoxFilter");
  buffer->prepare();
  EXPECT_FALSE(film.follow(*buffer, Estimator::independent));
  EXPECT_EQ(film.samples(), 0u);
  for (const double v : film.develop().values) EXPECT_EQ(v, 0);
}

}  // namespace
}  // namespace etendue::test
