// `etendue compare` on small scenes: its results, its output files, continued comparisons, and refusals.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/program_support.h"
#include "support/render_support.h"

namespace etendue {
namespace {

using Json = nlohmann::json;

const char* const boxed = R"(
  Sphere { radius: 1 m, shader: Lambertian { color: 0.5 } }
  Sphere { radius: 0.5 m, transform: translate(0, 2 m, -1 m), emission: DiffuseEmission { radiance: 5 } }
  Rectangle { corner: [-3, -1, -3] m, edge_u: [0, 0, 6] m, edge_v: [6, 0, 0] m, shader: Lambertian { color: 0.7 } })";

class CompareProgram : public RunsProgram {
 protected:
  void SetUp() override { scene = folder.write("tiny.etd", scene_text("0.5 m")); }
  static std::string scene_text(const std::string& lamp) {
    std::string objects = boxed;
    objects.replace(objects.find("0.5 m"), 5, lamp);
    return test::job_text("PathTracer { max_depth: 5, samples: 64 }",
                          "PerspectiveCamera { from: [0, 0, -4] m, to: [0, 0, 0] m, fov: 45 deg }", 16, objects);
  }
  int compare(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"compare", scene});
    return run(arguments);
  }
  Json json(const std::string& name = "r.json") { return Json::parse(file_text(folder / name)); }
  static const Json& variant(const Json& all, const std::string& name, size_t scene_number = 0) {
    for (const Json& v : all["scenes"][scene_number]["variants"])
      if (v["name"] == name) return v;
    throw std::runtime_error("no variant " + name);
  }
  std::string scene;
};

TEST_F(CompareProgram, a_bias_of_one_percent_is_found_and_none_where_there_is_none) {
  ASSERT_EQ(
      compare({"--plugin", ETENDUE_FAULTY_RENDERERS, "--renderers", "PathTracer,ScaledPathTracer{factor: 1},ScaledPathTracer",
               "--samples", "512", "--reference-time", "2s", "--json", "r.json", "--report", "r.html"}),
      0)
      << err;
  const Json all = json();
  EXPECT_FALSE(variant(all, "PathTracer")["bias"]["found"]) << out;
  EXPECT_FALSE(variant(all, "ScaledPathTracer{factor: 1}")["bias"]["found"]) << out;
  const Json& bias = variant(all, "ScaledPathTracer")["bias"];
  EXPECT_TRUE(bias["found"]) << out;
  EXPECT_NEAR(bias["relative_mean"].get<double>(), 0.01, 4 * bias["standard_error"].get<double>());
  EXPECT_LT(bias["standard_error"], 0.002);
  // The relative squared bias is 0.01^2 where the image is not black, for any number of samples.
  const Json& last = variant(all, "ScaledPathTracer")["curve"].back()["square_bias"];
  EXPECT_NEAR(last["value"].get<double>(), 1e-4, 4 * last["standard_error"].get<double>() + 3e-5);
  EXPECT_TRUE(has(out, "FOUND")) << out;
  EXPECT_TRUE(has(file_text(folder / "r.html"), "FOUND"));
}

TEST_F(CompareProgram, map_filter_and_missing_light_are_no_part_of_the_reference) {
  ASSERT_EQ(compare({"--renderers", "PathTracer,PathTracer{map_filter: 2},PathTracer{max_depth: 2},FeatureRenderer",
                     "--samples", "16", "--json", "r.json"}),
            0)
      << err;
  const Json all = json();
  EXPECT_EQ(variant(all, "PathTracer")["weight_in_reference"].is_null(), false);
  EXPECT_TRUE(variant(all, "PathTracer{map_filter: 2}")["weight_in_reference"].is_null());
  EXPECT_TRUE(has(variant(all, "PathTracer{map_filter: 2}")["says_of_itself"], "map_filter"));
  EXPECT_GE(variant(all, "FeatureRenderer")["misses"].size(), 1u);
  EXPECT_TRUE(variant(all, "FeatureRenderer")["bias"]["found"]);
  EXPECT_TRUE(has(out, "FeatureRenderer: misses")) << out;
}

TEST_F(CompareProgram, equal_variants_are_not_told_apart) {
  int found = 0;
  for (int seed = 0; seed < 20; ++seed) {
    ASSERT_EQ(compare({"--variant", "a:", "--variant", "b: renderer.max_depth=5", "--samples", "16", "--runs", "6", "--seed",
                       std::to_string(seed), "--json", "r.json", "--state", "state" + std::to_string(seed)}),
              0)
        << err;
    const Json all = json();
    found += all["contests_at_equal_samples"][0]["significant"].get<bool>() || variant(all, "a")["bias"]["found"].get<bool>();
  }
  EXPECT_LE(found, 1);  // two tests at a level of 1 %: more than one of 20 has a probability of 6 %
}

