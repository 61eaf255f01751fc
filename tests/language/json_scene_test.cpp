// Scenes as JSON: they are read like the same scenes in the description language, errors in them are located, and every scene
// saved as JSON reads back the same.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "etendue/describe/reflection.h"
#include "etendue/render/job.h"
#include "language/json.h"
#include "support/language_test_support.h"
#include "support/process.h"

namespace etendue::language_test {
namespace {

namespace fs = std::filesystem;

Ref<LanguagePart> json_part(const std::string& text, const std::string& folder = {}) {
  try {
    return ref_cast<LanguagePart>(parse_component(text, "text.json", folder));
  } catch (const Errors& e) {
    for (const Error& error : e.errors) ADD_FAILURE() << show(error);
    return make<LanguagePart>();
  }
}
std::string json_errors(const std::string& text) {
  return errors_of([&] { parse_component(text, "text.json"); });
}
bool same(const Ref<Component>& a, const Ref<Component>& b) { return equal(Value(a), Value(b)); }

TEST(JsonScene, ReadsEveryKindOfMember) {
  const std::string json = R"json({
    "class": "LanguagePart", "flag": true, "count": 7, "large": 9007199254740991, "length": "10 cm", "angle": 30,
    "wavelength": "0.5 um", "precise": 0.1, "title": "a \"text\" = 1 + 1", "file": "sub/x.ply", "mode": "hidden", "uv": [1, 2],
    "direction": "-[0, 0, 1]", "from": [1, 2, 3], "color": [0.1, 0.2, 0.3], "transform": "translate(0, 1 m, 0)",
    "child": 4, "parts": [ { "class": "LanguageConstant", "value": 2 }, 3 ], "points": [[0, 0, 0], [1, 2, 3]],
    "indices": [1, 2, 3], "weights": ["1 / 4", 2], "words": ["x", "1 + 1"], "modes": ["visible", "hidden"] })json";
  const std::string text = R"(LanguagePart {
    flag: true, count: 7, large: 9007199254740991, length: 10 cm, angle: 30, wavelength: 0.5 um, precise: 0.1
    title: "a \"text\" = 1 + 1", file: "sub/x.ply", mode: hidden, uv: [1, 2], direction: -[0, 0, 1], from: [1, 2, 3]
    color: rgb(0.1, 0.2, 0.3), transform: translate(0, 1 m, 0), child: 4, parts: [LanguageConstant { value: 2 }, 3]
    points: [[0, 0, 0], [1, 2, 3]], indices: [1, 2, 3], weights: [0.25, 2], words: ["x", "1 + 1"], modes: [visible, hidden] })";
  EXPECT_TRUE(same(json_part(json, "folder"), part(text, "folder"))) << write_description(*json_part(json, "folder"));
  EXPECT_TRUE(json_part(R"json({"class": "LanguagePart", "color": "2 * srgb(\"#ff8000\")", "child": null})json")->color);
  EXPECT_EQ(json_part(R"({"class": "LanguagePart", "transform": [1,0,0,4, 0,1,0,5, 0,0,1,6]})")->transform.still(),
            Transform::translate({4, 5, 6}));
  EXPECT_EQ(json_part("\xEF\xBB\xBF{\"class\": \"LanguagePart\", \"title\": \"\\u00e9\\ud83d\\ude00\"}")->title, "é😀");
}

TEST(JsonScene, NamesParamsAndIncludes) {
  const Folder folder;
  folder.write("names.json", R"({ "$names": { "red": { "class": "LanguagePart", "count": "n" } } })");
  folder.write("more.etd", "n = 5\n");
  folder.write("main.json", R"({
    "$schema": "etendue.schema.json",
    "$include": ["names.json", "more.etd"],
    "$params": { "seed": 3, "title": "\"a\"" },
    "$names": { "two": "seed - 1", "blue": { "class": "LanguagePart", "child": "red", "count": "two" } },
    "class": "Job", "camera": null, "scene": null, "seed": "2 * seed"
  })");
  LoadOptions options;
  EXPECT_EQ(load_job(folder.path() + "/main.json", options)->seed, 6u);
  options.defines = {{"seed", "10"}, {"title", "bare"}};
  EXPECT_EQ(load_job(folder.path() + "/main.json", options)->seed, 20u);
  const auto shared = json_part(R"({ "$names": { "a": { "class": "LanguagePart" } }, "class": "LanguagePart",
                                    "child": "a", "parts": ["a", "a"] })");
  EXPECT_EQ(shared->child, shared->parts[1]);
  EXPECT_EQ(shared->child->origin->name, "a");
}

