// Renders in parts: which checkpoints are merged, and which are refused.

#include <gtest/gtest.h>

#include <random>

#include "support/checkpoint_test_support.h"

namespace etendue::checkpoint_test {
namespace {

// ---- merging --------------------------------------------------------------------------------------------------------------

TEST_F(CheckpointTest, parts_merge_in_any_order_to_what_one_process_makes) {
  const int samples = 5 * step + 77;
  const std::string text =
      ball_text("PathTracer { max_depth: 3 }", "width: 2, layers: [\"variance\", \"samples\", \"object\", \"albedo\"]");
  const auto straight = rendered(job_of(text, samples), two_threads);
  const std::string a = part(job_of(text, samples), "a", IndexRange{0, 2}),
                    b = part(job_of(text, samples), "b", IndexRange{2, 3}),
                    c = part(job_of(text, samples), "c", IndexRange{3, 6});
  const Checkpoint merged = merge_checkpoints({a, b, c});
  EXPECT_EQ(merged.done, (std::vector<IndexRange>{{0, std::uint32_t(samples)}}));
  EXPECT_EQ(merged.samples_wanted, std::uint32_t(samples));
  expect_same(merged, *straight);
  for (const auto& order : {std::vector{c, b, a}, {b, a, c}, {c, a, b}})
    EXPECT_TRUE(merge_checkpoints(order).state.image == merged.state.image);
  // Checkpoints that are merged already are merged again, and a render continues from one with the missing samples.
  write_checkpoint(merge_checkpoints({c, a}), folder / "ac");
  EXPECT_EQ(read_checkpoint(folder / "ac").done, (std::vector<IndexRange>{{0, 2 * step}, {3 * step, std::uint32_t(samples)}}));
  const auto filled = continued(job_of(text, samples), folder / "ac");
  EXPECT_EQ(filled->film().samples(), straight->film().samples());
  EXPECT_TRUE(film(*filled) == film(*straight));
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
  // A wide range and two ranges within it: every overlap is reported.
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
  const auto reason = [&](const Ref<Job>& job) { return complaint([&] { continued(job, folder / "state"); }); };
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
  // Members that do not affect the samples may change.
  EXPECT_EQ(from("# a comment\n" + ball_text("PathTracer { max_depth: 3 }", "width: 2", "0.5",
                                             "tone_map: SchlickToneMap {}\n outputs: [ NpyOutput {} ]\n time_limit: 1000")),
            "");
  // After a refusal the render is unchanged.
  const Ref<Job> reseeded = ball(2 * step);
  reseeded->seed = 3;
  const auto render = rendered(reseeded, two_threads);
  const auto before = film(*render);
  const auto done = render->samples_done();
  EXPECT_NE(complaint([&] { render->load(folder / "state"); }), "");
  EXPECT_TRUE(film(*render) == before);
  EXPECT_EQ(render->samples_done(), done);

  Checkpoint c = read_checkpoint(folder / "state");
  const auto changed = [&](auto&& change) {
    Checkpoint other = c;
    change(other);
    write_checkpoint(other, folder / "changed");
    return complaint([&] { continued(ball(2 * step), folder / "changed"); });
  };
  EXPECT_EQ(changed([](Checkpoint&) {}), "");
  EXPECT_TRUE(has(changed([](Checkpoint& o) { o.version = "0.0.1"; }), "it is of version 0.0.1, this program is "));
  EXPECT_TRUE(has(changed([](Checkpoint& o) { o.samples_per_pass = 8; }), "the passes differ: 8 samples each"));
  EXPECT_TRUE(has(changed([](Checkpoint& o) { o.done = {{5, 9}, {0, 2}}; }), "not sorted"));
  EXPECT_TRUE(has(changed([](Checkpoint& o) { o.state.image.pop_back(); }), "the film's state ends too early"));
}

TEST_F(CheckpointTest, files_count_by_their_contents) {
  folder.write("grey.csv", "wavelength,value\n300,0.5\n900,0.5\n");
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
  const auto reason = [&](const std::string& path) { return complaint([&] { continued(load(path), folder / "state"); }); };
  EXPECT_EQ(reason(file), "");

  // Copies of the files in another folder, with newer dates, count as the same.
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

TEST_F(CheckpointTest, images_in_tiles_count_by_their_contents) {
  const auto image = [&](const std::string& name, const char* texel) {
    folder.write(name, std::string("P2\n1 1\n255\n") + texel);
  };
  image("wood.1001.pgm", "100\n");
  image("wood.1012.pgm", "200\n");
  const std::string file =
      folder.write("scene.etd", ball_text("PathTracer { max_depth: 3 }", "width: 2", "ImageMap { file: \"wood.<UDIM>.pgm\" }"));
  const auto load = [&] {
    const Ref<Job> job = load_job(file);
    job->renderer->samples = 2 * step;
    return job;
  };
  part(load(), "state", IndexRange{0, 1});
  const auto reason = [&] { return complaint([&] { continued(load(), folder / "state"); }); };
  EXPECT_EQ(reason(), "");
  image("wood.1012.pgm", "201\n");
  EXPECT_TRUE(has(reason(), "the contents of 'wood.1012.pgm' differ between the checkpoint and this job")) << reason();
  image("wood.1012.pgm", "200\n");
  EXPECT_EQ(reason(), "");
  image("wood.1002.pgm", "50\n");
  EXPECT_TRUE(has(reason(), "only this job has 'wood.1002.pgm'")) << reason();
  std::filesystem::remove(folder / "wood.1002.pgm");
  std::filesystem::remove(folder / "wood.1012.pgm");
  EXPECT_TRUE(has(reason(), "only the checkpoint has 'wood.1012.pgm'")) << reason();
}

TEST_F(CheckpointTest, damage_is_found_wherever_it_is) {
  part(ball(step + 100), "state");  // contains the state before the short last step, too
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
    unseen += !has(read(good.substr(0, n)), n < 8 ? "not a checkpoint" : "cut short");
  EXPECT_EQ(unseen, 0);
  EXPECT_TRUE(has(read(good + "x"), "damaged"));
  EXPECT_TRUE(has(read("ply\nformat ascii 1.0\n"), "it is not a checkpoint"));
  EXPECT_TRUE(has(read(""), "it is not a checkpoint"));
  EXPECT_TRUE(has(complaint([&] { read_checkpoint(folder / "absent"); }), "there is no such file"));
  EXPECT_TRUE(has(complaint([&] { read_checkpoint(folder.path()); }), "it is a folder"));
  EXPECT_TRUE(has(complaint([&] { continued(ball(step), folder / "absent"); }), "absent"));
}

}  // namespace
}  // namespace etendue::checkpoint_test