TEST_F(CompareProgram, the_same_number_of_samples_gives_half_the_error_for_half_the_variance) {
  ASSERT_EQ(compare({"--variant", "once:", "--variant", "twice:", "--samples", "32", "--runs", "6", "--json", "r.json"}), 0)
      << err;
  const Json all = json();
  for (const char* name : {"once", "twice"}) {
    const Json& v = variant(all, name);
    // Marks at 1, 2, 4 ... 32 samples; the variance falls at least as fast as for independent samples.
    EXPECT_EQ(v["curve"].size(), 6u);
    EXPECT_EQ(v["curve"].back()["samples"], 32);
    EXPECT_LT(v["exponent_over_samples"]["value"], -0.9);
    const double error = v["curve"].back()["relative_mean_square_error"]["value"], variance = v["curve"].back()["variance"];
    EXPECT_NEAR(error, variance, 0.1 * variance);
  }
}

TEST_F(CompareProgram, tables_and_page_tell_the_same) {
  const std::string other = folder.write("other <scene>.etd", scene_text("0.3 m"));
  ASSERT_EQ(compare({other, "--renderers", "PathTracer,PathTracer{next_event: false}", "--variant", "a, \"b\" <i>: seed=7",
                     "--samples", "64", "--runs", "4", "--json", "r.json", "--csv", "r.csv", "--report", "r.html", "--inset",
                     "2,3,8,8"}),
            0)
      << err;
  const Json all = json();
  ASSERT_EQ(all["scenes"].size(), 2u);
  const std::string csv = file_text(folder / "r.csv");
  size_t points = 0;
  for (const Json& s : all["scenes"])
    for (const Json& v : s["variants"]) {
      points += v["curve"].size();
      for (const Json& p : v["curve"]) EXPECT_TRUE(has(csv, "," + p["relative_mean_square_error"]["value"].dump() + ",")) << p;
    }
  EXPECT_EQ(points, 42u);
  EXPECT_EQ(size_t(std::ranges::count(csv, '\n')), points + 1);
  EXPECT_TRUE(has(csv, "\"a, \"\"b\"\" <i>\"")) << csv;
  EXPECT_EQ(all["contests_at_equal_samples"].size(), 6u);
  const auto& means = all["geometric_mean_error_over_that_of_the_first_at_equal_time"];
  ASSERT_EQ(means.size(), 3u);
  EXPECT_EQ(means[0]["value"], 1.0);
  EXPECT_EQ(means[1]["scenes"], 2);
  EXPECT_GT(means[1]["value"], 1.0);

  const std::string html = file_text(folder / "r.html");
  EXPECT_TRUE(has(html, "</html>"));
  EXPECT_TRUE(has(html, "data:image/png;base64,iVBORw0KGgo"));
  EXPECT_TRUE(has(html, "a, &quot;b&quot; &lt;i&gt;"));
  EXPECT_TRUE(has(html, "class=\"matrix\""));
  EXPECT_TRUE(has(html, "prefers-color-scheme: dark"));
  // Images are base64 text, in which any of these words may occur by chance, so they are left out.
  std::string words;
  for (size_t at = 0; at < html.size();) {
    const size_t begin = std::min(html.find("base64,", at), html.size());
    words.append(html, at, begin - at);
    at = std::min(html.find('"', begin), html.size());
  }
  for (const char* outside : {"http:", "https:", "<script", "<link", "url(", "<i>", "nan", "inf "})
    EXPECT_FALSE(has(words, outside)) << outside;
  char error[64];
  std::snprintf(error, sizeof error, ">%.3g <",
                all["scenes"][0]["variants"][0]["at_equal_samples"]["relative_mean_square_error"]["value"].get<double>());
  EXPECT_TRUE(has(html, error)) << error;
}

// ---- going on
// ----------------------------------------------------------------------------------------------------------------------

