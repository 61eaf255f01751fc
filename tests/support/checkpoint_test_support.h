#pragma once
// What tests of checkpoints share: a small scene, and a folder of parts.

#include <gtest/gtest.h>

#include <cmath>

#include "program_support.h"
#include "render/checkpoint.h"
#include "render_support.h"

namespace etendue::checkpoint_test {

// A pass of a picture of so few pixels is 16384 samples of each.
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
  job->threads = 2;
  return job;
}
inline Ref<Job> ball(int samples) { return job_of(ball_text(), samples); }

/// All that was collected, bit by bit.
inline std::vector<std::byte> film(const Job& job) { return job.film().save_state(); }

/// The largest difference of two pictures in any channel, relative to that channel's largest value.
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

/// What an action throws; empty: nothing.
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
  /// Renders passes of a job into a file.
  std::string part(const Ref<Job>& job, const std::string& name, std::optional<IndexRange> passes = {}) {
    job->checkpoint_file = folder / name;
    job->passes = passes;
    EXPECT_EQ(job->render(), Ended::samples);
    EXPECT_EQ(job->checkpoint_failure(), "");
    return job->checkpoint_file;
  }
};

}  // namespace etendue::checkpoint_test
