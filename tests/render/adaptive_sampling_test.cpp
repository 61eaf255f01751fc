// Adaptive sampling: no bias where bright samples are rare, less error where noise is local, the same bits for any threads.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "etendue/describe/color.h"
#include "etendue/render/renderer.h"
#include "support/render_support.h"

namespace etendue {
namespace {

/// Radiance of known mean 1: constant, except in a square of 8 x 8 pixels (or everywhere), where one sample in `rarity` has it
/// all.
class RareLight final : public Renderer {
 public:
  int rarity = 4;
  bool everywhere = false;
  static void describe(Description<RareLight>& d) {
    d.summary("Light of mean 1 that is rare in one place; for tests.")
        .member<&RareLight::rarity>("rarity", "1", "one sample of so many")
        .member<&RareLight::everywhere>("everywhere", "", "whether it is rare everywhere");
  }
  Spectrum radiance(const RenderContext&, const Ray& ray, SampleContext& sample) const override {
    const float chance = sample.numbers.next();
    const Spectrum white = rgb_white(sample.wavelengths);
    // The camera looks along +z from the origin with a field of view of 90 degrees: the square is at the lower left.
    const float x = ray.direction.x / ray.direction.z, y = ray.direction.y / ray.direction.z;
    if (!everywhere && (x > -0.5f || y > -0.5f)) return white;
    return chance * float(rarity) < 1 ? white * float(rarity) : Spectrum();
  }

 private:
  /// A spectrum of Y = 1.
  static Spectrum rgb_white(const Wavelengths& w) {
    static const Color white = rgb_space("srgb").illuminant;
    return white->evaluate(w, ColorUse::radiance);
  }
};

Ref<Job> job(const std::string& renderer, int samples) {
  static const Register<RareLight> registered;  // only once this test runs: other tests go through all renderers
  const Ref<Job> made =
      load_job_text(test::job_text(renderer, "PerspectiveCamera { from: [0, 0, 0] m, to: [0, 0, 1] m, fov: 90 deg }", 32,
                                   "Sphere { centre: [0, 0, -9] m }"),
                    "test.etd");
  made->renderer->samples = samples;
  return made;
}
const std::string adaptive =
                      "AdaptiveSampling { sampler: IndependentSampler {}, inner: RareLight { rarity: 512, everywhere: true } }",
                  uniform = "RareLight { sampler: IndependentSampler {}, rarity: 512, everywhere: true }";

/// The mean of Y over the image, and the mean squared error of pixels against 1.
struct Outcome {
  double mean = 0, error = 0;
};
Outcome outcome(const Image& image) {
  Outcome o;
  const double pixels = double(image.width) * image.height;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      o.mean += image.at(x, y, 1) / pixels;
      o.error += (image.at(x, y, 1) - 1) * (image.at(x, y, 1) - 1) / pixels;
    }
  return o;
}

/// Over renders with different seeds: the mean of the images' means, its standard error, and the mean squared error of pixels.
struct Statistics {
  double mean = 0, deviation = 0, error = 0;
};
Statistics over_seeds(const std::string& renderer, int samples, int renders) {
  const std::unique_ptr<Render> render = test::rendered(job(renderer, samples));
  double sum = 0, squares = 0, error = 0;
  for (int seed = 1; seed <= renders; ++seed) {
    test::render_again(*render, std::uint64_t(seed));
    const Outcome o = outcome(render->picture());
    sum += o.mean;
    squares += o.mean * o.mean;
    error += o.error / renders;
  }
  const double mean = sum / renders;
  return {mean, std::sqrt((squares / renders - mean * mean) / (renders - 1)), error};
}

// In the first step, the 25 pixels of an estimate have 8 samples each, with no bright one in two of three cases. Pixels with a
// bright sample then get many samples, the others few: if all samples had the same weight, bright samples would be averaged
// away. A deviation of 4 standard errors has the probability 6e-5.
TEST(AdaptiveSampling, MeansAreTheTruthWhereBrightSamplesAreRare) {
  const Statistics found = over_seeds(adaptive, 32, 60), even = over_seeds(uniform, 32, 60);
  EXPECT_NEAR(found.mean, 1, 4 * found.deviation) << "standard error " << found.deviation;
  EXPECT_NEAR(even.mean, 1, 4 * even.deviation) << "standard error " << even.deviation;
  EXPECT_LT(found.deviation, 0.05) << "nothing would be noticed";
}

TEST(AdaptiveSampling, ErrorsAreLessWhereNoiseIsLocal) {
  const std::string numbers = "sampler: IndependentSampler {}", often = "RareLight { rarity: 4 }";
  const Statistics found = over_seeds("AdaptiveSampling { " + numbers + ", inner: " + often + " }", 64, 8),
                   even = over_seeds("RareLight { rarity: 4, " + numbers + " }", 64, 8);
  // A sixteenth of the image has all the noise and gets up to 8 times the samples. The first of 8 steps is uniform. With
  // weights 1/8 each, the variance is 1/8 + 7/8 / 8 = 0.23 of that of uniform samples.
  EXPECT_LT(found.error, 0.4 * even.error) << found.error << " " << even.error;
  // With most: 1 all pixels get the same number of samples, and the error is that of uniform sampling.
  const Statistics off = over_seeds("AdaptiveSampling { most: 1, " + numbers + ", inner: " + often + " }", 64, 8);
  EXPECT_NEAR(off.error / even.error, 1, 0.3);
}

TEST(AdaptiveSampling, TheErrorThatIsToldIsTheErrorThatIsMade) {
  const Ref<Job> one = job("AdaptiveSampling { sampler: IndependentSampler {}, inner: RareLight { rarity: 4 } }", 256);
  one->image->layers = {"variance", "samples"};
  const Image image = test::rendered(one)->picture();
  double told = 0, made = 0, samples = 0, corners[4] = {};
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      told += image.at(x, y, 3);
      made += (image.at(x, y, 1) - 1) * (image.at(x, y, 1) - 1);
      samples += image.at(x, y, 4) / 1024;
      if ((x < 8 || x >= 24) && (y < 8 || y >= 24)) corners[(x < 8) + 2 * (y < 8)] += image.at(x, y, 4) / 64;
    }
  EXPECT_NEAR(samples, 256, 1) << "the mean number of samples";
  std::ranges::sort(corners);
  EXPECT_GT(corners[3], 3 * 256) << "where the noise is";
  EXPECT_LT(corners[2], 256) << "where none is";
  // `made` is a sum of 64 squared normal errors, with a relative deviation of 18 %; `told` varies with the variance of 32
  // steps.
  EXPECT_NEAR(told / made, 1, 0.6);
}