TEST(JsonScene, ErrorsAreLocated) {
  EXPECT_EQ(json_errors("{\n  \"class\": \"LanguagePart\",\n  \"cout\": 4 }"),
            "3:3: LanguagePart has no member 'cout' (did you mean 'count'?)");
  EXPECT_EQ(json_errors("{ \"class\": \"LanguagePart\", \"count\": 4000 }"),
            "1:37: LanguagePart.count must be from 0 to 1000, not 4000");
  EXPECT_EQ(json_errors("{ \"class\": \"LanguagePart\", \"count\": \"1 + x\" }"), "1:42: 'x' is not defined");
  EXPECT_EQ(json_errors("{ \"class\": \"LanguagePart\", \"color\": \"srgb(\\\"#ff\\\", 1) * y\" }").substr(0, 5), "1:38:");
  EXPECT_EQ(json_errors("{ \"class\": \"LanguagePart\", \"color\": \"rgb(\\\"rec2020\\\", 1, 1, 1) * y\" }"),
            "1:66: 'y' is not defined");
  EXPECT_EQ(json_errors("{ \"class\": \"LanguagePart\", \"count\": 1, \"count\": 2 }"),
            "1:40: \"count\" is already set at line 1:28");
  EXPECT_EQ(json_errors("{ \"class\": \"LanguagePart\", \"child\": {} }"),
            "1:37: an object must name its class: \"class\": \"…\"");
  EXPECT_EQ(json_errors("{ \"class\": \"LanguagePart\", \"child\": { \"class\": \"Lambertain\" } }"),
            "1:37: there is no class 'Lambertain' (did you mean 'Lambertian'?)");
  EXPECT_EQ(json_errors("{ \"class\": \"LanguagePart\", \"child\": \"LanguageConstant\" }"),
            "1:38: 'LanguageConstant' is a class: write { \"class\": \"LanguageConstant\" }");
  EXPECT_EQ(json_errors("{ \"class\": \"LanguagePart\", \"mode\": \"hiden\" }"),
            "1:36: LanguagePart.mode has no choice 'hiden' (did you mean 'hidden'?); known are visible, hidden");
  EXPECT_EQ(json_errors("{ \"$nams\": {}, \"class\": \"LanguagePart\" }"),
            "1:3: there is no key \"$nams\" (did you mean '$names'?)");
  EXPECT_EQ(json_errors("{ \"$names\": { \"a b\": 1 }, \"class\": \"LanguagePart\" }"),
            "1:15: 'a b' cannot be a name: names are letters, digits and '_'");
  EXPECT_EQ(json_errors("[1, 2]"), "1:1: a render description in JSON is an object: { \"class\": \"Job\", … }");
  EXPECT_EQ(json_errors("{ \"class\": \"LanguagePart\",\n \"count\" 4 }").substr(0, 19), "2:10: invalid JSON:");
  EXPECT_NE(json_errors("").find("invalid JSON"), std::string::npos);
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "{\"child\":";
  EXPECT_EQ(json_errors(deep), "1:2305: too deeply nested: more than 256 levels of brackets");
  EXPECT_NE(json_errors(std::string(100000, '[')).find("too deeply nested"), std::string::npos);
}

