// A render's thread: whatever commands it gets, however soon after each other, it reaches the state of the last one.

#include "studio/pixels/runner.h"

#include <gtest/gtest.h>

#include <chrono>

#include "etendue/render/job.h"

namespace etendue::studio {
namespace {

constexpr const char* scene = R"(Job {
    renderer: PathTracer { samples: 2, max_depth: 2 }
    camera: PerspectiveCamera { from: [0, 0, -5], to: [0, 0, 0] }
    image: ImageBuffer { width: 8, height: 8 }
    scene: BvhScene { objects: [ Sphere { radius: 1, emission: DiffuseEmission { radiance: 3 } } ] }
})";

/// Whether the runner reaches a state within ten seconds.
bool comes_to(const Runner& runner, Runner::State state) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (runner.status().state != state) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

class StudioRunner : public testing::Test {
 protected:
  Turns turns_;
  Runner runner_{turns_};
  std::shared_ptr<Render> render_ = std::make_shared<Render>(load_job_text(scene, "scene"), RenderSettings{.threads = 1});
};

TEST_F(StudioRunner, APauseThatOvertakesTheBeginningIsSaid) {
  runner_.set(render_);
  runner_.start();
  ASSERT_TRUE(comes_to(runner_, Runner::State::finished));
  // From here on the render has more to do, and its thread may not have woken before it gets the command to pause.
  for (int i = 0; i < 300; ++i) {
    render_->edit(*render_->job().renderer, "samples", Value(Number{1e9}));
    runner_.follow(render_);
    const bool now = i % 2 != 0;
    now ? runner_.stop() : runner_.pause();
    ASSERT_TRUE(comes_to(runner_, Runner::State::paused)) << "round " << i;
    render_->edit(*render_->job().renderer, "samples", Value(Number{2}));
    runner_.start();
    ASSERT_TRUE(comes_to(runner_, Runner::State::finished)) << "round " << i;
  }
}

TEST_F(StudioRunner, APauseOfWhatIsDoneLeavesItDone) {
  runner_.set(render_);
  runner_.start();
  ASSERT_TRUE(comes_to(runner_, Runner::State::finished));
  runner_.pause();
  EXPECT_EQ(runner_.status().state, Runner::State::finished);
}

}  // namespace
}  // namespace etendue::studio