TEST_F(CompareProgram, interrupted_and_continued_gives_the_same_numbers) {
  const std::vector<std::string> what = {"compare",   scene,  "--renderers", "PathTracer,PathTracer{next_event: false}",
                                         "--samples", "128",  "--runs",      "4",
                                         "--size",    "48x48"};
  const auto with = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = what;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  ASSERT_EQ(run(with({"--json", "whole.json", "--quiet"})), 0) << err;
  {
    Process process(program, with({"--json", "parts.json"}), folder);
    for (int i = 0; i < 3000 && !exists("parts.json.runs/scene1-variant1-run1.run"); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    process.send(SIGINT);
    EXPECT_EQ(finish(std::move(process)), 130);
    EXPECT_TRUE(says("the same command resumes")) << err;
    EXPECT_FALSE(exists("parts.json"));
    EXPECT_FALSE(exists("parts.json.runs/scene1-variant2-run4.run"));
  }
  const std::string first = file_text(folder / "parts.json.runs/scene1-variant1-run1.run");
  ASSERT_EQ(run(with({"--json", "parts.json", "--quiet"})), 0) << err;
  EXPECT_EQ(file_text(folder / "parts.json.runs/scene1-variant1-run1.run"), first);
  const Json whole = json("whole.json"), parts = json("parts.json");
  for (size_t v = 0; v < 2; ++v) {
    const Json &a = whole["scenes"][0]["variants"][v], &b = parts["scenes"][0]["variants"][v];
    EXPECT_EQ(a["at_equal_samples"], b["at_equal_samples"]);
    EXPECT_EQ(a["bias"], b["bias"]);
  }
  EXPECT_EQ(whole["contests_at_equal_samples"], parts["contests_at_equal_samples"]);
}

TEST_F(CompareProgram, another_comparison_does_not_go_on_with_kept_runs) {
  std::string runs = "3";
  const auto again = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = {
        "--renderers", "PathTracer,PathTracer{next_event: false}", "--samples", "4", "--runs", runs, "--state", "kept",
        "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return compare(arguments);
  };
  ASSERT_EQ(again({}), 0) << err;
  ASSERT_EQ(again({"--json", "r.json"}), 0) << err;
  EXPECT_EQ(again({"--seed", "5"}), 2);
  EXPECT_TRUE(says("seed")) << err;
  EXPECT_EQ(again({"--set", "renderer.max_depth=3"}), 2);
  EXPECT_TRUE(says("the description differs")) << err;
  EXPECT_EQ(again({"--variant", "third:"}), 2);
  EXPECT_TRUE(says("'third'")) << err;
  folder.write("tiny.etd", scene_text("0.4 m"));
  EXPECT_EQ(again({}), 2);
  EXPECT_TRUE(says("of another comparison")) << err;
  folder.write("tiny.etd", scene_text("0.5 m"));
  // More runs may be added; a damaged run is refused.
  runs = "4";
  EXPECT_EQ(again({}), 0) << err;
  std::string bytes = file_text(folder / "kept/scene1-variant2-run1.run");
  bytes[bytes.size() - 10] ^= 1;
  folder.write("kept/scene1-variant2-run1.run", bytes);
  EXPECT_EQ(again({}), 2);
  EXPECT_TRUE(says("damaged")) << err;
  folder.write("kept/scene1-variant2-run1.run", "etendue compare run 1\n{}\n");
  EXPECT_EQ(again({}), 2);
  EXPECT_TRUE(says("remove it")) << err;
  folder.write("kept/comparison.json", "{\"kind\": 3}");
  EXPECT_EQ(again({}), 2);
  EXPECT_TRUE(says("cannot be read")) << err;
}

// ---- references
// ----------------------------------------------------------------------------------------------------------------------

TEST_F(CompareProgram, references_come_from_pictures_and_checkpoints) {
  ASSERT_EQ(run({"render", scene, "--samples", "4096", "-o", "r.exr", "-o", "r.npy", "--checkpoint", "r.state", "--quiet", "-o",
                 "r.png"}),
            0)
      << err;
  std::vector<double> errors;
  for (const char* reference : {"r.exr", "r.npy", "r.state"}) {
    ASSERT_EQ(compare({"--renderers", "PathTracer", "--samples", "16", "--runs", "3", "--reference", reference, "--json",
                       "r.json", "--state", std::string("of ") + reference}),
              0)
        << err;
    errors.push_back(variant(json(), "PathTracer")["at_equal_samples"]["relative_mean_square_error"]["value"]);
  }
  EXPECT_NEAR(errors[1], errors[2], 1e-4 * errors[2]);
  EXPECT_NEAR(errors[0], errors[2], 0.05 * errors[2]);
  EXPECT_EQ(compare({"--renderers", "PathTracer", "--samples", "4", "--reference", "r.png"}), 2);
  EXPECT_TRUE(says("for display")) << err;
  EXPECT_EQ(compare({"--renderers", "PathTracer", "--samples", "4", "--size", "8x8", "--reference", "r.exr"}), 2);
  EXPECT_TRUE(says("16 x 16 pixels")) << err;
  EXPECT_EQ(compare({"--renderers", "PathTracer", "--samples", "4", "--reference", "no.exr"}), 2);
  EXPECT_EQ(compare({"--renderers", "PathTracer", "--samples", "4", "--reference", "r.exr", "--reference", "r.npy"}), 2);
  EXPECT_TRUE(says("2 references for 1 scene")) << err;
  // A file that is read must not be an output.
  EXPECT_EQ(compare({"--renderers", "PathTracer", "--samples", "4", "--reference", "r.exr", "--report", "r.exr"}), 2);
  EXPECT_TRUE(says("would be overwritten")) << err;
}

// ---- what it refuses
// -------------------------------------------------------------------------------------------------------------------

TEST_F(CompareProgram, bad_input_exits_with_2_and_says_why) {
  const auto refused = [&](std::vector<std::string> arguments, const char* why) {
    EXPECT_EQ(compare(arguments), 2) << arguments.front();
    EXPECT_TRUE(says(why)) << why << "\n" << err;
  };
  refused({"--samples", "4"}, "nothing to compare");
  refused({"--renderers", "PathTracer"}, "a run needs a limit");
  refused({"--renderers", "PathTracer", "--samples", "4", "--time", "1s"}, "give one of them");
  refused({"--renderers", "PathTracr", "--samples", "4"}, "did you mean 'PathTracer'");
  refused({"--renderers", "PathTracer,PathTracer", "--samples", "4"}, "two variants 'PathTracer'");
  refused({"--renderers", "PathTracer,,", "--samples", "4"}, "a name is missing");
  refused({"--renderers", "Sphere", "--samples", "4"}, "is no renderer");
  refused({"--variant", "renderer.max_depth=4", "--samples", "4"}, "NAME: PATH=VALUE");
  refused({"--variant", "a: renderer.max_dept=4", "--samples", "4"}, "did you mean 'max_depth'");
  refused({"--variant", "a: 4", "--samples", "4"}, "PATH=VALUE");
  refused({"--variant", ": seed=4", "--samples", "4"}, "no name");
  refused({"--variant", "a:", "--variant", "b: image.width=8", "--samples", "4"}, "pictures of one size");
  refused({"--renderers", "FeatureRenderer", "--samples", "4"}, "give --reference");
  refused({"--renderers", "FeatureRenderer", "--samples", "4", "--reference-time", "1s"}, "no variant is unbiased");
  refused({"--renderers", "PathTracer", "--samples", "4", "--inset", "0,0,17,4"}, "beyond the 16 x 16");
  refused({"--renderers", "PathTracer", "--samples", "4", "--inset", "0,0,0,4"}, "not a part of the picture");
  refused({"--renderers", "PathTracer", "--samples", "4", "--report", "no/such/r.html"}, "no folder");
  refused({"--renderers", "PathTracer", "--samples", "4", "--json", "x", "--csv", "./x"}, "same file");
  refused({"--renderers", "PathTracer", "--samples", "4", "--json", "tiny.etd"}, "would be overwritten");
  refused({"--renderers", "PathTracer", "--time", "soon"}, "is not a duration");
  EXPECT_FALSE(exists("tiny.etd.runs"));
  for (const auto& [option, value] : {std::pair("--runs", "2"), std::pair("--significance", "2"), std::pair("--samples", "0"),
                                      std::pair("--samples", "1e99"), std::pair("--runs", "100000"), std::pair("--tile", "-1")})
    EXPECT_EQ(compare({"--renderers", "PathTracer", option, value}), 2) << option;
}

TEST_F(CompareProgram, runs_by_time_end_after_it) {
  ASSERT_EQ(compare({"--renderers", "PathTracer,PathTracer{next_event: false}", "--time", "0.02s", "--runs", "3", "--json",
                     "r.json"}),
            0)
      << err;
  const Json all = json();
  EXPECT_EQ(all["scenes"][0]["equal_processor_seconds"], 0.02);
  for (const Json& v : all["scenes"][0]["variants"]) {
    EXPECT_GE(v["processor_seconds"], 0.02);
    EXPECT_EQ(v["at_equal_time"]["runs"].size(), 3u);
  }
}

}  // namespace
}  // namespace etendue