TEST(JsonScene, ErrorsSayTheWayToTheirPlace) {
  try {
    parse_component(
        "{ \"class\": \"LanguagePart\", \"parts\": [ 1, { \"class\": \"LanguagePart\",\n  \"child\": { \"class\": "
        "\"LanguagePart\", "
        "\"length\": \"1 K\" } } ] }",
        "way.json");
    ADD_FAILURE();
  } catch (const Errors& e) {
    EXPECT_EQ(show(e.errors[0]),
              "way.json:2:50: parts[1].child.length: LanguagePart.length expects a length [m], not a temperature\n"
              "    2 |   \"child\": { \"class\": \"LanguagePart\", \"length\": \"1 K\" } } ] }\n"
              "      |                                                  ^");
  }
}

std::vector<std::string> scenes() {
  std::vector<std::string> found;
  for (const auto& entry : fs::recursive_directory_iterator(ETENDUE_SOURCE_DIR "/scenes")) {
    if (entry.path().extension() != ".etd" || entry.file_size() > 200000) continue;
    std::ostringstream text;
    text << std::ifstream(entry.path()).rdbuf();
    // Its 60 000 hairs, if that file was made, take long to read.
    if (text.str().find("data/highland_cow") != std::string::npos) continue;
    if (text.str().find("Job {") != std::string::npos) found.push_back(entry.path().string());
  }
  std::sort(found.begin(), found.end());
  return found;
}

TEST(JsonScene, EveryExampleReadsBackAsItWas) {
  size_t checked = 0;
  for (const std::string& file : scenes()) {
    Ref<Job> job;
    try {
      job = load_job(file);
    } catch (const Errors&) {
      continue;  // whether files made by scripts exist is checked elsewhere
    }
    const std::string folder = fs::path(file).parent_path().string();
    for (const bool all : {false, true}) {
      const std::string json = write_json(*job, all, folder);
      try {
        const Ref<Job> again = load_job_text(json, "again.json", folder);
        EXPECT_TRUE(same(job, again)) << file << "\n" << write_description(*again, all, folder);
        EXPECT_EQ(write_json(*again, all, folder), json) << file;
        EXPECT_EQ(write_description(*again, all, folder), write_description(*job, all, folder)) << file;
      } catch (const Errors& e) {
        for (const Error& error : e.errors) ADD_FAILURE() << file << ": " << show(error);
      }
    }
    ++checked;
  }
  EXPECT_GT(checked, 10u);
}

TEST(JsonScene, TheProgramReadsAndWritesIt) {
  const TemporaryFolder folder;
  const auto run = [&](const std::vector<std::string>& arguments) {
    Process process(ETENDUE_BINARY_DIR "/etendue", arguments, folder, folder.path());
    const int status = process.wait();
    EXPECT_EQ(status, 0) << process.err();
    return process.out();
  };
  const std::string box = ETENDUE_SOURCE_DIR "/scenes/cornell_box.etd";
  run({"save", box, "-o", "box.json"});
  EXPECT_NE(run({"check", "box.json"}).find("box.json is good"), std::string::npos);
  run({"save", "box.json", "-o", "again.etd"});
  run({"save", box, "-o", "direct.etd"});
  const auto text = [&](const std::string& name) {
    std::ostringstream all;
    all << std::ifstream(fs::path(folder.path()) / name).rdbuf();
    return all.str();
  };
  EXPECT_EQ(text("again.etd"), text("direct.etd"));
  EXPECT_FALSE(text("again.etd").empty());
  run({"render", "box.json", "--samples", "1", "--size", "8x8", "-o", "x.npy"});
  run({"render", "direct.etd", "--samples", "1", "--size", "8x8", "-o", "y.npy"});
  EXPECT_EQ(text("x.npy"), text("y.npy"));
}

TEST(JsonScene, TheSchemaSaysWhatItIsOf) {
  const auto schema = nlohmann::json::parse(json_schema());
  EXPECT_EQ(schema["$id"], "urn:etendue:scene:" ETENDUE_VERSION);
  EXPECT_NE(schema["title"].get<std::string>().find(ETENDUE_VERSION), std::string::npos);
  EXPECT_NE(schema["description"].get<std::string>().find(".json"), std::string::npos);
  for (const char* key : {"$schema", "$include", "$plugin", "$params", "$names", "scene", "class"})
    EXPECT_TRUE(schema["properties"].contains(key)) << key;
}

}  // namespace
}  // namespace etendue::language_test
