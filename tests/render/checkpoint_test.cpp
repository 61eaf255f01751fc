// Checkpoints: renders that are stopped and continued.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstring>

#include "support/checkpoint_test_support.h"

namespace etendue::checkpoint_test {
namespace {

// ---- ranges -------------------------------------------------------------------------------------------------------------

TEST(CheckpointRanges, are_sorted_joined_and_subtracted) {
  std::vector<IndexRange> ranges;
  const auto expect = [&](const std::vector<IndexRange>& expected) { EXPECT_EQ(ranges, expected); };
  insert(ranges, {8, 12});
  insert(ranges, {0, 2});
  insert(ranges, {5, 5});
  expect({{0, 2}, {8, 12}});
  insert(ranges, {12, 14});
  expect({{0, 2}, {8, 14}});
  EXPECT_EQ(count(ranges), 8u);
  EXPECT_EQ(missing(ranges, {0, 20}), (std::vector<IndexRange>{{2, 8}, {14, 20}}));
  EXPECT_EQ(missing(ranges, {3, 5}), (std::vector<IndexRange>{{3, 5}}));
  EXPECT_EQ(missing(ranges, {9, 14}), std::vector<IndexRange>());
  EXPECT_EQ(missing({}, {1, 2}), (std::vector<IndexRange>{{1, 2}}));
  EXPECT_EQ(samples_text(ranges), "samples 0 to 1, 8 to 13");
  EXPECT_EQ(samples_text({{3, 4}}), "sample 3");
  drop_short_pass(ranges, 4);
  expect({{0, 2}, {8, 12}});
  insert(ranges, {1, 9});
  expect({{0, 12}});
  ranges = {{0, 3}};
  drop_short_pass(ranges, 4);
  expect({});
}

// ---- going on -----------------------------------------------------------------------------------------------------------

TEST_F(CheckpointTest, a_render_that_was_stopped_and_continued_has_the_same_bits) {
  const std::string text = ball_text("PathTracer { max_depth: 3 }",
                                     "width: 2, layers: [\"albedo\", \"normal\", \"depth\", \"object\", \"variance\", "
                                     "\"samples\"], path_lengths: 3");
  const int samples = 3 * step + 100;
  const auto straight = rendered(job_of(text, samples), two_threads);

  Render first(job_of(text, samples), {.threads = 2,
                                       .on_progress = [&](const Progress&) { first.stop(); },
                                       .progress_interval = 0,
                                       .checkpoint_file = folder / "state"});
  EXPECT_EQ(first.run(), Ended::interrupted);
  EXPECT_EQ(first.samples_done(), (std::vector<IndexRange>{{0, step}}));
  EXPECT_NE(film(first), film(*straight));

  std::vector<double> fractions;
  Progress last;
  const auto note = [&](const Progress& p) {
    fractions.push_back(p.fraction);
    last = p;
  };
  const auto second =
      continued(job_of(text, samples), folder / "state",
                {.threads = 1, .on_progress = note, .progress_interval = 0, .checkpoint_file = folder / "state"});
  EXPECT_TRUE(film(*second) == film(*straight));
  EXPECT_EQ(second->picture().metadata.at("samples"), std::to_string(samples));
  EXPECT_GE(fractions.front(), double(step) / samples);
  EXPECT_TRUE(std::ranges::is_sorted(fractions));
  EXPECT_EQ(last.samples, std::uint32_t(samples));
  EXPECT_EQ(fractions.back(), 1);

  // A finished render that is loaded is not changed by run(), and can be restarted.
  second->load(folder / "state");
  EXPECT_EQ(second->run(), Ended::samples);
  EXPECT_TRUE(film(*second) == film(*straight));
  test::render_again(*second, 5);
  EXPECT_FALSE(film(*second) == film(*straight));
  test::render_again(*second, 0);
  EXPECT_TRUE(film(*second) == film(*straight));
}

/// The Error of a render whose first step is not step 0.
std::string late_complaint(const Ref<Job>& job, IndexRange passes) {
  return complaint([&] { rendered(job, {.threads = 2, .steps = passes}); });
}

TEST_F(CheckpointTest, every_renderer_continues_to_the_same_bits_and_merges) {
  int tried = 0;
  for (const ClassInfo* info : Registry::instance().subclasses(*Registry::instance().find("Renderer"))) {
    SCOPED_TRACE(info->name);
    const auto described = [&](int samples) { return job_of(ball_text(info->name + " {}"), samples); };
    if (!complaint([&] { described(1); }).empty()) continue;
    const int own_step = int(described(1)->renderer->samples_per_step(std::uint32_t(step)));
    const auto fresh = [&] { return described(2 * own_step); };
    std::unique_ptr<Render> straight;
    if (!complaint([&] { straight = rendered(fresh(), two_threads); }).empty()) continue;  // the renderer refuses this scene
    ++tried;
    part(fresh(), "a", IndexRange{0, 1});
    EXPECT_TRUE(film(*continued(fresh(), folder / "a")) == film(*straight));
    if (straight->job().renderer->steps_depend()) {
      EXPECT_TRUE(has(late_complaint(fresh(), {1, 2}), "learns from one pass to the next"));
      continue;
    }
    part(fresh(), "b", IndexRange{1, 2});
    expect_same(merge_checkpoints({folder / "b", folder / "a"}), *straight);
  }
  EXPECT_GE(tried, 1);
}

TEST_F(CheckpointTest, every_sampler_continues_to_the_same_bits_and_merges) {
  for (const char* sampler : {"IndependentSampler", "SobolSampler", "HaltonSampler", "LatticeSampler", "PairsInQuadsSampler",
                              "Pmj02Sampler", "StratifiedSampler", "ZSobolSampler"}) {
    SCOPED_TRACE(sampler);
    const auto fresh = [&] {
      return job_of(ball_text(std::string("PathTracer { max_depth: 3, sampler: ") + sampler + " {} }"), 2 * step);
    };
    const std::unique_ptr<Render> straight = rendered(fresh(), two_threads);
    EXPECT_TRUE(film(*rendered(fresh(), {.threads = 1})) == film(*straight));
    part(fresh(), "a", IndexRange{0, 1});
    part(fresh(), "b", IndexRange{1, 2});
    EXPECT_TRUE(film(*continued(fresh(), folder / "a")) == film(*straight));
    expect_same(merge_checkpoints({folder / "b", folder / "a"}), *straight);
  }
}

/// Returns more radiance with each step.
class LearningProcess final : public RenderProcess {
 public:
  using RenderProcess::RenderProcess;
  void step(Schedule& schedule, const Step& step) override {
    RenderProcess::step(schedule, step);
    ++learned_;
  }
  Spectrum radiance(const Ray&, SampleContext&) const override { return Spectrum(float(1 + learned_)); }
  std::vector<std::byte> save_state() const override {
    std::vector<std::byte> bytes(sizeof learned_);
    std::memcpy(bytes.data(), &learned_, sizeof learned_);
    return bytes;
  }
  void load_state(std::span<const std::byte> bytes) override {
    ASSERT_EQ(bytes.size(), sizeof learned_);
    std::memcpy(&learned_, bytes.data(), sizeof learned_);
  }

