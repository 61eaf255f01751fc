// Changing descriptions by path, and writing them.

#include <gtest/gtest.h>

#include "etendue/describe/color.h"
#include "support/language_test_support.h"

namespace etendue::language_test {
namespace {

// ---- setting by path --------------------------------------------------------------------------------------------------

TEST(Language, SetsByPath) {
  const auto p = part(
      "LanguagePart { child: LanguagePart {}, parts: [LanguagePart {}, LanguagePart {}], points: [[1,2,3],[4,5,6]], from: "
      "[1,2,3] }");
  set_path(*p, "count", "2 * 4");
  EXPECT_EQ(p->count, 8);
  set_path(*p, "child.length", "3 cm");
  EXPECT_FLOAT_EQ(p->child->length, 0.03f);
  set_path(*p, "parts[1].mode", "hidden");
  EXPECT_EQ(p->parts[1]->mode, LanguageMode::hidden);
  set_path(*p, "parts[1]", "LanguagePart { count: 77 }");
  EXPECT_EQ(p->parts[1]->count, 77);
  set_path(*p, "title", "bare words.png");
  EXPECT_EQ(p->title, "bare words.png");
  set_path(*p, "title", "\"quoted\"");
  EXPECT_EQ(p->title, "quoted");
  set_path(*p, "file", "dir/out.png");
  EXPECT_EQ(p->file.resolved(), "dir/out.png");
  set_path(*p, "words", "[one, \"two\"]");
  EXPECT_EQ(p->words, (std::vector<std::string>{"one", "two"}));
  set_path(*p, "points[1]", "[7, 8, 9] cm");
  EXPECT_EQ(p->points[1], (Point3{0.07f, 0.08f, 0.09f}));
  EXPECT_EQ(p->points[0], (Point3{1, 2, 3}));
  set_path(*p, "from[1]", "20 cm");
  EXPECT_EQ(p->from, (Point3{1, 0.2f, 3}));

  const auto wrong = [&](const char* path, const char* text) { return errors_of([&] { set_path(*p, path, text); }); };
  EXPECT_EQ(wrong("cout", "1"), "1:1: LanguagePart has no member 'cout' (did you mean 'count'?)");
  EXPECT_EQ(wrong("child.cout", "1"), "1:7: LanguagePart has no member 'cout' (did you mean 'count'?)");
  EXPECT_EQ(wrong("child.child.count", "1"), "1:7: child is none: there is nothing in it to set");
  EXPECT_EQ(wrong("parts[2].count", "1"), "1:1: parts has 2 entries: there is no [2]");
  EXPECT_EQ(wrong("parts.count", "1"), "1:1: parts is a list: say which entry, as in parts[0]");
  EXPECT_EQ(wrong("count.x", "1"), "1:1: count is a number, which has no members");
  EXPECT_EQ(wrong("points[2]", "[1,2,3]"), "1:1: points has 2 entries: there is no [2]");
  EXPECT_EQ(wrong("points[0]", "[1,2]"), "1:11: an entry of points is 3 numbers, not a list of 2 numbers");
  EXPECT_EQ(wrong("points[0]", "[1,2,3] K"), "1:11: points does not take a temperature");
  EXPECT_EQ(wrong("parts[x].count", "1"), "1:6: expected an index such as [0]");
  EXPECT_EQ(wrong("child..count", "1"), "1:7: expected the name of a member, not ''");
  EXPECT_EQ(wrong("count", "4000"), "1:7: LanguagePart.count must be from 0 to 1000, not 4000");
  EXPECT_EQ(wrong("count", "1 +"), "1:10: expected a value, not the end of the text");
  EXPECT_EQ(wrong("mode", "visble"),
            "1:6: LanguagePart.mode has no choice 'visble' (did you mean 'visible'?); known are visible, hidden");
  EXPECT_EQ(p->count, 8);  // no member was changed by the refused settings
  try {
    set_path(*p, "child.count", "many");
    ADD_FAILURE();
  } catch (const Error& e) {
    EXPECT_EQ(show(e),
              "--set child.count:1:13: LanguagePart.count expects a whole number, not a string\n    1 | child.count=many\n     "
              " |             ^");
  }
}

// ---- writing --------------------------------------------------------------------------------------------------------

void expect_round_trip(const Ref<LanguagePart>& p, bool all, const std::string& folder = {}) {
  const std::string written = write_description(*p, all, folder);
  const auto again = part(written, folder);
  EXPECT_TRUE(equal(Value(Ref<Component>(p)), Value(Ref<Component>(again)))) << written;
  EXPECT_EQ(write_description(*again, all, folder), written);
}

TEST(Language, WritesOnlyWhatDiffers) {
  EXPECT_EQ(write_description(*part("LanguagePart { count: 3, length: 50 cm }")), "LanguagePart {}\n");
  EXPECT_EQ(
      write_description(*part(
          "LanguagePart { length: 10 cm, angle: 39.3, wavelength: 632.8 nm, mode: hidden, from: [1, 2, -3] cm, child: 0.25 }")),
      "LanguagePart {\n"
      "    length: 0.1 m\n"
      "    angle: 39.3 deg\n"
      "    wavelength: 632.8 nm\n"
      "    mode: hidden\n"
      "    from: [0.01, 0.02, -0.03] m\n"
      "    child: 0.25\n"
      "}\n");
  EXPECT_EQ(write_description(*part("LanguagePart { child: LanguagePart { count: 4 }, parts: [1, LanguagePart {}] }")),
            "LanguagePart { child: LanguagePart { count: 4 }, parts: [1, LanguagePart {}] }\n");
  EXPECT_EQ(write_description(*part("white = LanguagePart { count: 4 }\nLanguagePart { child: white }")),
            "white = LanguagePart { count: 4 }\n\nLanguagePart { child: white }\n");
}

TEST(Language, WritesSharedComponentsOnce) {
  const auto p = make<LanguagePart>(), shared = make<LanguagePart>(), inner = make<LanguagePart>();
  inner->count = 9;
  shared->child = inner;
  shared->parts = {inner};
  p->child = shared;
  p->parts = {shared, make<LanguageConstant>(), inner};
  EXPECT_EQ(write_description(*p),
            "language_part = LanguagePart { count: 9 }\n"
            "language_part_2 = LanguagePart { child: language_part, parts: [language_part] }\n\n"
            "LanguagePart { child: language_part_2, parts: [language_part_2, 0, language_part] }\n");
  expect_round_trip(p, false);
  const auto again = part(write_description(*p));
  EXPECT_EQ(again->child, again->parts[0]);
  EXPECT_EQ(again->child->child, again->parts[2]);
  // Names that two components share, or that cannot be parsed, are replaced.
  shared->origin = std::make_unique<Component::Origin>();
  inner->origin = std::make_unique<Component::Origin>();
  shared->origin->name = inner->origin->name = "twin";
  EXPECT_EQ(write_description(*p).substr(0, 41), "twin = LanguagePart { count: 9 }\ntwin_2 =");
  shared->origin->name = "two words";
  expect_round_trip(p, false);
}

TEST(Language, RoundTripOfEveryKind) {
  const auto p = part(R"(
    shared = LanguagePart { title: "tab\t quote\" back\\ line\n", count: 5 }
    LanguagePart {
      flag: true, count: 7, large: 9007199254740991, length: 12.3456789 cm, angle: 1.1 rad, wavelength: 587.56 nm
      precise: 0.1234567890123456789, title: "é", file: "models/x.ply", mode: hidden
      uv: [0.1, 1e-30], direction: [1, -2, 3.3e20], from: [27.8, 27.3, -80] cm
      color: 0.7 * rgb(0.5, 0.2, 0.1)
      transform: translate(1, 2, 3) * rotate(33, "y") * scale(0.1)
      child: shared
      parts: [shared, LanguagePart { transform: keyframes(0, scale(1), 0.3 s, translate(1, 2, 3)), color: complex(0.2, 3.9) },
              0.5, LanguagePart { color: spectrum([400, 500, 600], [0.1, 0.25, 1]) }, none,
              LanguagePart { color: none }, LanguageNeedy { source: "" }, LanguagePart { color: glass("N-BK7") }]
      points: [[0.1, 0.2, 0.3], [4, 5, 6]] mm
      indices: [1, 2, 1000000], weights: [0.1, 0.2, 1e-20], words: ["a", "b c"], modes: [hidden, visible]
    })");
  expect_round_trip(p, false);
  expect_round_trip(p, true);
  for (const Member& m : p->class_info().members)
    EXPECT_FALSE(equal(m.get(*p, m), m.default_value)) << m.name << " is not tested";
}

TEST(Language, RoundTripOfRandomNumbers) {
  const auto p = make<LanguagePart>();
  std::uint64_t state = 7;
  for (int i = 0; i < 20000; ++i) {
    const auto bits = std::uint32_t(mix_bits(++state));
    const auto x = std::bit_cast<float>((bits & 0x807FFFFF) | (100 + (bits >> 24) % 50) << 23);
    p->points.push_back({x, -x, 1 / x});
    p->weights.push_back(x);
    p->length = std::abs(x);
    p->angle = x;
    p->wavelength = x;
    p->from = {x, 2 * x, 3 * x};
    p->precise = double(x) * 1.0000000001;
    if (i % 200 != 0) continue;
    const auto again = part(write_description(*p));
    ASSERT_EQ(again->angle, p->angle);
    ASSERT_EQ(again->wavelength, p->wavelength);
    ASSERT_EQ(again->length, p->length);
    ASSERT_EQ(again->precise, p->precise);
    ASSERT_EQ(again->from, p->from);
    p->weights.clear();
    p->points.clear();
  }
  for (int i = 0; i < 10000; ++i) p->points.push_back({0.1f * float(i), 1.0f / float(i + 1), -float(i)});
  const std::string written = write_description(*p);
  size_t longest = 0;
  for (size_t begin = 0; begin < written.size();) {
    const size_t end = written.find('\n', begin);
    longest = std::max(longest, end - begin);
    begin = end + 1;
  }
  EXPECT_LE(longest, 122u);
  EXPECT_EQ(part(written)->points, p->points);
}

TEST(Language, PathsAreWrittenRelativeToTheFolder) {
  const Folder folder;
  folder.write("sub/paint.csv", "nm,value\n400,0.1\n700,0.9\n");
  const auto p = part("LanguagePart { file: \"sub/x.ply\", color: 2 * spectrum(\"sub/paint.csv\") }", folder.path());
  EXPECT_EQ(write_description(*p, false, folder.path()),
            "LanguagePart { file: \"sub/x.ply\", color: 2 * spectrum(\"sub/paint.csv\") }\n");
  EXPECT_EQ(write_description(*p, false, folder.path() + "/sub"),
            "LanguagePart { file: \"x.ply\", color: 2 * spectrum(\"paint.csv\") }\n");
  EXPECT_NE(write_description(*p).find("file: \"" + folder.path() + "/sub/x.ply\""), std::string::npos);
  expect_round_trip(p, false, folder.path());
  expect_round_trip(part("LanguagePart { file: \"/absolute/x.ply\" }"), false, folder.path());
}

TEST(Language, WritesValues) {
  for (const char* text : {"true", "none", "\"a\\n\"", "[1, 2, 3]", "[[1, 2], [3, 4]]", "[\"a\", true]", "0.25 m", "[1, 2] K",
                           "blackbody(2856 K)", "matrix(1, 0, 0, 1, 0, 1, 0, 2, 0, 0, 1, 3)", "LanguagePart { count: 4 }"}) {
    EXPECT_EQ(write_value(parse_value(text)), text);
  }
}

}  // namespace
}  // namespace etendue::language_test
