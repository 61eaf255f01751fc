// Renders that are stopped, continued, rendered in parts and merged.

#include "job/checkpoint.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "process.h"
#include "render_support.h"

namespace etendue {
namespace {

// A pass of a picture of so few pixels is 16384 samples of each.
constexpr int step = 16384;

std::string ball_text(const std::string& renderer = "PathTracer { max_depth: 3 }", const std::string& image = "width: 2",
                      const std::string& ball = "0.5", const std::string& rest = "") {
  return "Job {\n renderer: " + renderer +
         "\n camera: PerspectiveCamera { from: [0, 0, -4] m, to: [0, 0, 0] m, fov: 40 deg }\n" +
         " image: ImageBuffer { height: 1, " + image + " }\n scene: BruteForceScene { objects: [\n" +
         "  Sphere { radius: 1 m, shader: Lambertian { color: " + ball + " } }\n" +
         "  Sphere { center: [0, 2, -1] m, radius: 0.5 m, emission: DiffuseEmission { radiance: 5 } }\n ] }\n" + rest + "}\n";
}

Ref<Job> job_of(const std::string& text, int samples) {
  const Ref<Job> job = load_job_text(text, "test.etd");
  job->renderer->samples = samples;
  job->threads = 2;
  return job;
}
Ref<Job> ball(int samples) { return job_of(ball_text(), samples); }

/// All that was collected, bit by bit.
std::vector<std::byte> film(const Job& job) { return job.image->save_state(); }

/// The largest difference of two pictures in any channel, relative to that channel's largest value.
double relative_difference(const Image& a, const Image& b) {
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

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

class CheckpointTest : public testing::Test {
 protected:
  /// Renders passes of a job into a file.
  std::string part(const Ref<Job>& job, const std::string& name, std::optional<IndexRange> passes = {}) {
    job->checkpoint_file = folder / name;
    job->passes = passes;
    EXPECT_EQ(job->render(), Ended::samples);
    EXPECT_EQ(job->checkpoint_failure(), "");
    return job->checkpoint_file;
  }
  TemporaryFolder folder;
};

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
  const Ref<Job> straight = job_of(text, samples);
  EXPECT_EQ(straight->render(), Ended::samples);

  const Ref<Job> first = job_of(text, samples);
  first->checkpoint_file = folder / "state";
  first->progress_interval = 0;
  first->on_progress = [&](const Progress&) { first->finish(); };
  EXPECT_EQ(first->render(), Ended::interrupted);
  EXPECT_EQ(first->samples_done(), (std::vector<IndexRange>{{0, step}}));
  EXPECT_NE(film(*first), film(*straight));

  const Ref<Job> second = job_of(text, samples);
  second->threads = 1;
  second->checkpoint_file = folder / "state";
  std::vector<double> fractions;
  Progress last;
  second->progress_interval = 0;
  second->on_progress = [&](const Progress& p) {
    fractions.push_back(p.fraction);
    last = p;
  };
  EXPECT_EQ(second->resume(folder / "state"), Ended::samples);
  EXPECT_TRUE(film(*second) == film(*straight));
  EXPECT_EQ(second->picture().metadata.at("samples"), std::to_string(samples));
  EXPECT_GE(fractions.front(), double(step) / samples);
  EXPECT_TRUE(std::ranges::is_sorted(fractions));
  EXPECT_EQ(last.samples, std::uint32_t(samples));
  EXPECT_EQ(fractions.back(), 1);

  // What is finished stays as it is, and the job can begin afresh.
  EXPECT_EQ(second->resume(folder / "state"), Ended::samples);
  EXPECT_TRUE(film(*second) == film(*straight));
  second->seed = 5;
  second->checkpoint_file.clear();
  EXPECT_EQ(second->render(), Ended::samples);
  EXPECT_FALSE(film(*second) == film(*straight));
  second->seed = 0;
  EXPECT_EQ(second->render(), Ended::samples);
  EXPECT_TRUE(film(*second) == film(*straight));
}

TEST_F(CheckpointTest, every_renderer_continues_to_the_same_bits_and_merges) {
  int tried = 0;
  for (const ClassInfo* info : Registry::instance().subclasses(*Registry::instance().find("Renderer"))) {
    SCOPED_TRACE(info->name);
    const auto fresh = [&] { return job_of(ball_text(info->name + " {}"), 2 * step); };
    const Ref<Job> straight = fresh();
    if (const std::string reason = complaint([&] { straight->render(); }); !reason.empty()) continue;  // not for this scene
    ++tried;
    part(fresh(), "a", IndexRange{0, 1});
    const Ref<Job> resumed = fresh();
    resumed->resume(folder / "a");
    EXPECT_TRUE(film(*resumed) == film(*straight));
    EXPECT_TRUE(resumed->renderer->save_state() == straight->renderer->save_state());

    if (!straight->renderer->save_state().empty()) {
      const Ref<Job> late = fresh();
      late->passes = IndexRange{1, 2};
      EXPECT_TRUE(has(complaint([&] { late->render(); }), "learns from one pass to the next"));
      continue;
    }
    part(fresh(), "b", IndexRange{1, 2});
    const Ref<Job> merged = job_with_picture(merge_checkpoints({folder / "b", folder / "a"}));
    EXPECT_EQ(merged->image->samples(), straight->image->samples());
    EXPECT_LE(relative_difference(merged->picture(), straight->picture()), 1e-12);
  }
  EXPECT_GE(tried, 1);
}

/// Brightens what it sees with each pass.
class LearningRenderer final : public Renderer {
 public:
  static void describe(Description<LearningRenderer>& d) { d.summary("For tests: learns from one pass to the next."); }
  void begin(const RenderContext&) override { learned_ = 0; }
  void pass(const RenderContext& context, Pass& pass) const override {
    Renderer::pass(context, pass);
    ++learned_;
  }
  Spectrum radiance(const RenderContext&, const Ray&, SampleContext&) const override { return Spectrum(float(1 + learned_)); }
  bool unbiased() const override { return false; }
  std::vector<Advice> misses(const SceneTraits&) const override { return {{"everything", ""}}; }
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
  mutable int learned_ = 0;
};

TEST_F(CheckpointTest, what_a_renderer_learned_is_kept_and_not_torn_apart) {
  static const Register<LearningRenderer> registered;  // only once this test runs: others go through all renderers
  const auto fresh = [](int samples) { return job_of(ball_text("LearningRenderer {}"), samples); };
  const Ref<Job> straight = fresh(3 * step);
  straight->render();
  part(fresh(3 * step), "a", IndexRange{0, 2});
  const Ref<Job> resumed = fresh(3 * step);
  resumed->resume(folder / "a");
  EXPECT_TRUE(film(*resumed) == film(*straight));

  // Also from before a short pass.
  part(fresh(step + 7), "short");
  const Ref<Job> longer = fresh(3 * step);
  longer->resume(folder / "short");
  EXPECT_TRUE(film(*longer) == film(*straight));

  const Ref<Job> late = fresh(3 * step);
  late->passes = IndexRange{2, 3};
  EXPECT_TRUE(has(complaint([&] { late->render(); }), "learns from one pass to the next"));
  Checkpoint c = read_checkpoint(folder / "a");
  c.done = {{2 * step, 3 * step}};
  write_checkpoint(c, folder / "b");
  EXPECT_TRUE(has(complaint([&] { merge_checkpoints({folder / "a", folder / "b"}); }), "learns from one pass to the next"));
}

TEST_F(CheckpointTest, more_samples_continue_a_finished_render_to_the_same_bits) {
  const int few = step + 1000, many = 2 * step + 500;
  const Ref<Job> straight = ball(many);
  straight->render();
  part(ball(few), "state");
  EXPECT_TRUE(read_checkpoint(folder / "state").before_short_pass.has_value());

  const Ref<Job> again = ball(few);  // finished already: nothing is rendered, and what came before the short pass stays
  again->checkpoint_file = folder / "copy";
  EXPECT_EQ(again->resume(folder / "state"), Ended::samples);
  EXPECT_TRUE(read_checkpoint(folder / "copy").before_short_pass.has_value());

  const Ref<Job> longer = ball(many);
  EXPECT_EQ(longer->resume(folder / "copy"), Ended::samples);
  EXPECT_EQ(longer->samples_done(), (std::vector<IndexRange>{{0, std::uint32_t(many)}}));
  EXPECT_TRUE(film(*longer) == film(*straight));

  // Without that state the short pass is completed by another: the same samples in another order.
  Checkpoint c = read_checkpoint(folder / "state");
  c.before_short_pass.reset();
  write_checkpoint(c, folder / "without");
  const Ref<Job> completed = ball(many);
  EXPECT_EQ(completed->resume(folder / "without"), Ended::samples);
  EXPECT_EQ(completed->image->samples(), straight->image->samples());
  EXPECT_LE(relative_difference(completed->picture(), straight->picture()), 1e-12);

  EXPECT_TRUE(has(complaint([&] { ball(step)->resume(folder / "state"); }), "it holds samples 0 to 17383"));
}

TEST_F(CheckpointTest, seconds_add_up_and_limits_mean_the_whole) {
  part(ball(step), "state");
  Checkpoint c = read_checkpoint(folder / "state");
  EXPECT_GT(c.seconds, 0);
  c.seconds = 1000;
  write_checkpoint(c, folder / "state");
  const Ref<Job> job = ball(3 * step);
  Progress last;
  job->on_progress = [&](const Progress& p) { last = p; };
  job->time_limit = 999;
  EXPECT_EQ(job->resume(folder / "state"), Ended::time);
  EXPECT_EQ(count(job->samples_done()), std::uint32_t(step));
  job->time_limit = 0;
  job->error_limit = 1e3;
  EXPECT_EQ(job->resume(folder / "state"), Ended::error);
  EXPECT_EQ(count(job->samples_done()), std::uint32_t(step));
  job->error_limit = 0;
  job->checkpoint_file = folder / "state";
  EXPECT_EQ(job->resume(folder / "state"), Ended::samples);
  EXPECT_GT(last.seconds, 1000);
  EXPECT_LT(last.samples_per_second, 3 * step * 2 / 1000.0);
  EXPECT_GT(read_checkpoint(folder / "state").seconds, 1000);
}

TEST_F(CheckpointTest, a_checkpoint_that_cannot_be_written_does_not_end_a_render) {
  const Ref<Job> job = ball(2 * step);
  job->checkpoint_file = folder / "no/such/folder";
  job->checkpoint_interval = 0;
  EXPECT_EQ(job->render(), Ended::samples);
  EXPECT_EQ(count(job->samples_done()), 2u * step);
  EXPECT_TRUE(has(job->checkpoint_failure(), "no/such")) << job->checkpoint_failure();
}

TEST_F(CheckpointTest, leftovers_of_killed_processes_are_removed) {
  const std::string dead = folder.write(".state.part-4194305", "half");  // no process has an id above 2^22
  const std::string other = folder.write(".else.part-4194305", "half"),
                    own = folder.write(fmt::format(".state.part-{}", getppid()), "");
  remove_leftovers(folder / "state");
  EXPECT_FALSE(std::filesystem::exists(dead));
  EXPECT_TRUE(std::filesystem::exists(other) && std::filesystem::exists(own));
}

// ---- merging --------------------------------------------------------------------------------------------------------------

TEST_F(CheckpointTest, parts_merge_in_any_order_to_what_one_process_makes) {
  const int samples = 5 * step + 77;
  const std::string text =
      ball_text("PathTracer { max_depth: 3 }", "width: 2, layers: [\"variance\", \"samples\", \"object\", \"albedo\"]");
  const Ref<Job> straight = job_of(text, samples);
  straight->render();
  const std::string a = part(job_of(text, samples), "a", IndexRange{0, 2}),
                    b = part(job_of(text, samples), "b", IndexRange{2, 3}),
                    c = part(job_of(text, samples), "c", IndexRange{3, 6});
  const Checkpoint merged = merge_checkpoints({a, b, c});
  EXPECT_EQ(merged.done, (std::vector<IndexRange>{{0, std::uint32_t(samples)}}));
  EXPECT_EQ(merged.samples_wanted, std::uint32_t(samples));
  const Ref<Job> job = job_with_picture(merged);
  EXPECT_EQ(job->image->samples(), straight->image->samples());
  const Image picture = job->picture(), expected = straight->picture();
  EXPECT_LE(relative_difference(picture, expected), 1e-12);
  for (const char* key : {"samples", "seed", "renderer", "version"})
    EXPECT_EQ(picture.metadata.at(key), expected.metadata.at(key));
  for (const auto& order : {std::vector{c, b, a}, {b, a, c}, {c, a, b}})
    EXPECT_TRUE(merge_checkpoints(order).state.image == merged.state.image);
  // Merging merged ones, and going on from there with what is missing.
  write_checkpoint(merge_checkpoints({c, a}), folder / "ac");
  EXPECT_EQ(read_checkpoint(folder / "ac").done, (std::vector<IndexRange>{{0, 2 * step}, {3 * step, std::uint32_t(samples)}}));
  const Ref<Job> filled = job_of(text, samples);
  EXPECT_EQ(filled->resume(folder / "ac"), Ended::samples);
  EXPECT_EQ(filled->image->samples(), straight->image->samples());
  EXPECT_LE(relative_difference(filled->picture(), expected), 1e-12);
}

TEST_F(CheckpointTest, what_does_not_belong_together_is_not_merged) {
  const auto render = [&](const Ref<Job>& job, const std::string& name, IndexRange passes) { return part(job, name, passes); };
  const std::string a = render(ball(4 * step), "a", {0, 2}), b = render(ball(4 * step), "b", {1, 3});
  const Ref<Job> reseeded = ball(4 * step);
  reseeded->seed = 9;
  const std::string s = render(reseeded, "s", {2, 3});
  const std::string d = render(job_of(ball_text("PathTracer { max_depth: 4 }"), 4 * step), "d", {2, 3});
  const auto reasons = [&](const std::vector<std::string>& parts) { return complaint([&] { merge_checkpoints(parts); }); };
  EXPECT_TRUE(has(reasons({b, a}), "/a' and ") && has(reasons({b, a}), "/b': both hold samples 16384 to 32767"))
      << reasons({a, b});
  EXPECT_TRUE(has(reasons({a, a}), "both hold samples 0 to 32767")) << reasons({a, a});
  EXPECT_TRUE(has(reasons({a, s}), "the seed differs: 9 in it, 0 in ")) << reasons({a, s});
  EXPECT_TRUE(has(reasons({a, d}), "max_depth: 4")) << reasons({a, d});
  EXPECT_TRUE(has(reasons({a, folder / "absent"}), "there is no such file"));
  EXPECT_TRUE(has(reasons({}), "nothing to merge"));
  // A wide range and two within it: every overlap is told.
  Checkpoint wide = read_checkpoint(a);
  wide.done = {{0, 100}};
  write_checkpoint(wide, folder / "wide");
  wide.done = {{10, 20}, {50, 60}};
  write_checkpoint(wide, folder / "two");
  const std::string text = reasons({folder / "two", folder / "wide"});
  EXPECT_TRUE(has(text, "samples 10 to 19") && has(text, "samples 50 to 59")) << text;
}

// ---- refusals -------------------------------------------------------------------------------------------------------------

TEST_F(CheckpointTest, another_render_is_not_continued) {
  part(ball(2 * step), "state", IndexRange{0, 1});
  const auto reason = [&](const Ref<Job>& job) { return complaint([&] { job->resume(folder / "state"); }); };
  const auto from = [&](const std::string& text) { return reason(job_of(text, 2 * step)); };
  EXPECT_EQ(reason(ball(2 * step)), "");
  const std::string depth = from(ball_text("PathTracer { max_depth: 4 }"));
  EXPECT_TRUE(has(depth, "'renderer: PathTracer { max_depth: 3 }' in the checkpoint") &&
              has(depth, "'renderer: PathTracer { max_depth: 4 }' in this job"))
      << depth;
  EXPECT_TRUE(has(from(ball_text("DirectRenderer {}")), "the description differs") ||
              !Registry::instance().find("DirectRenderer"));
  for (const char* image : {"width: 3", "width: 2, filter: BoxFilter {}", "width: 2, layers: [\"depth\"]",
                            "width: 2, crop: [0, 0, 1, 1]", "width: 2, path_lengths: 1"})
    EXPECT_TRUE(has(from(ball_text("PathTracer { max_depth: 3 }", image)), "the description differs")) << image;
  EXPECT_TRUE(has(from(ball_text("PathTracer { max_depth: 3 }", "width: 2", "0.6")), "color: 0.6"));
  EXPECT_TRUE(has(from(ball_text("PathTracer { max_depth: 3 }", "width: 2", "0.5", "seed: 4")),
                  "the seed differs: 0 in the checkpoint, 4"));
  // What does not change the samples may change.
  EXPECT_EQ(from("# a comment\n" + ball_text("PathTracer { max_depth: 3 }", "width: 2", "0.5",
                                             "tone_map: SchlickToneMap {}\n outputs: [ NpyOutput {} ]\n time_limit: 1000")),
            "");
  // A refusal changes nothing.
  const Ref<Job> job = ball(2 * step);
  job->render();
  const auto before = film(*job);
  job->seed = 3;
  EXPECT_NE(reason(job), "");
  EXPECT_TRUE(film(*job) == before);

  Checkpoint c = read_checkpoint(folder / "state");
  const auto changed = [&](auto&& change) {
    Checkpoint other = c;
    change(other);
    write_checkpoint(other, folder / "changed");
    return complaint([&] { ball(2 * step)->resume(folder / "changed"); });
  };
  EXPECT_EQ(changed([](Checkpoint&) {}), "");
  EXPECT_TRUE(has(changed([](Checkpoint& o) { o.version = "0.0.1"; }), "it is of version 0.0.1, this program is "));
  EXPECT_TRUE(has(changed([](Checkpoint& o) { o.samples_per_pass = 8; }), "the passes differ: 8 samples each"));
  EXPECT_TRUE(has(changed([](Checkpoint& o) { o.done = {{5, 9}, {0, 2}}; }), "not sorted"));
  EXPECT_TRUE(has(changed([](Checkpoint& o) { o.state.image.pop_back(); }), "the film's state ends too early"));
}

TEST_F(CheckpointTest, files_count_by_their_contents) {
  const std::string csv = folder.write("grey.csv", "wavelength,value\n300,0.5\n900,0.5\n");
  const std::string ply = folder.write("a.ply",
                                       "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
                                       "float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                                       "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  const std::string ball =
      "0.5 * spectrum(\"grey.csv\") }, transform: scale(0.9) }\n TriangleMesh { file: \"./a.ply\", shader: Lambertian { color: "
      "0.1";
  const std::string file = folder.write("scene.etd", ball_text("PathTracer { max_depth: 3 }", "width: 2", ball));
  const auto load = [&](const std::string& path) {
    const Ref<Job> job = load_job(path);
    job->renderer->samples = 2 * step;
    return job;
  };
  part(load(file), "state", IndexRange{0, 1});
  const Checkpoint c = read_checkpoint(folder / "state");
  ASSERT_EQ(c.identity.files.size(), 2u);
  EXPECT_EQ(c.identity.files[0].name, "a.ply");
  EXPECT_EQ(c.identity.files[0].size, std::filesystem::file_size(ply));
  EXPECT_EQ(c.identity.files[1].name, "grey.csv");
  const auto reason = [&](const std::string& path) { return complaint([&] { load(path)->resume(folder / "state"); }); };
  EXPECT_EQ(reason(file), "");

  // The same files elsewhere, and newer, are the same.
  std::filesystem::create_directory(folder / "moved");
  for (const char* name : {"scene.etd", "grey.csv", "a.ply"})
    folder.write("moved/" + std::string(name), file_text(folder / name));
  EXPECT_EQ(reason(folder / "moved/scene.etd"), "");
  EXPECT_EQ(reason(folder / "moved/../moved/scene.etd"), "");

  std::string text = file_text(ply);
  text.replace(text.find("1 0 0"), 1, "2");
  folder.write("a.ply", text);
  EXPECT_TRUE(has(reason(file), "the contents of 'a.ply' differ between the checkpoint and this job")) << reason(file);
  text.replace(text.find("2 0 0"), 1, "1");
  folder.write("a.ply", text);
  EXPECT_EQ(reason(file), "");
  folder.write("grey.csv", "wavelength,value\n300,0.5\n900,0.6\n");
  EXPECT_TRUE(has(reason(file), "grey.csv")) << reason(file);
}

TEST_F(CheckpointTest, damage_is_found_wherever_it_is) {
  part(ball(step + 100), "state");  // with a state from before a short pass
  const std::string good = file_text(folder / "state");
  ASSERT_GT(good.size(), 500u);
  const std::string path = folder / "bad";
  const auto read = [&](const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
    return complaint([&] { read_checkpoint(path); });
  };
  EXPECT_EQ(read(good), "");
  std::mt19937 random(1);
  int unseen = 0;
  ASSERT_LT(good.size(), 10000u);
  for (size_t i = 0; i < good.size(); i += i < 200 || i + 50 > good.size() ? 1 : 1 + random() % 15) {
    std::string bad = good;
    bad[i] = char(bad[i] ^ (1 << random() % 8));
    unseen += read(bad).empty();
  }
  EXPECT_EQ(unseen, 0) << "of " << good.size();
  for (size_t n = 0; n < good.size(); n += 1 + random() % 60)
    unseen += !has(read(good.substr(0, n)), n < 8 ? "no checkpoint" : "cut short");
  EXPECT_EQ(unseen, 0);
  EXPECT_TRUE(has(read(good + "x"), "damaged"));
  EXPECT_TRUE(has(read("ply\nformat ascii 1.0\n"), "it is no checkpoint"));
  EXPECT_TRUE(has(read(""), "it is no checkpoint"));
  EXPECT_TRUE(has(complaint([&] { read_checkpoint(folder / "absent"); }), "there is no such file"));
  EXPECT_TRUE(has(complaint([&] { read_checkpoint(folder.path()); }), "it is a folder"));
  EXPECT_TRUE(has(complaint([&] { ball(step)->resume(folder / "absent"); }), "absent"));
}

// ---- the program ------------------------------------------------------------------------------------------------------------

class CheckpointProgramTest : public CheckpointTest {
 protected:
  int run(const std::vector<std::string>& arguments) {
    Process process(program, arguments, folder);
    const int status = process.wait();
    out = process.out();
    err = process.err();
    return status;
  }
  /// `render scene --samples n --quiet` and more.
  std::vector<std::string> rendering(const std::string& samples, const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"render", "scene.etd", "--samples", samples, "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  void SetUp() override { folder.write("scene.etd", ball_text()); }
  bool same_files(const std::string& a, const std::string& b) const {
    const std::string bytes = file_text(folder / a);
    return !bytes.empty() && bytes == file_text(folder / b);
  }

  const std::string program = ETENDUE_BINARY_DIR "/etendue";
  std::string out, err;
};

TEST_F(CheckpointProgramTest, continues_and_merges) {
  const std::string samples = std::to_string(3 * step + 5);
  const std::vector<std::string> outputs = {"-o", "one.npy", "-o", "one.exr", "-o", "one.png"};
  ASSERT_EQ(run(rendering(samples, outputs)), 0) << err;

  ASSERT_EQ(run({"render", "scene.etd", "--samples", samples, "--passes", "0:2", "--checkpoint", "a"}), 0) << err;
  EXPECT_TRUE(has(out, "passes 0:2 of 0:4, 16384 samples per pixel each")) << out;
  EXPECT_FALSE(std::filesystem::exists(folder / "scene.png"));
  std::filesystem::copy_file(folder / "a", folder / "b");
  std::vector<std::string> again = outputs;
  for (std::string& name : again)
    if (name != "-o") name.replace(0, 3, "two");
  again.insert(again.end(), {"--resume", "b"});
  ASSERT_EQ(run(rendering(samples, again)), 0) << err;
  for (const char* ending : {".npy", ".exr", ".png"})
    EXPECT_TRUE(same_files(std::string("one") + ending, std::string("two") + ending)) << ending;
  // The checkpoint has become that of the whole; to go on from it changes nothing, and --continue does as --resume.
  EXPECT_EQ(read_checkpoint(folder / "b").done, (std::vector<IndexRange>{{0, 3 * step + 5}}));
  ASSERT_EQ(run(rendering(samples, {"--continue", "b", "-o", "two.npy"})), 0) << err;
  EXPECT_TRUE(same_files("one.npy", "two.npy"));
  ASSERT_EQ(run(rendering(samples, {"--continue", "c", "--passes", "3:4"})), 0) << err;
  ASSERT_EQ(run(rendering(samples, {"--continue", "c", "--passes", "3:4", "-o", "part.npy"})), 0) << err;
  EXPECT_FALSE(same_files("one.npy", "part.npy"));

  ASSERT_EQ(run({"image", "merge", "c", "a", "-o", "gap.npy", "--checkpoint", "ac"}), 0) << err;
  EXPECT_TRUE(has(err, "note: samples 32768 to 49151 (--passes 2:3)")) << err;
  EXPECT_TRUE(has(out, "32773 samples per pixel of 2 parts")) << out;
  ASSERT_EQ(run(rendering(samples, {"--passes", "2:3", "--checkpoint", "d"})), 0) << err;
  // Without -o to where the description says: here a PNG named after it.
  ASSERT_EQ(run({"image", "merge", "d", "ac"}), 0) << err;
  EXPECT_EQ(err, "");
  EXPECT_TRUE(has(out, "scene.png\n")) << out;
  EXPECT_TRUE(same_files("one.png", "scene.png"));
  ASSERT_EQ(run({"image", "merge", "d", "ac", "-o", "merged.npy", "-o", "merged.exr"}), 0) << err;
  ASSERT_EQ(run({"image", "diff", "one.npy", "merged.npy", "--tolerance", "1e-12"}), 0) << out;
  ASSERT_EQ(run({"image", "info", "merged.exr"}), 0);
  EXPECT_TRUE(has(out, "samples: " + samples)) << out;
  EXPECT_EQ(run({"image", "merge", "a", "ac", "-o", "x.npy"}), 2);
  EXPECT_TRUE(has(err, "both hold samples 0 to 32767")) << err;
  EXPECT_EQ(run({"image", "merge", "scene.etd", "-o", "x.npy"}), 2);
  EXPECT_EQ(run({"image", "merge", "a", "-o", "x.nothing"}), 2);
  EXPECT_EQ(run({"image", "merge"}), 2);
}

TEST_F(CheckpointProgramTest, wrong_requests_are_explained) {
  const std::string samples = std::to_string(2 * step);
  ASSERT_EQ(run(rendering(samples, {"--passes", "0:1", "--checkpoint", "a"})), 0) << err;
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong = {
      {{"--passes", "0:1"}, "--checkpoint"},
      {{"--passes", "0:3", "--checkpoint", "b"}, "are 2 passes of 16384"},
      {{"--passes", "1:1", "--checkpoint", "b"}, "no passes"},
      {{"--passes", "a:b", "--checkpoint", "b"}, "A:B"},
      {{"--every", "5s"}, "--checkpoint"},
      {{"--resume", "absent"}, "there is no such file"},
      {{"--resume", "scene.etd"}, "it is no checkpoint"},
      {{"--resume", "a", "--continue", "a"}, "--continue"},
      {{"--resume", "a", "--seed", "4"}, "the seed differs"},
      {{"--resume", "a", "--size", "3x1"}, "the description differs"},
      {{"--resume", "a", "--samples", "100"}, "only 100 are wanted"},
      {{"--checkpoint", "no/such/b"}, "there is no folder"},
      {{"--checkpoint", "b", "--pixel", "0,0", "--sample", "0"}, "--pixel"},
  };
  for (const auto& [options, reason] : wrong) {
    std::vector<std::string> arguments{"render", "scene.etd", "--quiet"};
    if (options.back() != "100") arguments.insert(arguments.end(), {"--samples", samples});
    arguments.insert(arguments.end(), options.begin(), options.end());
    EXPECT_EQ(run(arguments), 2) << options[0] << " " << options[1] << "\n" << err;
    EXPECT_TRUE(has(err, reason)) << options[0] << " " << options[1] << "\n" << err;
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "b"));
}

TEST_F(CheckpointProgramTest, an_interrupted_render_says_how_to_go_on) {
  const std::string samples = std::to_string(400 * step);
  {
    Process process(program,
                    {"render", "scene.etd", "--samples", samples, "--checkpoint", "state", "--set", "camera.fov=41", "-o",
                     "a.npy", "--progress", "bar"},
                    folder);
    for (int i = 0; i < 6000 && process.err().empty(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    process.send(SIGTERM);
    ASSERT_EQ(process.wait(), 130) << process.err();
    EXPECT_TRUE(has(process.out(), "to go on: etendue render scene.etd --set camera.fov=41 --samples " + samples +
                                       " -o a.npy --resume state\n"))
        << process.out();
  }
  EXPECT_LT(count(read_checkpoint(folder / "state").done), 400u * step);
  ASSERT_EQ(run(rendering(samples, {"--set", "camera.fov=41", "--resume", "state", "-o", "a.npy"})), 0) << err;
  ASSERT_EQ(run(rendering(samples, {"--set", "camera.fov=41", "-o", "b.npy"})), 0) << err;
  EXPECT_TRUE(same_files("a.npy", "b.npy"));
}

/// ETENDUE_KILLS: how often; 5 unless set.
TEST_F(CheckpointProgramTest, killed_at_any_moment_it_goes_on_to_the_same_bits) {
  const char* asked = std::getenv("ETENDUE_KILLS");
  const int kills = asked ? std::atoi(asked) : 5;
  const std::string samples = std::to_string(40 * step + 3000);
  const auto seconds = [&](const std::vector<std::string>& arguments) {
    const auto begun = std::chrono::steady_clock::now();
    EXPECT_EQ(run(arguments), 0) << err;
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  };
  const double start = seconds({"check", "scene.etd"});
  const double whole = seconds(rendering(samples, {"-o", "one.npy", "-o", "one.exr", "-o", "one.png"}));

  const std::vector<std::string> arguments =
      rendering(samples, {"-o", "two.npy", "-o", "two.exr", "-o", "two.png", "--continue", "state", "--every", "0s"});
  std::mt19937 random(7);
  std::uniform_real_distribution<double> delay(0.5 * start, 0.8 * start + 0.4 * whole);
  int killed = 0, with_state = 0;
  // Without the state there is nothing that could differ: some of the kills must have come after its first writing.
  for (int tries = 0; killed < kills && tries < 20 * kills; ++tries) {
    Process process(program, arguments, folder);
    std::this_thread::sleep_for(std::chrono::duration<double>(delay(random)));
    process.send(SIGKILL);
    const bool was_killed = process.wait() == 128 + SIGKILL;
    killed += was_killed;
    const bool state = std::filesystem::exists(folder / "state");
    with_state += was_killed && state;
    if (state) {
      EXPECT_EQ(complaint([&] { read_checkpoint(folder / "state"); }), "");
    }
    if (was_killed) continue;
    // Finished before it could be killed: from the beginning.
    EXPECT_TRUE(same_files("one.npy", "two.npy"));
    std::filesystem::remove(folder / "state");
  }
  EXPECT_EQ(killed, kills);
  EXPECT_GE(with_state, 1);
  ASSERT_EQ(run(arguments), 0) << err;
  for (const char* ending : {".npy", ".exr", ".png"})
    EXPECT_TRUE(same_files(std::string("one") + ending, std::string("two") + ending)) << ending;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    EXPECT_FALSE(has(entry.path().filename().string(), ".state.part")) << entry.path();
}

}  // namespace
}  // namespace etendue
