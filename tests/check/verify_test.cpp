// `etendue verify`: the choice of renderers, the collected means and the report, and the command on a small scene.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "check/verify/agreement.h"
#include "check/verify/collect.h"
#include "check/verify/report_pictures.h"
#include "etendue/language/language.h"
#include "images/base64.h"
#include "support/process.h"
#include "support/render_support.h"

namespace etendue::verify {
namespace {

// ---- choosing and measuring ------------------------------------------------------------------------------------------------

TEST(VerifyChoose, lists_are_split_outside_of_brackets_and_texts) {
  EXPECT_EQ(split_expressions("A"), (std::vector<std::string>{"A"}));
  EXPECT_EQ(split_expressions(" A , B{x: [1, 2], y: f(3, 4)},C{t: \"a,}b\\\",\", u: 1}"),
            (std::vector<std::string>{"A", "B{x: [1, 2], y: f(3, 4)}", "C{t: \"a,}b\\\",\", u: 1}"}));
  EXPECT_EQ(split_expressions("A,,B"), (std::vector<std::string>{"A", "", "B"}));
}

const char* const boxed = R"(
  Sphere { radius: 1 m, shader: Lambertian { color: 0.5 } }
  Sphere { radius: 0.5 m, transform: translate(0, 2 m, -1 m), emission: DiffuseEmission { radiance: 5 } }
  Rectangle { corner: [-3, -1, -3] m, edge_u: [0, 0, 6] m, edge_v: [6, 0, 0] m, shader: Lambertian { color: 0.7 } })";

Ref<Job> small_job() {
  Ref<Job> job =
      load_job_text(test::job_text("PathTracer { max_depth: 5, samples: 64 }",
                                   "PerspectiveCamera { from: [0, 0, -4] m, to: [0, 0, 0] m, fov: 45 deg }", 16, boxed),
                    "test.etd");
  prepare_picture(*job, 4);
  prepare_tree(*job);
  return job;
}

TEST(VerifyChoose, renderers_take_over_what_all_must_share) {
  const Ref<Job> job = small_job();
  const Choice choice = choose_renderers(*job, "PathTracer, PathTracer{next_event: false}, PathTracer {max_depth: 2}", false);
  ASSERT_EQ(choice.candidates.size(), 3u);
  EXPECT_EQ(choice.candidates[0].renderer, job->renderer);
  EXPECT_TRUE(get(*choice.candidates[1].renderer, "max_depth") == Value(Number{5}));
  EXPECT_TRUE(get(*choice.candidates[2].renderer, "max_depth") == Value(Number{2}));
  EXPECT_EQ(choice.candidates[1].renderer->sampler, job->renderer->sampler);
  EXPECT_THROW(choose_renderers(*job, "PathTracr", false), Errors);
  EXPECT_THROW(choose_renderers(*job, "Sphere", false), Errors);
  EXPECT_THROW(choose_renderers(*job, "PathTracer,", false), Errors);
}

TEST(VerifyChoose, those_that_miss_light_are_left_out_unless_forced) {
  const Ref<Job> job = small_job();
  const Choice all = choose_renderers(*job, "", false);
  EXPECT_EQ(all.candidates[0].renderer, job->renderer);
  for (const Candidate& candidate : all.candidates) {
    EXPECT_NE(candidate.name, "FeatureRenderer");
    EXPECT_NE(candidate.name, "Renderer");
    EXPECT_TRUE(candidate.misses.empty());
  }
  const Choice choice = choose_renderers(*job, "PathTracer,FeatureRenderer", false);
  ASSERT_EQ(choice.left_out.size(), 1u);
  EXPECT_EQ(choice.left_out[0].name, "FeatureRenderer");
  EXPECT_EQ(choose_renderers(*job, "PathTracer,FeatureRenderer", true).candidates.size(), 2u);
}

TEST(VerifyCollect, means_are_those_of_the_passes_and_lengths_add_up) {
  Render render(small_job());
  CollectOptions options;
  options.samples = 2;
  options.passes = 3;
  options.inject = 2;
  const Collected c =
      collect(render, choose_renderers(render.job(), "PathTracer,PathTracer{next_event:false}", false).candidates, 8, options);
  ASSERT_TRUE(c.complete);
  ASSERT_EQ(c.measured.size(), 2u);
  for (size_t i = 0; i < 2; ++i) {
    ASSERT_EQ(c.measured[i].passes.size(), 3u);
    EXPECT_NE(c.measured[i].passes[0], c.measured[i].passes[1]);
    EXPECT_EQ(c.runs[i].samples, 3u * 2u * 16u * 16u);
    EXPECT_TRUE(c.measured[i].tells_lengths);
    EXPECT_NEAR(c.runs[i].length_share, 1, 1e-5);
    double mean = 0, tile = 0;
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) {
        mean += c.runs[i].picture.at(x, y, 1) / 256;
        if (x >= 8 && y < 8) tile += c.runs[i].picture.at(x, y, 1) / 64;
      }
    EXPECT_NEAR(moments(c.layout, c.measured[i], 0, c.layout.whole()).mean, mean, 1e-12 * mean);
    EXPECT_NEAR(moments(c.layout, c.measured[i], 0, 1).mean, tile, 1e-12 * tile);
  }
  // The same again without the injected factor.
  options.inject = 1;
  const Collected d = collect(render, choose_renderers(render.job(), "PathTracer", false).candidates, 8, options);
  EXPECT_NEAR(c.measured[0].passes[2][3], 2 * d.measured[0].passes[2][3], 1e-12);
}

