#pragma once
// Renders descriptions for tests, and measures the images.

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "etendue/language/language.h"
#include "etendue/render/render.h"

namespace etendue::test {

/// A render of a job, run up to all its samples.
inline std::unique_ptr<Render> rendered(const Ref<Job>& job, RenderSettings settings = {}) {
  auto render = std::make_unique<Render>(job, std::move(settings));
  EXPECT_EQ(render->run(), Ended::samples);
  return render;
}

/// Renders again, with another seed.
inline void render_again(Render& render, std::uint64_t seed) {
  render.restart(seed);
  EXPECT_EQ(render.run(), Ended::samples);
}

struct Measured {
  Xyz mean;          ///< over all pixels
  double error = 0;  ///< standard error of the mean Y, from the samples' variance
  std::uint64_t bad = 0;
};

inline Measured measure(const Ref<Job>& job) {
  job->image->layers = {"variance"};
  const std::unique_ptr<Render> render = rendered(job);
  const Image image = render->picture();
  const size_t variance =
      size_t(std::find(image.channels.begin(), image.channels.end(), "variance.Y") - image.channels.begin());
  Measured m;
  double sum = 0;
  const double pixels = double(image.width) * image.height;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      m.mean += Xyz{image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
      sum += image.at(x, y, variance);
    }
  m.mean = (1 / pixels) * m.mean;
  m.error = std::sqrt(sum) / pixels;
  m.bad = render->film().bad_samples();
  return m;
}

inline Measured measure(const std::string& text) { return measure(load_job_text(text, "test.etd")); }

/// The text of a job with a given renderer, camera, image size and objects.
inline std::string job_text(const std::string& renderer, const std::string& camera, int size, const std::string& objects,
                            const std::string& scene = "BruteForceScene") {
  return "Job {\n renderer: " + renderer + "\n camera: " + camera + "\n image: ImageBuffer { width: " + std::to_string(size) +
         ", height: " + std::to_string(size) + ", filter: BoxFilter {} }\n scene: " + scene + " { objects: [\n" + objects +
         "\n] }\n}\n";
}

}  // namespace etendue::test
