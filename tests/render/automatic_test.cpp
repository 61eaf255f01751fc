// Automatic: no bias whatever the trials find, the algorithm that suits a scene, the same bits for any threads and after a
// break.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "etendue/describe/color.h"
#include "etendue/render/renderer.h"
#include "support/render_support.h"

namespace etendue {
namespace {

/// Light of mean 1 in all pixels: one path in `rarity` has it all.
class RareEverywhere final : public Renderer {
 public:
  int rarity = 4;
  static void describe(Description<RareEverywhere>& d) {
    d.summary("Light of mean 1 that is rare; for tests.")
        .member<&RareEverywhere::rarity>("rarity", "1", "one sample of so many");
  }
  Spectrum radiance(const RenderContext&, const Ray&, SampleContext& sample) const override {
    static const Color white = rgb_space("srgb").illuminant;
    const Point2 u = sample.numbers.next_pair();
    return u.x * float(rarity) < 1 ? white->evaluate(sample.wavelengths, ColorUse::radiance) * float(rarity) : Spectrum();
  }
};

Ref<Job> flat_job(const std::string& candidates, int samples) {
  static const Register<RareEverywhere> registered;  // only once this test runs: other tests go through all renderers
  const Ref<Job> made =
      load_job_text(test::job_text("Automatic { sampler: IndependentSampler {}, candidates: [" + candidates + "] }",
                                   "PerspectiveCamera { from: [0, 0, 0] m, to: [0, 0, 1] m, fov: 90 deg }", 96,
                                   "Sphere { centre: [0, 0, -9] m }"),
                    "test.etd");
  made->renderer->samples = samples;
  return made;
}

/// A box that is open to one side, with a small lamp behind a shade: light arrives by way of the ceiling.
Ref<Job> shaded_lamp(const std::string& renderer, int samples, int size = 64) {
  const Ref<Job> made = load_job_text(
      test::job_text(renderer, "PerspectiveCamera { from: [0, 0, -3.2] m, to: [0, 0, 0] m, fov: 40 deg }", size,
                     "Sphere { radius: 4 m, shader: Lambertian { color: 0.5 } },\n"
                     "Sphere { centre: [0, 0.6, 0] m, radius: 0.1 m, emission: DiffuseEmission { radiance: 10 } },\n"
                     "Disc { transform: translate(0, 0.4 m, 0) * rotate(90, \"x\"), radius: 0.6 m, shader: Lambertian "
                     "{ color: 0.7 } }"),
      "test.etd");
  made->renderer->samples = samples;
  return made;
}

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

std::string choice(const Render& render) {
  const auto metadata = render.snapshot().metadata;
  const auto found = metadata.find("choice");
  return found == metadata.end() ? std::string() : found->second;
}

// Two algorithms of equal cost, whose samples have variances 63 and 1. The trial at sample 32 finds the second. Then 32 samples
// count once and 32 count 32 or 64 times: with 64, the variance is (32 * 63 + 32 * 64^2) / (32 + 32 * 64)^2 = 0.031, of which
// nearly all is that of the second's 32 samples, 1/32. Equal weights would give (32 * 63 + 32) / 64^2 = 0.5.
TEST(Automatic, TheBetterAlgorithmIsFoundAndItsSamplesCountMore) {
  const std::unique_ptr<Render> render =
      test::rendered(flat_job("RareEverywhere { rarity: 64 }, RareEverywhere { rarity: 2 }", 64));
  const Outcome o = outcome(render->picture());
  EXPECT_LT(o.error, 0.08);
  EXPECT_GT(o.error, 0.02);
  EXPECT_NE(choice(*render).find("RareEverywhere: trials up to sample"), std::string::npos) << choice(*render);
}

// Where all algorithms are alike, the choice depends on chance; the mean must not. A deviation of 4 standard errors has the
// probability 6e-5. That trials are not shown is what is tested: algorithms that look best when they have found little light
// would make the picture darker.
TEST(Automatic, MeansAreTheTruthThoughTheChoiceDependsOnChance) {
  const std::unique_ptr<Render> render =
      test::rendered(flat_job("RareEverywhere { rarity: 200 }, RareEverywhere { rarity: 201 }", 40));
  double sum = 0, squares = 0;
  constexpr int renders = 24;
  for (int seed = 1; seed <= renders; ++seed) {
    test::render_again(*render, std::uint64_t(seed));
    const double mean = outcome(render->picture()).mean;
    sum += mean;
    squares += mean * mean;
  }
  const double mean = sum / renders, deviation = std::sqrt((squares / renders - mean * mean) / (renders - 1));
  EXPECT_NEAR(mean, 1, 4 * deviation) << "standard error " << deviation;
  EXPECT_LT(deviation, 0.01) << "nothing would be noticed";
}

// Splats, a guide and camera paths in one picture: the mean is that of a path tracer, whichever algorithm is chosen.
TEST(Automatic, EachAlgorithmGivesTheSamePicture) {
  const test::Measured truth = test::measure(shaded_lamp("PathTracer { max_depth: 4 }", 128, 96));
  for (const char* second : {"GuidedPathTracer {}", "BidirectionalPathTracer {}", "LightTracer {}"}) {
    // A path tracer that samples no luminaires is always worse.
    const Ref<Job> job = shaded_lamp(
        "Automatic { max_depth: 4, candidates: [PathTracer { next_event: false }, " + std::string(second) + "] }", 64, 96);
    const std::unique_ptr<Render> render = test::rendered(job);
    const Outcome o = outcome(render->picture());
    EXPECT_EQ(choice(*render).find(std::string(second).substr(0, 6)), 0u) << choice(*render);
    EXPECT_NEAR(o.mean / truth.mean.y, 1, 0.03) << second;
  }
}

TEST(Automatic, APreviewIsThatOfTheFirstAlgorithmToTheBit) {
  const std::unique_ptr<Render> automatic = test::rendered(shaded_lamp("Automatic {}", 8)),
                                plain = test::rendered(shaded_lamp("PathTracer {}", 8));
  EXPECT_EQ(automatic->picture().values, plain->picture().values);
  EXPECT_EQ(choice(*automatic), "");
}

TEST(Automatic, TheSameBitsForAnyThreadsAndAfterABreak) {
  const auto bytes = [](int threads, int first) {
    const std::string text =
        "Automatic { max_depth: 4, candidates: [PathTracer { next_event: false }, GuidedPathTracer {}, "
        "BidirectionalPathTracer {}] }";
    RenderSettings settings;
    settings.threads = threads;
    Render render(shaded_lamp(text, 160, 64), settings);
    if (first == 0) {
      render.run();
      return std::pair(render.film().save_state(), choice(render));
    }
    while (render.progress().samples < std::uint32_t(first)) render.step();
    std::stringstream state;
    render.save(state);
    Render other(shaded_lamp(text, 160, 64), settings);
    other.load(state);
    other.run();
    return std::pair(other.film().save_state(), choice(other));
  };
  const auto once = bytes(1, 0);
  EXPECT_NE(once.second, "");
  EXPECT_TRUE(once == bytes(3, 0));
  for (const int after : {20, 100, 130})  // before any trial, between two, after both
    EXPECT_TRUE(once == bytes(2, after)) << after;
}

TEST(Automatic, AnAlgorithmThatLosesLightOfTheSceneIsNotUsed) {
  // Only paths from the lamp find the caustic of a point light.
  const Ref<Job> made = load_job_text(
      test::job_text("Automatic { samples: 4 }", "PerspectiveCamera { from: [0, 2, -4] m, to: [0, 0, 0] m, fov: 40 deg }", 16,
                     "InfinitePlane { shader: Lambertian {} }, Sphere { centre: [0, 1, 0] m, radius: 0.5 m, "
                     "shader: PerfectSpecular {} },\n"
                     "Point { position: [1, 3, 0] m, emission: DiffuseEmission { radiance: 10 } }"),
      "test.etd");
  const std::unique_ptr<Render> render = test::rendered(made);
  EXPECT_EQ(choice(*render).find("BidirectionalPathTracer, the only one"), 0u) << choice(*render);
}

TEST(Automatic, WhatCannotBeTriedIsRefusedWhereItIsWritten) {
  const std::pair<const char*, const char*> written[] = {
      {"PhotonMapper {}", "Automatic.candidates: PhotonMapper is biased"},
      {"PrimarySampleMetropolis {}", "Automatic.candidates: PrimarySampleMetropolis does not take its samples independent"},
      {"none", "Automatic.candidates: an algorithm is none"},
      {"PathTracer { samples: 8 }", "PathTracer.samples: has no effect here"},
      {"PathTracer { max_depth: 8 }", "PathTracer.max_depth: has no effect here"},
      {"", "Automatic.candidates: needs at least one algorithm"}};
  for (const auto& [candidates, told] : written) {
    try {
      Render(shaded_lamp("Automatic { candidates: [" + std::string(candidates) + "] }", 8)).run();
      ADD_FAILURE() << candidates << " was taken";
    } catch (const std::exception& error) {
      EXPECT_EQ(std::string(error.what()).find(told), 0u) << error.what();
    }
  }
}

}  // namespace
}  // namespace etendue