// Chains cannot follow glass with several specular directions of one kind (its normals are tilted). They find this only while
// they render.
TEST(VerifyCollect, what_refuses_the_scene_while_it_renders_is_left_out_with_its_reason) {
  const Ref<Job> job = load_job(ETENDUE_SOURCE_DIR "/scenes/verify/tilted_normals.etd");
  job->image->width = 16, job->image->height = 12;
  prepare_picture(*job, 2);
  Render render(job, {});
  Choice choice = choose_renderers(render.job(), "PathTracer,PathSpaceMetropolis,BidirectionalPathTracer", true);
  ASSERT_EQ(choice.candidates.size(), 3u);
  CollectOptions options;
  options.passes = 2;
  EXPECT_THROW(collect(render, choice.candidates, 8, options), Error);
  options.leave_out_refusing = true;
  const Collected c = collect(render, choice.candidates, 8, options);
  leave_out_refused(choice, c);
  ASSERT_EQ(c.measured.size(), 2u);
  EXPECT_EQ(c.measured[1].name, "BidirectionalPathTracer");
  EXPECT_EQ(choice.candidates[1].name, "BidirectionalPathTracer");
  ASSERT_FALSE(choice.left_out.empty());
  EXPECT_EQ(choice.left_out.back().name, "PathSpaceMetropolis");
  EXPECT_NE(choice.left_out.back().reason.find("several specular directions"), std::string::npos)
      << choice.left_out.back().reason;
}

// ---- pictures of the report ------------------------------------------------------------------------------------------------

TEST(VerifyReport, base64_has_the_examples_of_its_standard) {
  const auto encoded = [](const std::string& text) { return base64(std::vector<unsigned char>(text.begin(), text.end())); };
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
  EXPECT_EQ(encoded("\xff\xfe\xfd"), "//79");
}

TEST(VerifyReport, colors_go_from_blue_over_white_to_red) {
  EXPECT_EQ(difference_color(0), (std::array<unsigned char, 3>{247, 247, 247}));
  EXPECT_EQ(difference_color(z_of_full_color), difference_color(30));
  const auto red = difference_color(5), blue = difference_color(-5);
  EXPECT_GT(red[0], red[2] + 100);
  EXPECT_GT(blue[2], blue[0] + 100);
}

// ---- the program -----------------------------------------------------------------------------------------------------------

class VerifyProgram : public testing::Test {
 protected:
  int run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"verify", scene});
    Process process(ETENDUE_BINARY_DIR "/etendue", arguments, folder);
    const int status = process.wait();
    out = process.out();
    err = process.err();
    return status;
  }
  void SetUp() override {
    scene = folder.write("tiny.etd",
                         test::job_text("PathTracer { max_depth: 8, samples: 64 }",
                                        "PerspectiveCamera { from: [0, 0, -4] m, to: [0, 0, 0] m, fov: 45 deg }", 16, boxed));
  }
  static bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

  TemporaryFolder folder;
  std::string scene, out, err;
};

TEST_F(VerifyProgram, three_ways_to_trace_the_same_paths_agree) {
  EXPECT_EQ(
      run({"--renderers", "PathTracer,PathTracer{heuristic: \"balance\"},PathTracer{next_event: false}", "--samples", "128"}),
      0)
      << out << err;
  EXPECT_TRUE(has(out, "PathTracer and PathTracer{next_event: false}: ")) << out;
  EXPECT_TRUE(has(out, "would notice a difference of")) << out;
  EXPECT_FALSE(has(out, "DISAGREE")) << out;
  EXPECT_EQ(err, "");
}

