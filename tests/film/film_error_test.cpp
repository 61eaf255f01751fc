// Whether the error that a film reports is the true one: renders with many seeds have the spread that each of them reports.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/filter_support.h"
#include "support/render_support.h"

namespace etendue {
namespace {

/// Pictures of one scene with different seeds, each with the variance it reports.
class Spread {
 public:
  void add(const Image& picture) {
    const auto variance = size_t(std::ranges::find(picture.channels, std::string("variance.Y")) - picture.channels.begin());
    auto& [values, reported] = runs_.emplace_back();
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x) {
        values.push_back(picture.at(x, y, 1));
        reported += picture.at(x, y, variance);
      }
  }

  /// The mean over pictures of (squared deviation from their mean - reported variance), in units of its standard error.
  /// Student's distribution with 100 degrees of freedom and more exceeds 4.5 with a probability of 2e-5.
  double excess() const { return mean().first / mean().second; }
  /// The reported variance over the true one; and the relative standard error of the true one, that is, the smallest deviation
  /// that the test could detect.
  double ratio() const { return reported() / (reported() + mean().first); }
  double sharpness() const { return mean().second / (reported() + mean().first); }

 private:
  struct Run {
    std::vector<double> values;
    double reported = 0;
  };
  std::pair<double, double> mean() const {
    const auto n = double(runs_.size());
    std::vector<double> centre(runs_[0].values.size());
    for (const Run& run : runs_)
      for (size_t i = 0; i < centre.size(); ++i) centre[i] += run.values[i] / n;
    double sum = 0, squares = 0;
    for (const Run& run : runs_) {
      double difference = -run.reported;
      for (size_t i = 0; i < centre.size(); ++i) difference += std::pow(run.values[i] - centre[i], 2) * n / (n - 1);
      sum += difference;
      squares += difference * difference;
    }
    return {sum / n, std::sqrt((squares / n - std::pow(sum / n, 2)) / (n - 1))};
  }
  double reported() const {
    double sum = 0;
    for (const Run& run : runs_) sum += run.reported / double(runs_.size());
    return sum;
  }
  std::vector<Run> runs_;
};

constexpr double significant = 4.5;

Ref<Job> lit_balls(const std::string& renderer, const std::string& filter, const std::string& sampler) {
  return load_job_text(fmt::format(R"(Job {{
    renderer: {} {{ samples: 16, max_depth: 4, sampler: {} {{}} }}
    camera: PerspectiveCamera {{ from: [0, 0, -4] m, to: [0, 0, 0] m, fov: 40 deg }}
    image: ImageBuffer {{ width: 10, height: 8, layers: ["variance"], filter: {} {{}} }}
    scene: BruteForceScene {{ objects: [
      Sphere {{ shader: Lambertian {{ color: 0.5 }} }}
      Rectangle {{ corner: [-3, -1, -2] m, edge_u: [0, 0, 5] m, edge_v: [6, 0, 0] m, shader: Lambertian {{ color: 0.7 }} }}
      Sphere {{ centre: [0, 2.5, -1] m, radius: 0.7 m, emission: DiffuseEmission {{ radiance: 5 }} }}
    ] }} }})",
                                   renderer, sampler, filter),
                       "balls.etd");
}

Spread spread_of(const Ref<Job>& job, int runs) {
  Spread spread;
  Render render(job);
  for (int run = 0; run < runs; ++run) {
    test::render_again(render, std::uint64_t(run + 1));
    spread.add(render.film().develop());
  }
  return spread;
}

// Independent samples, splats, and both: the spread is exactly as reported.
TEST(FilmError, independent_samples_and_splats_spread_as_reported) {
  for (const char* renderer : {"PathTracer", "LightTracer", "BidirectionalPathTracer"}) {
    const Spread spread = spread_of(lit_balls(renderer, "BoxFilter", "IndependentSampler"), 400);
    EXPECT_LT(std::abs(spread.excess()), significant) << renderer << ": reported over true " << spread.ratio();
    EXPECT_LT(spread.sharpness(), 0.1) << renderer;
  }
  const Spread spread = spread_of(lit_balls("LightTracer", "GaussianFilter", "IndependentSampler"), 400);
  EXPECT_LT(std::abs(spread.excess()), significant) << "reported over true " << spread.ratio();
  EXPECT_LT(spread.sharpness(), 0.06);
}

