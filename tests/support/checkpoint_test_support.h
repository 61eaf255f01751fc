#pragma once
// Shared by tests of checkpoints: a small scene, and renders of single steps into files.

#include <gtest/gtest.h>

#include <cmath>

#include "program_support.h"
#include "render/checkpoint.h"
#include "render_support.h"

namespace etendue::checkpoint_test {

using test::rendered;

// With an image of so few pixels, a step has 16384 samples of each.
inline constexpr int step = 16384;

inline std::string ball_text(const std::string& renderer = "PathTracer { max_depth: 3 }", const std::string& image = "width: 2",
                             const std::string& ball = "0.5", const std::string& rest = "") {
  return "Job {\n renderer: " + renderer +
         "\n camera: PerspectiveCamera { from: [0, 0, -4] m, to: [0, 0, 0] m, fov: 40 deg }\n" +
         " image: ImageBuffer { height: 1, " + image + " }\n scene: BruteForceScene { objects: [\n" +
         "  Sphere { radius: 1 m, shader: Lambertian { color: " + ball + " } }\n" +
         "  Sphere { centre: [0, 2, -1] m, radius: 0.5 m, emission: DiffuseEmission { radiance: 5 } }\n ] }\n" + rest + "}\n";
}

inline Ref<Job> job_of(const std::string& text, int samples) {
  const Ref<Job> job = load_job_text(text, "test.etd");
  job->renderer->samples = samples;
  return job;
}
inline Ref<Job> ball(int samples) { return job_of(ball_text(), samples); }

/// More than one thread on any machine.
inline const RenderSettings two_threads{.threads = 2};

/// A render of a job that continues from a checkpoint up to all its samples.
inline std::unique_ptr<Render> continued(const Ref<Job>& job, const std::string& file,
                                         const RenderSettings& settings = two_threads) {
  auto render = std::make_unique<Render>(job, settings);
  render->load(file);
  EXPECT_EQ(render->run(), Ended::samples);
  return render;
}

/// The state of the film, for comparison bit by bit.
inline std::vector<std::byte> film(const Render& render) { return render.film().save_state(); }

/// Expects that a checkpoint, and the image stored in it, equal the state and the image of a render.
inline void expect_same(const Checkpoint& c, const Render& render) {
  EXPECT_TRUE(c.state.image == film(render));
  const Image kept = picture_of(c).picture, picture = render.picture();
  EXPECT_EQ(kept.channels, picture.channels);
  EXPECT_TRUE(kept.values == picture.values);
  for (const char* key : {"samples", "seed", "renderer", "version"}) EXPECT_EQ(kept.metadata.at(key), picture.metadata.at(key));
}

/// The largest difference of two images in any channel, relative to that channel's largest value.
inline double relative_difference(const Image& a, const Image& b) {
  EXPECT_EQ(a.channels, b.channels);
  double worst = 0;
  for (size_t c = 0; c < a.channels.size(); ++c) {
    double largest = 0, difference = 0;
    for (int y = 0; y < a.height; ++y)
      for (int x = 0; x < a.width; ++x) {
        largest = std::max(largest, std::abs(double(a.at(x, y, c))));
        difference = std::max(difference, std::abs(double(a.at(x, y, c)) - double(b.at(x, y, c))));
      }
    if (difference > 0) worst = std::max(worst, difference / largest);
  }
  return worst;
}

/// The message of the Error that an action throws; empty: it throws none.
template <class F>
std::string complaint(F&& f) {
  try {
    f();
  } catch (const Errors& errors) {
    std::string text;
    for (const Error& error : errors.errors) text += std::string(error.what()) + "\n";
    return text;
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

inline bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

class CheckpointTest : public RunsProgram {
 protected:
  /// Renders these steps of a job into a checkpoint file.
  std::string part(const Ref<Job>& job, const std::string& name, std::optional<IndexRange> passes = {}) {
    std::string file = folder / name;
    EXPECT_EQ(rendered(job, {.threads = 2, .steps = passes, .checkpoint_file = file})->checkpoint_failure(), "");
    return file;
  }
};

}  // namespace etendue::checkpoint_test