TEST_F(VerifyProgram, missing_lengths_are_named) {
  EXPECT_EQ(run({"--renderers", "PathTracer,PathTracer{max_depth: 3}", "--samples", "256", "--lengths", "5", "--json"}), 1)
      << err;
  const auto json = nlohmann::json::parse(out);
  EXPECT_EQ(json["agree"], false);
  EXPECT_EQ(json["renderers"].size(), 2u);
  for (const auto& layer : json["pairs"][0]["layers"]) {
    const int length = layer["whole"]["length"];
    if (length == 0) continue;
    EXPECT_EQ(layer["verdict"], length > 3 ? "DISAGREE" : "agree") << layer["name"];
    if (length <= 3) continue;
    EXPECT_EQ(layer["whole"]["mean_b"], 0.0);
    EXPECT_GT(layer["whole"]["mean_a"], 0.0);
  }
}

TEST_F(VerifyProgram, an_injected_error_is_noticed_and_reported) {
  EXPECT_EQ(run({"--renderers", "PathTracer,PathTracer{heuristic: balance}", "--samples", "1024", "--inject", "1.05",
                 "--report", "report.html"}),
            1)
      << out << err;
  EXPECT_TRUE(has(out, "DISAGREE")) << out;
  const std::string html = file_text(folder / "report.html");
  EXPECT_TRUE(has(html, "<!DOCTYPE html>"));
  EXPECT_TRUE(has(html, "</html>"));
  EXPECT_TRUE(has(html, "data:image/png;base64,iVBORw0KGgo"));
  EXPECT_TRUE(has(html, "--inject 1.05"));
  EXPECT_TRUE(has(html, "prefers-color-scheme: dark"));
  for (const char* outside : {"http:", "https:", "<script", "<link", "url("}) EXPECT_FALSE(has(html, outside)) << outside;
}

TEST_F(VerifyProgram, the_result_does_not_depend_on_threads) {
  const std::vector<std::string> arguments = {"--renderers", "PathTracer,PathTracer{next_event: false}", "--samples", "16",
                                              "--json"};
  const auto means = [&](const char* threads) {
    std::vector<std::string> all = arguments;
    all.insert(all.end(), {"--threads", threads});
    EXPECT_EQ(run(all), 0) << out << err;
    return nlohmann::json::parse(out)["pairs"];
  };
  EXPECT_EQ(means("1"), means("2"));
}

TEST_F(VerifyProgram, by_time_there_are_at_least_eight_passes) {
  EXPECT_EQ(run({"--renderers", "PathTracer,PathTracer{heuristic: balance}", "--samples", "16", "--time", "0.01s", "--json"}),
            0)
      << out << err;
  const auto report = nlohmann::json::parse(out);
  ASSERT_EQ(report["renderers"].size(), 2u);
  for (const auto& renderer : report["renderers"]) EXPECT_GE(renderer["passes"].get<int>(), 8);
}

TEST_F(VerifyProgram, quiet_says_nothing) {
  EXPECT_EQ(run({"--renderers", "PathTracer,PathTracer{heuristic: balance}", "--samples", "16", "--quiet"}), 0);
  EXPECT_EQ(out + err, "");
}

TEST_F(VerifyProgram, bad_input_exits_with_2_and_says_why) {
  EXPECT_EQ(run({"--renderers", "PathTracer,PathTracr"}), 2);
  EXPECT_TRUE(has(err, "did you mean 'PathTracer'")) << err;
  EXPECT_EQ(run({"--renderers", "PathTracer,PathTracer{max_dept: 3}"}), 2);
  EXPECT_TRUE(has(err, "did you mean 'max_depth'")) << err;
  EXPECT_EQ(run({"--renderers", "PathTracer"}), 2);
  EXPECT_TRUE(has(err, "no other renderer to compare")) << err;
  EXPECT_EQ(run({"--renderers", "PathTracer,FeatureRenderer"}), 2);
  EXPECT_TRUE(has(err, "FeatureRenderer: misses")) << err;
  EXPECT_EQ(run({"--renderers", "PathTracer,Sphere"}), 2);
  EXPECT_TRUE(has(err, "is no renderer")) << err;
}

TEST_F(VerifyProgram, bad_options_exit_with_2) {
  EXPECT_EQ(run({"--report", "no/such/report.html"}), 2);
  EXPECT_TRUE(has(err, "no folder")) << err;
  for (const auto& [option, value] : {std::pair("--passes", "2"), std::pair("--significance", "2"), std::pair("--time", "soon"),
                                      std::pair("--size", "8"), std::pair("--lengths", "64"), std::pair("--samples", "0")})
    EXPECT_EQ(run({option, value}), 2) << option;
}

}  // namespace
}  // namespace etendue::verify