// Points of a low-discrepancy sequence give less spread: the reported variance is an upper bound.
TEST(FilmError, low_discrepancy_samples_spread_less_than_reported) {
  for (const char* renderer : {"PathTracer", "BidirectionalPathTracer"})
    for (const char* filter : {"BoxFilter", "GaussianFilter"}) {
      const Spread spread = spread_of(lit_balls(renderer, filter, "SobolSampler"), 100);
      EXPECT_LT(spread.excess(), significant) << renderer << " " << filter << " " << spread.ratio();
      EXPECT_LT(spread.ratio(), 30) << renderer << " " << filter;
    }
}

// --error stops rendering by the mean over pixels of standard error over value. Tested with light paths, which reach every
// pixel that is lit: a pixel that is lit by rare paths only has a large relative error, of which most renders see nothing,
// whatever they report.
TEST(FilmError, relative_error_is_that_of_the_pixels) {
  const Ref<Job> job = lit_balls("LightTracer", "BoxFilter", "IndependentSampler");
  job->renderer->samples = 1024;
  Render render(job);
  constexpr int runs = 100;
  std::vector<double> sum(80), squares(80);
  double reported = 0;
  for (int run = 0; run < runs; ++run) {
    test::render_again(render, std::uint64_t(1000 + run));
    reported += render.film().relative_error() / runs;
    const Image picture = render.film().develop();
    for (size_t i = 0; i < 80; ++i) {
      const double value = picture.at(int(i % 10), int(i / 10), 1);
      sum[i] += value / runs;
      squares[i] += value * value / runs;
    }
  }
  double error = 0, mean = 0;
  for (const double value : sum) mean += value / 80;
  for (size_t i = 0; i < 80; ++i) error += std::sqrt(std::max(0.0, squares[i] - sum[i] * sum[i])) / (sum[i] + 1e-3 * mean) / 80;
  // The root of a varying variance is biased low, a quotient by a varying mean biased high: equal to 15 %.
  EXPECT_NEAR(reported / error, 1, 0.15);
}

const Wavelengths wavelengths({450, 530, 600, 650}, {1 / 470.0f, 1 / 470.0f, 1 / 470.0f, 1 / 470.0f});

Ref<ImageBuffer> picture(const Ref<Filter>& filter) {
  auto image = make<ImageBuffer>();
  image->width = 9;
  image->height = 7;
  image->filter = filter;
  image->layers = {"variance"};
  image->prepare();
  return image;
}

// Independent values around a mean, at evenly spread film points: the noise is as reported for every filter, also at the film's
// border.
TEST(FilmError, filtered_noise_is_as_reported) {
  for (const Ref<Filter>& filter : test::all_filters()) {
    const Ref<ImageBuffer> image = picture(filter);
    std::mt19937 random(5);
    std::exponential_distribution<float> value(1);
    Spread spread;
    for (int run = 0; run < 300; ++run) {
      Film film(*image);
      ImageTile tile;
      tile.begin(*image, image->area());
      for (int y = 0; y < 7; ++y)
        for (int x = 0; x < 9; ++x)
          for (std::uint32_t i = 0; i < 64; ++i) {
            tile.count_path();
            tile.contribute({float(x) + (float(i % 8) + 0.5f) / 8, float(y) + (float(i / 8) + 0.5f) / 8}, x, y, i,
                            Spectrum(value(random)), wavelengths);
          }
      film.merge(tile);
      film.end_step();
      spread.add(film.develop());
    }
    // The sum over the lattice's points differs from the integral by up to 2 %.
    EXPECT_LT(std::abs(spread.excess()), significant + 0.02 / spread.sharpness()) << test::name(*filter) << spread.ratio();
    EXPECT_LT(spread.sharpness(), 0.05);
  }
}