TEST(AdaptiveSampling, TheSameBitsForAnyThreadsAndAfterABreak) {
  const auto picture = [](int threads, int first) {
    const Ref<Job> made = job(adaptive, 100);
    RenderSettings settings;
    settings.threads = threads;
    Render render(made, settings);
    for (int i = 0; i < first; ++i) render.step();
    if (first == 0) {
      render.run();
      return render.picture().values;
    }
    std::stringstream state;
    render.save(state);
    Render other(job(adaptive, 100), settings);
    other.load(state);
    other.run();
    return other.picture().values;
  };
  const std::vector<double> once = picture(1, 0);
  EXPECT_EQ(once, picture(3, 0));
  EXPECT_EQ(once, picture(2, 5));
}

TEST(AdaptiveSampling, WhatWouldHaveNoEffectIsRefusedWhereItIsWritten) {
  const std::pair<const char*, const char*> written[] = {
      {"light_sampler: UniformLightSampler {}, inner: PathTracer {}",
       "AdaptiveSampling has no member 'light_sampler': the renderer inside"},
      {"map_filter: 2, inner: PathTracer {}", "AdaptiveSampling has no member 'map_filter': the renderer inside"},
      {"inner: PathTracer { samples: 64 }", "PathTracer.samples"},
      {"inner: PathTracer { sampler: IndependentSampler {} }", "PathTracer.sampler"}};
  for (const auto& [members, told] : written) {
    try {
      Render(job("AdaptiveSampling { " + std::string(members) + " }", 8)).run();
      ADD_FAILURE() << members << " was taken";
    } catch (const std::exception& error) {
      EXPECT_EQ(std::string(error.what()).find(told), 0u) << error.what();
    }
  }
  EXPECT_NO_THROW(Render(job("AdaptiveSampling { inner: PathTracer { light_sampler: UniformLightSampler {} } }", 8)).run());
}

TEST(AdaptiveSampling, WhatHasNoPixelsOfItsOwnIsRefused) {
  for (const char* inner : {"BidirectionalPathTracer {}", "LightTracer {}", "PrimarySampleMetropolis {}", "none"}) {
    const Ref<Job> made = job("AdaptiveSampling { inner: " + std::string(inner) + " }", 8);
    try {
      Render(made).run();
      ADD_FAILURE() << inner << " was taken";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("AdaptiveSampling.inner"), std::string::npos) << error.what();
    }
  }
}

TEST(AdaptiveSampling, AFirstStepThatIsAbortedIsMadeAgain) {
  const std::unique_ptr<Render> straight = test::rendered(job(adaptive, 16));
  Render* running = nullptr;
  RenderSettings settings;
  settings.progress_interval = 0;
  int calls = 0;
  settings.on_progress = [&](const Progress&) {
    if (++calls == 1) running->abort();
  };
  Render render(job(adaptive, 16), settings);
  running = &render;
  EXPECT_EQ(render.run(), Ended::aborted);
  EXPECT_EQ(render.run(), Ended::samples);
  EXPECT_TRUE(render.film().save_state() == straight->film().save_state());
}

}  // namespace
}  // namespace etendue