 private:
  std::uint32_t learned_ = 0;
};

class LearningRenderer final : public Renderer {
 public:
  static void describe(Description<LearningRenderer>& d) { d.summary("For tests: learns from one step to the next."); }
  Expectation expectation() const override { return Expectation::biased; }
  bool steps_depend() const override { return true; }
  PathClasses finds() const override { return no_paths; }

 private:
  std::unique_ptr<RenderProcess> begin(const RenderContext& context) const override {
    return std::make_unique<LearningProcess>(*this, context);
  }
};

TEST_F(CheckpointTest, what_a_renderer_learned_is_kept_and_not_torn_apart) {
  static const Register<LearningRenderer> registered;  // only once this test runs: other tests go through all renderers
  const auto fresh = [](int samples) { return job_of(ball_text("LearningRenderer {}"), samples); };
  const auto straight = rendered(fresh(3 * step), two_threads);
  part(fresh(3 * step), "a", IndexRange{0, 2});
  EXPECT_TRUE(film(*continued(fresh(3 * step), folder / "a")) == film(*straight));

  // Also from the state before a short last step.
  part(fresh(step + 7), "short");
  EXPECT_TRUE(film(*continued(fresh(3 * step), folder / "short")) == film(*straight));

  EXPECT_TRUE(has(late_complaint(fresh(3 * step), {2, 3}), "learns from one pass to the next"));
  Checkpoint c = read_checkpoint(folder / "a");
  c.done = {{2 * step, 3 * step}};
  write_checkpoint(c, folder / "b");
  EXPECT_TRUE(has(complaint([&] { merge_checkpoints({folder / "a", folder / "b"}); }), "learns from one pass to the next"));
}

TEST_F(CheckpointTest, more_samples_continue_a_finished_render_to_the_same_bits) {
  const int few = step + 1000, many = 2 * step + 500;
  const auto straight = rendered(ball(many), two_threads);
  part(ball(few), "state");
  EXPECT_TRUE(read_checkpoint(folder / "state").before_short_pass.has_value());

  // Already finished: nothing is rendered, and the state before the short last step is kept.
  continued(ball(few), folder / "state", {.threads = 2, .checkpoint_file = folder / "copy"});
  EXPECT_TRUE(read_checkpoint(folder / "copy").before_short_pass.has_value());

  const auto longer = continued(ball(many), folder / "copy");
  EXPECT_EQ(longer->samples_done(), (std::vector<IndexRange>{{0, std::uint32_t(many)}}));
  EXPECT_TRUE(film(*longer) == film(*straight));

  // Without that state the short step is completed by a further one: the same samples in another order.
  Checkpoint c = read_checkpoint(folder / "state");
  c.before_short_pass.reset();
  write_checkpoint(c, folder / "without");
  const auto completed = continued(ball(many), folder / "without");
  EXPECT_EQ(completed->film().samples(), straight->film().samples());
  EXPECT_LE(relative_difference(completed->picture(), straight->picture()), 1e-12);

  EXPECT_TRUE(has(complaint([&] { continued(ball(step), folder / "state"); }), "it holds samples 0 to 17383"));
}

TEST_F(CheckpointTest, seconds_add_up_and_limits_mean_the_whole) {
  part(ball(step), "state");
  Checkpoint c = read_checkpoint(folder / "state");
  EXPECT_GT(c.seconds, 0);
  c.seconds = 1000;
  write_checkpoint(c, folder / "state");
  const auto ended_within = [&](double time_limit, double error_limit) {
    const Ref<Job> job = ball(3 * step);
    job->time_limit = time_limit;
    job->error_limit = error_limit;
    Render render(job, two_threads);
    render.load(folder / "state");
    const Ended ended = render.run();
    EXPECT_EQ(count(render.samples_done()), std::uint32_t(step));
    return ended;
  };
  EXPECT_EQ(ended_within(999, 0), Ended::time);
  EXPECT_EQ(ended_within(0, 1e3), Ended::error);
  Progress last;
  continued(ball(3 * step), folder / "state",
            {.threads = 2, .on_progress = [&](const Progress& p) { last = p; }, .checkpoint_file = folder / "state"});
  EXPECT_GT(last.seconds, 1000);
  EXPECT_LT(last.samples_per_second, 3 * step * 2 / 1000.0);
  EXPECT_GT(read_checkpoint(folder / "state").seconds, 1000);
}

TEST_F(CheckpointTest, a_checkpoint_that_cannot_be_written_does_not_end_a_render) {
  const auto render =
      rendered(ball(2 * step), {.threads = 2, .checkpoint_file = folder / "no/such/folder", .checkpoint_interval = 0});
  EXPECT_EQ(count(render->samples_done()), 2u * step);
  EXPECT_TRUE(has(render->checkpoint_failure(), "no/such")) << render->checkpoint_failure();
}

TEST_F(CheckpointTest, leftovers_of_killed_processes_are_removed) {
  const std::string dead = folder.write(".state.part-4194305", "half");  // no process has an id above 2^22
  const std::string other = folder.write(".else.part-4194305", "half"),
                    own = folder.write(fmt::format(".state.part-{}", getppid()), "");
  remove_leftovers(folder / "state");
  EXPECT_FALSE(std::filesystem::exists(dead));
  EXPECT_TRUE(std::filesystem::exists(other) && std::filesystem::exists(own));
}

}  // namespace
}  // namespace etendue::checkpoint_test