// Splats of one path often fall side by side: they are one outcome, so they have more noise than as many independent paths.
TEST(FilmError, splats_of_a_path_are_one_outcome) {
  for (const char* filter : {"BoxFilter", "GaussianFilter"}) {
    const Ref<ImageBuffer> image = picture(test::make_filter(filter));
    std::mt19937 random(6);
    std::uniform_real_distribution<float> uniform(0, 1);
    Spread spread;
    for (int run = 0; run < 300; ++run) {
      Film film(*image);
      ImageTile tile;
      tile.begin(*image, image->area());
      for (std::uint32_t i = 0; i < 300; ++i) {
        const Point2 at{9 * uniform(random), 7 * uniform(random)};
        for (int y = 0; y < 7 && i == 0; ++y)
          for (int x = 0; x < 9; ++x)
            for (std::uint32_t k = 0; k < 2; ++k)
              tile.contribute({float(x) + 0.5f, float(y) + 0.5f}, x, y, k, Spectrum(), wavelengths);
        tile.count_path();
        for (int k = 0; k < 4; ++k)
          tile.splat({at.x + uniform(random) - 0.5f, at.y + 0.3f * uniform(random)}, 0, 0, i, Spectrum(uniform(random)),
                     wavelengths, 1);
      }
      film.merge(tile);
      film.end_step();
      spread.add(film.develop());
    }
    EXPECT_LT(std::abs(spread.excess()), significant) << filter << " " << spread.ratio();
    EXPECT_LT(spread.sharpness(), 0.06) << filter;
  }
}

// An estimator whose samples within a step are correlated, like those of a Markov chain or of one photon map.
TEST(FilmError, correlated_samples_spread_by_steps) {
  for (const bool splats : {false, true}) {
    const Ref<ImageBuffer> image = picture(test::make_filter("GaussianFilter"));
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(0, 1);
    std::exponential_distribution<float> luck(1);
    Spread by_steps, by_samples;
    for (int run = 0; run < 300; ++run) {
      Film film(*image, Estimator::correlated), blind(*image);
      for (int step = 0; step < 12; ++step) {
        const int samples = step < 6 ? 4 : 8;  // steps may differ in size; one random value per 4 samples
        for (int part = 0; part < samples / 4; ++part) {
          const float light = luck(random);
          ImageTile tile;
          tile.begin(*image, image->area());
          for (int y = 0; y < 7; ++y)
            for (int x = 0; x < 9; ++x)
              for (std::uint32_t i = 0; i < 4; ++i) {
                tile.count_path();
                const Point2 at{float(x) + (float(i % 2) + 0.5f) / 2, float(y) + (float(i / 2) + 0.5f) / 2};
                const Spectrum value(light + 0.1f * uniform(random));
                tile.contribute(at, x, y, i, splats ? Spectrum() : value, wavelengths);
                if (splats) tile.splat(at, x, y, i, value, wavelengths, 1);
              }
          film.merge(tile);
          blind.merge(tile);
        }
        EXPECT_EQ(std::isinf(film.relative_error()), step < 7);
        film.end_step();
        blind.end_step();
      }
      by_steps.add(film.develop());
      by_samples.add(blind.develop());
    }
    EXPECT_LT(std::abs(by_steps.excess()), significant) << splats << " " << by_steps.ratio();
    EXPECT_LT(by_steps.sharpness(), 0.15);
    EXPECT_LT(by_samples.ratio(), 0.3);  // treated as independent, they would seem much better than they are
  }
}

// Eight steps of equally many samples, whose means are proportional to 1, 2, … 8: the unbiased variance of these numbers is 8 *
// 9 / 12 = 6, so that of their mean, 4.5, is 6 / 8.
TEST(FilmError, eight_steps_spread_as_eight_numbers) {
  for (const bool splats : {false, true}) {
    const Ref<ImageBuffer> image = picture(test::make_filter("BoxFilter"));
    Film film(*image, Estimator::correlated);
    for (int step = 0; step < 8; ++step) {
      ImageTile tile;
      tile.begin(*image, image->area());
      for (int y = 0; y < 7; ++y)
        for (int x = 0; x < 9; ++x) {
          tile.count_path();
          const Spectrum value(float(step + 1));
          const Point2 at{float(x) + 0.5f, float(y) + 0.5f};
          tile.contribute(at, x, y, 0, splats ? Spectrum() : value, wavelengths);
          if (splats) tile.splat(at, x, y, 0, value, wavelengths, 1);
        }
      film.merge(tile);
      film.end_step();
    }
    // The relative error is regularized by a thousandth of the mean.
    EXPECT_NEAR(film.relative_error(), std::sqrt(6.0 / 8) / (4.5 * 1.001), 1e-6) << splats;
    const Image developed = film.develop();
    const auto variance = size_t(std::ranges::find(developed.channels, std::string("variance.Y")) - developed.channels.begin());
    EXPECT_NEAR(developed.at(4, 3, variance) / std::pow(developed.at(4, 3, 1), 2), 6.0 / 8 / (4.5 * 4.5), 1e-6) << splats;
  }
}

}  // namespace
}  // namespace etendue
