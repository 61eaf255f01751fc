// Files that are included with values for their params, under names, and descriptions of films.

#include <gtest/gtest.h>

#include "support/language_test_support.h"

namespace etendue::language_test {
namespace {

constexpr const char* tree =
    "param height = 2 m\nparam bark = LanguagePart { count: 1 }\n"
    "trunk = LanguagePart { length: height, child: bark }\ncrown = [trunk, LanguagePart { length: height / 2 }]\n";

Ref<LanguagePart> part_in(const Folder& folder, const std::string& text) { return part(text, folder.path()); }

std::string errors_in(const Folder& folder, const std::string& text) {
  std::string all = errors_of([&] { parse_component(text, "text", folder.path()); });
  for (size_t at = all.find(folder.path()); at != std::string::npos; at = all.find(folder.path()))
    all.erase(at, folder.path().size() + 1);
  return all;
}

TEST(IncludedFiles, TakeValuesForTheirParams) {
  const Folder folder;
  folder.write("tree.etd", tree);
  EXPECT_EQ(part_in(folder, "include \"tree.etd\" with { height: 3 m }\nLanguagePart { child: trunk }")->child->length, 3.0f);
  // Names in the given values are those of the including file.
  const auto p = part_in(folder,
                         "height = 5 m\ninclude \"tree.etd\" with { height: 2 * height,\n bark: mine } as tall\n"
                         "include \"tree.etd\" with { height: 1 m\n bark: mine } as small\nmine = LanguagePart { count: 7 }\n"
                         "LanguagePart { parts: join(tall.crown, small.crown, [tall.trunk]) }");
  ASSERT_EQ(p->parts.size(), 5u);
  EXPECT_EQ(p->parts[0]->length, 10.0f);
  EXPECT_EQ(p->parts[1]->length, 5.0f);
  EXPECT_EQ(p->parts[2]->length, 1.0f);
  EXPECT_EQ(p->parts[0].get(), p->parts[4].get());
  EXPECT_EQ(p->parts[0]->child.get(), p->parts[2]->child.get());
  EXPECT_EQ(p->parts[0]->child->count, 7);
  const std::string written = write_description(*p);
  EXPECT_NE(written.find("tall_trunk = LanguagePart"), std::string::npos) << written;
  EXPECT_NE(written.find("small_trunk = LanguagePart"), std::string::npos) << written;
  EXPECT_TRUE(equal(Value(Ref<Component>(p)), Value(Ref<Component>(part(written)))));
}

// A file that is also included at the top level is shared by all named includes; one that is not is read once for each name.
TEST(IncludedFiles, UnderNamesFindWhatIsAroundThem) {
  const Folder folder;
  folder.write("wood.etd", "param tint = 3\nwood = LanguagePart { count: tint }\n");
  folder.write("tree.etd", "include \"wood.etd\"\ntrunk = LanguagePart { child: wood }\n");
  const std::string both = "include \"tree.etd\" as a\ninclude \"tree.etd\" as b\nLanguagePart { parts: [a.trunk, b.trunk] }";
  const auto own = part_in(folder, both), shared = part_in(folder, both + "\ninclude \"wood.etd\"");
  EXPECT_NE(own->parts[0]->child.get(), own->parts[1]->child.get());
  EXPECT_EQ(shared->parts[0]->child.get(), shared->parts[1]->child.get());
  folder.write("pair.etd", "include \"tree.etd\" with { tint: 8 } as inner\nouter = inner.trunk\n");
  EXPECT_EQ(part_in(folder, "include \"pair.etd\" as p\nLanguagePart { child: p.inner.trunk }")->child->child->count, 8);
}

TEST(IncludedFiles, WrongValuesAreTold) {
  const Folder folder;
  folder.write("tree.etd", tree);
  const auto errors = [&](const std::string& include) {
    return errors_in(folder, include + "\nLanguagePart { parts: a.crown }");
  };
  EXPECT_EQ(errors("include \"tree.etd\" with { hight: 3 m } as a"),
            "1:27: 'tree.etd' has no param 'hight' (did you mean 'height'?)");
  EXPECT_EQ(errors("include \"tree.etd\" with { trunk: 3 m } as a"),
            "1:27: 'trunk' of 'tree.etd' is not a param: only those can be replaced; it has bark, height");
  EXPECT_EQ(errors("include \"tree.etd\" as a\ninclude \"tree.etd\" as a"),
            "2:23: a file is included as 'a' already, at line 1:23");
  EXPECT_EQ(errors("include \"tree.etd\" with { height: 1 K } as a"),
            "3:32: LanguagePart.length expects a length [m], not a temperature (in 'a', included at text:1:44)\n"
            "4:40: LanguagePart.length expects a length [m], not a temperature (in 'a', included at text:1:44)");
  EXPECT_EQ(
      errors_in(folder, "include \"tree.etd\"\ninclude \"tree.etd\" with { height: 3 m }\nLanguagePart { parts: crown }"),
      "2:9: 'tree.etd' is included already, at line 1:9: include it as a name of its own to give it other params: … } as name");
  EXPECT_EQ(
      errors_in(folder, "include \"tree.etd\" as a\nLanguagePart { child: a.trunc, parts: b.crown }"),
      "2:23: 'a.trunc' is not defined (did you mean 'a.trunk'?)\n2:39: 'b.crown' is not defined (did you mean 'a.crown'?)");
  folder.write("idle.etd", "param x = 3\ncrown = []\n");
  EXPECT_EQ(errors("include \"idle.etd\" with { x: 4 } as a"), "1:27: has no effect: nothing in 'idle.etd' uses its param 'x'");
  EXPECT_EQ(
      errors("a.b = 3\ninclude \"tree.etd\" as a"),
      "1:1: 'a.b' cannot be defined here: a '.' stands between the name that a file was included as and a name of that file");
}

TEST(IncludedFiles, ThatDoubleWithEachLevelAreBounded) {
  const Folder folder;
  folder.write("f0.etd", "x = 1\n");
  for (int i = 1; i <= 20; ++i) {
    const std::string before = "include \"f" + std::to_string(i - 1) + ".etd\" as ";
    folder.write("f" + std::to_string(i) + ".etd", before + "a\n" + before + "b\n");
  }
  EXPECT_NE(
      errors_in(folder, "include \"f20.etd\"\nLanguagePart {}").find("too much is included under names: at most 1000 files"),
      std::string::npos);
}

TEST(IncludedFiles, InJsonTakeValuesAsWell) {
  const Folder folder;
  folder.write("tree.etd", tree);
  const std::string text =
      R"json({ "$include": [{ "file": "tree.etd", "with": { "height": "4 m", "bark": { "class": "LanguagePart" } }, "as": "a" }],
    "$names": { "f(x, y = 2 * x)": { "class": "LanguagePart", "count": "x + y" } },
    "class": "LanguagePart", "child": "a.trunk", "parts": "[f(i) for i in 1..4]", "count": "if frame == 0 then 5 else 6" })json";
  const auto p = ref_cast<LanguagePart>(parse_component(text, "text.json", folder.path()));
  EXPECT_EQ(p->child->length, 4.0f);
  EXPECT_EQ(p->count, 5);
  ASSERT_EQ(p->parts.size(), 3u);
  EXPECT_EQ(p->parts[2]->count, 9);
  const auto errors = [&](const std::string& head) {
    return errors_of([&] { parse_component("{ " + head + ", \"class\": \"LanguagePart\" }", "text.json", folder.path()); });
  };
  EXPECT_EQ(errors("\"$include\": { \"fil\": \"tree.etd\" }"),
            "1:15: an include in braces needs its \"file\"\n1:17: there is no key \"fil\" (did you mean 'file'?)");
  EXPECT_EQ(errors("\"$names\": { \"f(x, y = )\": 3 }"), "1:25: expected a value, not ')'");
}

TEST(Films, FrameAndTimeAreWhatTheReaderSays) {
  LoadOptions options;
  options.frame = 12;
  options.time = 0.5;
  EXPECT_EQ(load_job_text(job_with("seed: frame, time_limit: 2 * time"), "text", {}, options)->seed, 12u);
  EXPECT_EQ(load_job_text(job_with("seed: frame, time_limit: 2 * time"), "text", {}, options)->time_limit, 1.0);
  EXPECT_EQ(load_job_text("frame = 3\n" + job_with("seed: frame"), "text", {}, options)->seed, 3u);
  EXPECT_EQ(value_errors("frame + 1"), "1:1: 'frame' is not defined");
}

TEST(Films, ThatDoNotMoveAreWarnedOf) {
  LoadOptions options;
  options.animated = true;
  testing::internal::CaptureStderr();
  load_job_text(job_with("seed: frame"), "moving", {}, options);
  load_job_text(job_with("seed: 3"), "still", {}, options);
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_EQ(said.find("moving"), std::string::npos) << said;
  EXPECT_NE(said.find("still: warning: nothing in it depends on frame or time"), std::string::npos) << said;
}

}  // namespace
}  // namespace etendue::language_test
