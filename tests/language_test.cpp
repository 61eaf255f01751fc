// The render description language, on small components of its own.

#include "etendue/language.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>

#include "etendue/color.h"
#include "etendue/description.h"
#include "etendue/job.h"

namespace etendue {

enum class LanguageMode : std::uint8_t { visible, hidden };

/// Something with every kind of member.
class LanguagePart : public Component {
 public:
  using Interface = LanguagePart;
  using Parent = Component;

  bool flag = false;
  int count = 3;
  std::uint64_t large = 0;
  float length = 0.5f;
  float angle = 45;
  float wavelength = 550;
  double precise = 0;
  std::string title;
  FilePath file;
  LanguageMode mode = LanguageMode::visible;
  Vector2 uv;
  Vector3 direction{0, 0, 1};
  Point3 from;
  Color color = flat_spectrum(0.5f);
  AnimatedTransform transform;
  Ref<LanguagePart> child;
  std::vector<Ref<LanguagePart>> parts;
  std::vector<Point3> points;
  std::vector<int> indices;
  std::vector<float> weights;
  std::vector<std::string> words;
  std::vector<LanguageMode> modes;

  static void describe(Description<LanguagePart>& d) {
    d.summary("A part for tests.")
        .member<&LanguagePart::flag>("flag", "", "a switch")
        .member<&LanguagePart::count>("count", "1", "a whole number", range(0, 1000))
        .member<&LanguagePart::large>("large", "1", "a large whole number")
        .member<&LanguagePart::length>("length", "m", "a length", at_least(0))
        .member<&LanguagePart::angle>("angle", "deg", "an angle")
        .member<&LanguagePart::wavelength>("wavelength", "nm", "a wavelength")
        .member<&LanguagePart::precise>("precise", "1", "a double")
        .member<&LanguagePart::title>("title", "", "a string")
        .member<&LanguagePart::file>("file", "", "a file")
        .member<&LanguagePart::mode>("mode", "", "a choice", choices("visible", "hidden"))
        .member<&LanguagePart::uv>("uv", "1", "a 2-vector")
        .member<&LanguagePart::direction>("direction", "1", "a vector")
        .member<&LanguagePart::from>("from", "m", "a point")
        .member<&LanguagePart::color>("color", "1", "a colour")
        .member<&LanguagePart::transform>("transform", "", "a transform")
        .member<&LanguagePart::child>("child", "", "another part")
        .member<&LanguagePart::parts>("parts", "", "more parts")
        .member<&LanguagePart::points>("points", "m", "points")
        .member<&LanguagePart::indices>("indices", "1", "whole numbers")
        .member<&LanguagePart::weights>("weights", "1", "numbers")
        .member<&LanguagePart::words>("words", "", "strings")
        .member<&LanguagePart::modes>("modes", "", "choices", choices("visible", "hidden"));
  }
};
static const Register<LanguagePart> part_registered;

/// Needs a member, and a plain number stands for it.
class LanguageConstant final : public LanguagePart {
 public:
  float value = 0;
  static void describe(Description<LanguageConstant>& d) {
    d.summary("A number as a part, for tests.")
        .member<&LanguageConstant::value>("value", "1", "the number", range(-10, 10))
        .literal("value");
  }
};
static const Register<LanguageConstant> constant_registered;

class LanguageNeedy final : public LanguagePart {
 public:
  FilePath source;
  static void describe(Description<LanguageNeedy>& d) {
    d.summary("A part with a required member, for tests.")
        .member<&LanguageNeedy::source>("source", "", "must be there", required);
  }
};
static const Register<LanguageNeedy> needy_registered;

namespace {

Ref<LanguagePart> part(const std::string& text, const std::string& folder = {}) {
  try {
    return ref_cast<LanguagePart>(parse_component(text, "text", folder));
  } catch (const Errors& e) {
    for (const Error& error : e.errors) ADD_FAILURE() << show(error);
    return make<LanguagePart>();
  }
}

/// All errors of a text as "line:column: message" lines.
template <class Load>
std::string errors_of(Load&& load) {
  std::string all;
  const auto line = [&](const Error& e) {
    if (!all.empty()) all += "\n";
    if (e.location.line > 0) all += std::to_string(e.location.line) + ":" + std::to_string(e.location.column) + ": ";
    all += e.what();
    EXPECT_TRUE(e.location.known()) << e.what();
  };
  try {
    load();
  } catch (const Errors& e) {
    for (const Error& error : e.errors) line(error);
  } catch (const Error& e) {
    line(e);
  }
  return all;
}

std::string part_errors(const std::string& text) {
  return errors_of([&] { parse_component(text); });
}
std::string value_errors(const std::string& text) {
  return errors_of([&] { parse_value(text); });
}
std::string job_errors(const std::string& text, const LoadOptions& options = {}) {
  return errors_of([&] { load_job_text(text, "job", {}, options); });
}

/// A Job that is complete enough to be loaded.
std::string job_with(const std::string& members) { return "Job { camera: none, scene: none, " + members + " }"; }

double number(const std::string& text) {
  try {
    const Value v = parse_value(text);
    if (const auto* n = v.as<Number>()) return n->value;
    ADD_FAILURE() << text << " is " << v.kind();
  } catch (const Errors& e) {
    ADD_FAILURE() << show(e.errors.front());
  }
  return 0;
}

/// A folder of files that is removed in the end.
class Folder {
 public:
  Folder()
      : path_(std::filesystem::temp_directory_path() /
              ("etendue_language_" + std::to_string(std::hash<const void*>()(this) ^ size_t(getpid())))) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_ / "sub");
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return (path_ / name).string();
  }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

// ---- values ---------------------------------------------------------------------------------------------------------

TEST(Language, ReadsEveryKindOfMember) {
  const auto p = part(R"(LanguagePart {
    flag: true, count: 7
    large: 9007199254740991
    length: 10 cm   # a comment
    angle: 1 rad
    wavelength: 650 nm,
    precise: 0.1
    title: "a \"b\" \\ \n\t é"
    file: "x.ply"
    mode: hidden
    uv: [1, 2]
    direction: [1, -2, 3.5]
    from: [278, 273, -800] mm
    color: rgb(0.5, 0.2, 0.1)
    transform: translate(1, 2 m, 3 cm)
    child: LanguagePart { count: 8 }
    parts: [ LanguagePart {}, LanguagePart { count: 9 }, ]
    points: [[1,2,3],[4,5,6]]
    indices: [1, 2, 3]
    weights: [0.5, .25, 1e-3]
    words: ["a", "b"]
    modes: [hidden, visible, "hidden"]
  })",
                      "folder");
  EXPECT_TRUE(p->flag);
  EXPECT_EQ(p->count, 7);
  EXPECT_EQ(p->large, 9007199254740991u);
  EXPECT_FLOAT_EQ(p->length, 0.1f);
  EXPECT_FLOAT_EQ(p->angle, 57.29577951f);
  EXPECT_EQ(p->wavelength, 650.0f);
  EXPECT_EQ(p->precise, 0.1);
  EXPECT_EQ(p->title, "a \"b\" \\ \n\t é");
  EXPECT_EQ(p->file.resolved(), "folder/x.ply");
  EXPECT_EQ(p->mode, LanguageMode::hidden);
  EXPECT_EQ(p->uv, (Vector2{1, 2}));
  EXPECT_EQ(p->direction, (Vector3{1, -2, 3.5f}));
  EXPECT_EQ(p->from, (Point3{0.278f, 0.273f, -0.8f}));
  EXPECT_EQ(p->color->expression(), "rgb(0.5, 0.2, 0.1)");
  EXPECT_EQ(p->transform.still()(Point3{}), (Point3{1, 2, 0.03f}));
  ASSERT_TRUE(p->child);
  EXPECT_EQ(p->child->count, 8);
  ASSERT_EQ(p->parts.size(), 2u);
  EXPECT_EQ(p->parts[1]->count, 9);
  ASSERT_EQ(p->points.size(), 2u);
  EXPECT_EQ(p->points[1], (Point3{4, 5, 6}));
  EXPECT_EQ(p->indices, (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(p->weights, (std::vector<float>{0.5f, 0.25f, 1e-3f}));
  EXPECT_EQ(p->words, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(p->modes, (std::vector<LanguageMode>{LanguageMode::hidden, LanguageMode::visible, LanguageMode::hidden}));
}

TEST(Language, UnitsAreInBaseUnits) {
  const std::pair<const char*, double> known[] = {{"m", 1},
                                                  {"cm", 0.01},
                                                  {"mm", 1e-3},
                                                  {"km", 1e3},
                                                  {"um", 1e-6},
                                                  {"nm", 1e-9},
                                                  {"rad", 1},
                                                  {"K", 1},
                                                  {"W", 1},
                                                  {"mW", 1e-3},
                                                  {"kW", 1e3},
                                                  {"lm", 1},
                                                  {"cd", 1},
                                                  {"lx", 1},
                                                  {"s", 1},
                                                  {"ms", 1e-3},
                                                  {"deg", 3.14159265358979323846 / 180}};
  for (const auto& [unit, factor] : known) {
    EXPECT_DOUBLE_EQ(number(std::string("2 ") + unit), 2 * factor) << unit;
    EXPECT_DOUBLE_EQ(number(std::string("2") + unit), 2 * factor) << unit;
  }
  EXPECT_DOUBLE_EQ(number("(1 + 2) cm"), 0.03);
  const Value list = parse_value("[0, 1 m, 2 mm]");  // zero is the same in every unit
  ASSERT_TRUE(list.as<Numbers>());
  EXPECT_EQ(list.as<Numbers>()->dimension, Dimension::length);
  EXPECT_EQ(list.as<Numbers>()->values, (std::vector<double>{0, 1, 0.002}));
  EXPECT_EQ(value_errors("10 cmm"), "1:4: unknown unit 'cmm' (did you mean 'cm'?)");
  EXPECT_EQ(value_errors("(1 m) cm"), "1:7: cannot give a length a unit once more");
  EXPECT_EQ(value_errors("[1, 2 m]"), "1:5: a list cannot mix a plain number and a length: give each its unit");
  EXPECT_EQ(value_errors("[1 K, 2 m]"), "1:7: a list cannot mix a temperature and a length");
}

TEST(Language, Arithmetic) {
  EXPECT_EQ(number("1 + 2 * 3 - 4 / 2"), 5);
  EXPECT_EQ(number("-(2 - 5)"), 3);
  EXPECT_EQ(number("- - 2"), 2);
  EXPECT_EQ(number("2 * 3 m"), 6);
  EXPECT_EQ(number("6 m / 2 m"), 3);
  EXPECT_DOUBLE_EQ(number("pi / 2"), 1.5707963267948966);
  EXPECT_DOUBLE_EQ(number("sin(30 deg) + cos(0 rad) + tan(45 deg)"), 2.5);
  EXPECT_EQ(number("sqrt(16) + abs(-2) + pow(2, 3) + min(4, 1, 2) + max(3 , 5)"), 4 + 2 + 8 + 1 + 5);
  const Value v = parse_value("2 * ([1, 2, 3] + [1, 1, 1]) / 4 - [0, 0, 1]");
  ASSERT_TRUE(v.as<Numbers>());
  EXPECT_EQ(v.as<Numbers>()->values, (std::vector<double>{1, 1.5, 1}));
  const Value t = parse_value("translate(1, 0, 0) * scale(2)");
  ASSERT_TRUE(t.as<Transform>());
  EXPECT_EQ((*t.as<Transform>())(Point3{1, 1, 1}), (Point3{3, 2, 2}));
  const Value c = parse_value("2 * blackbody(2856 K) * 2");
  ASSERT_TRUE(c.as<Color>());
  EXPECT_EQ((*c.as<Color>())->expression(), "4 * blackbody(2856 K)");

  EXPECT_EQ(value_errors("1 m + 2 K"), "1:5: cannot add a length to a temperature");
  EXPECT_EQ(value_errors("1 + 2 m"), "1:3: cannot add a plain number to a length");
  EXPECT_EQ(value_errors("2 m * 3 m"), "1:5: cannot multiply a length by a length: one of them must be a plain number");
  EXPECT_EQ(value_errors("1 / 3 m"), "1:3: cannot divide a plain number by a length");
  EXPECT_EQ(value_errors("1 / 0"), "1:3: division by zero");
  EXPECT_EQ(value_errors("[1, 2] + [1, 2, 3]"), "1:8: cannot add a list of 2 numbers to a list of 3 numbers");
  EXPECT_EQ(value_errors("\"a\" + 1"), "1:5: cannot add a string to a number");
  EXPECT_EQ(value_errors("1e300 * 1e300"), "1:7: the result is too large for a number");
  EXPECT_EQ(value_errors("1e999"), "1:1: the number 1e999 is outside the range of double precision");
  EXPECT_EQ(value_errors("-true"), "1:1: cannot negate true or false");
}

TEST(Language, ColoursAndIndices) {
  for (const char* text :
       {"rgb(0.5, 0.2, 0.1)", "blackbody(2856 K)", "illuminant(\"D65\")", "glass(\"N-BK7\")", "metal(\"Au\")"}) {
    const Value v = parse_value(text);
    ASSERT_TRUE(v.as<Color>()) << text;
    EXPECT_EQ((*v.as<Color>())->expression(), text);
  }
  const auto expression = [](const char* text) { return (*parse_value(text).as<Color>())->expression(); };
  EXPECT_EQ(expression("srgb(\"#ff8000\")"), expression("srgb(255 / 255, 128 / 255, 0)"));
  EXPECT_EQ(expression("blackbody(2856)"), "blackbody(2856 K)");
  EXPECT_FLOAT_EQ((*parse_value("spectrum([400, 700], [0, 3])").as<Color>())->at(500, ColorUse::coefficient), 1);
  EXPECT_FLOAT_EQ((*parse_value("spectrum([0.4, 0.7] um, [0, 3])").as<Color>())->at(500, ColorUse::coefficient), 1);
  ASSERT_TRUE((*parse_value("complex(1.5, 2)").as<Color>())->imaginary());
  parse_value("rgb(\"rec2020\", 0.1, 0.2, 0.3)");
  parse_value("xyz(0.1, 0.2, 0.3)");

  EXPECT_EQ(value_errors("rgb(1, 2)"),
            "1:1: expects rgb(red, green, blue) or rgb(\"space\", red, green, blue); 2 arguments were given");
  EXPECT_EQ(value_errors("blackbody(\"hot\")"),
            "1:11: expects blackbody(temperature): argument 1 must be a temperature, not a string");
  EXPECT_EQ(value_errors("blackbody(10 m)"),
            "1:11: expects blackbody(temperature): argument 1 must be a temperature, not a length");
  EXPECT_EQ(value_errors("srgb(\"ff8000\")"), "1:6: expects a colour such as \"#ff8000\", not \"ff8000\"");
  EXPECT_EQ(value_errors("rbg(1, 2, 3)"), "1:1: there is no function 'rbg' (did you mean 'rgb'?)");
  EXPECT_EQ(value_errors("glass(\"N-BK8\")").substr(0, 5), "1:7: ");
  EXPECT_NE(value_errors("glass(\"N-BK8\")").find("N-BK7"), std::string::npos);
  EXPECT_NE(value_errors("spectrum(\"no such.csv\")").find("No such file"), std::string::npos);
  EXPECT_EQ(value_errors("LanguagePart(1)"), "1:1: 'LanguagePart' is a class: write LanguagePart { … }");
  EXPECT_EQ(value_errors("sin(1)"),
            "1:5: expects sin(angle): argument 1 must be an angle with its unit, deg or rad, not a number");
  EXPECT_EQ(value_errors("sqrt(-1)"), "1:6: the root of a negative number");
  EXPECT_EQ(value_errors("max(1, 2 m)"),
            "1:8: expects max(number, number, …): argument 2 must be a plain number, not a length");
}

TEST(Language, Transforms) {
  const auto moved = [](const char* text) {
    const Value v = parse_value(text);
    const Point3 p = v.as<Transform>() ? (*v.as<Transform>())(Point3{1, 2, 3}) : Point3{};
    return std::vector<float>{p.x, p.y, p.z};
  };
  const auto near = [](const std::vector<float>& a, const std::vector<float>& b) {
    for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], 1e-6f);
  };
  near(moved("translate([1, 2, 3] cm)"), {1.01f, 2.02f, 3.03f});
  near(moved("rotate(90, \"z\")"), {-2, 1, 3});
  near(moved("rotate(90 deg, [0, 0, 2])"), {-2, 1, 3});
  near(moved("rotate(pi / 2 * (1 rad), [0, 0, 1e-30])"), {-2, 1, 3});
  near(moved("scale(2)"), {2, 4, 6});
  near(moved("scale(1, 2, 3)"), {1, 4, 9});
  near(moved("scale([1, 2, 3])"), {1, 4, 9});
  near(moved("matrix(1,0,0,5, 0,1,0,6, 0,0,1,7)"), {6, 8, 10});
  near(moved("matrix([1,0,0,5, 0,1,0,6, 0,0,1,7, 0,0,0,1])"), {6, 8, 10});
  near(moved("matrix([[1,0,0,5], [0,1,0,6], [0,0,1,7]])"), {6, 8, 10});
  const Value look = parse_value("look_at([0,0,-5], [0,0,0], [0,1,0])");
  ASSERT_TRUE(look.as<Transform>());
  EXPECT_EQ((*look.as<Transform>())(Point3{0, 0, 5}), Point3{});
  const Value moving = parse_value("keyframes(0 s, translate(0,0,0), 500 ms, translate(1,0,0))");
  ASSERT_TRUE(moving.as<AnimatedTransform>());
  EXPECT_EQ(moving.as<AnimatedTransform>()->keys()[1].time, 0.5f);

  EXPECT_EQ(value_errors("scale(0)"), "1:1: gives a singular transform: it cannot be undone");
  EXPECT_EQ(value_errors("rotate(1, \"w\")"), "1:11: the axis must be \"x\", \"y\", \"z\" or a vector, not \"w\"");
  EXPECT_EQ(value_errors("rotate(1, [0, 0, 0])"), "1:11: the axis has no length");
  EXPECT_EQ(value_errors("look_at([0,0,0], [0,0,0], [0,1,0])"), "1:1: look_at: from and to are the same point");
  EXPECT_EQ(value_errors("look_at([0,0,0], [0,1,0], [0,1,0])"), "1:1: look_at: up points along the view");
  EXPECT_EQ(value_errors("matrix(1,0,0,5, 0,1,0,6, 0,0,1,7, 0,0,0,2)"), "1:35: the last row of a matrix must be 0 0 0 1");
  EXPECT_EQ(value_errors("keyframes(1 s, scale(1), 1 s, scale(1))"), "1:26: the times of keyframes must increase");
  EXPECT_EQ(value_errors("translate(1, 2)"), "1:1: expects translate(x, y, z) or translate([x, y, z]); 2 arguments were given");
  EXPECT_EQ(value_errors("translate(1, 2 K, 3)"),
            "1:14: expects translate(x, y, z) or translate([x, y, z]): argument 2 must be a length, not a temperature");
}

TEST(Language, ListsArePackedWhenTheyCanBe) {
  const auto numbers = [](const char* text) {
    const Value v = parse_value(text);
    return v.as<Numbers>() ? *v.as<Numbers>() : Numbers{{}, -1};
  };
  EXPECT_EQ(numbers("[1, 2,\n 3,]").values, (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(numbers("[[1, - 2], # comment\n [3, 4]]").width, 2);
  EXPECT_EQ(numbers("[[1, 2, 3, 4]]").width, 4);
  EXPECT_EQ(numbers("[[1, 1 + 1], [3, 4]]").values, (std::vector<double>{1, 2, 3, 4}));
  EXPECT_EQ(numbers("[[1, 2], [3, 4]] cm").dimension, Dimension::length);
  EXPECT_TRUE(parse_value("[[1, 2], [3, 4, 5]]").as<Value::List>());
  EXPECT_TRUE(parse_value("[[1], [2]]").as<Value::List>());
  EXPECT_TRUE(parse_value("[[1,2,3,4,5], [1,2,3,4,5]]").as<Value::List>());
  EXPECT_TRUE(parse_value("[1, \"a\"]").as<Value::List>());
  EXPECT_TRUE(parse_value("[]").as<Value::List>());
  EXPECT_TRUE(part("LanguagePart { points: [], parts: [] }")->points.empty());
  EXPECT_EQ(part("LanguagePart { points: [1,2,3, 4,5,6] cm }")->points[1], (Point3{0.04f, 0.05f, 0.06f}));
}

TEST(Language, NewLinesSeparateItemsOfLists) {
  EXPECT_EQ(part("LanguagePart { parts: [\n LanguagePart {}\n LanguagePart {}, LanguagePart {}\n] }")->parts.size(), 3u);
  EXPECT_EQ(part_errors("LanguagePart { parts: [LanguagePart {} LanguagePart {}] }"),
            "1:40: expected ',' or ']', not 'LanguagePart'");
  const auto list = [](const char* text) {
    const Value v = parse_value(text);
    return v.as<Numbers>() ? v.as<Numbers>()->values : std::vector<double>();
  };
  EXPECT_EQ(list("[1\n-2]"), (std::vector<double>{1, -2}));      // packed
  EXPECT_EQ(list("[1\n-2 * 1]"), (std::vector<double>{1, -2}));  // not packed
  EXPECT_EQ(list("[1 -\n2]"), (std::vector<double>{-1}));
  EXPECT_EQ(list("[(1\n-2)]"), (std::vector<double>{-1}));
  EXPECT_EQ(list("[[1, 2]\n [3\n 4]]"), (std::vector<double>{1, 2, 3, 4}));
  EXPECT_EQ(value_errors("[1 2]"), "1:4: expected ',' or ']', not '2'");
  EXPECT_EQ(value_errors("max(1\n2)"), "2:1: expected ',' or ')', not '2'");
}

TEST(Language, LiteralsStandForComponents) {
  const auto p = part("LanguagePart { child: 0.5, parts: [1, 2, LanguageConstant { value: 3 }, none] }");
  ASSERT_TRUE(ref_cast<LanguageConstant>(p->child));
  EXPECT_EQ(ref_cast<LanguageConstant>(p->child)->value, 0.5f);
  ASSERT_EQ(p->parts.size(), 4u);
  EXPECT_EQ(ref_cast<LanguageConstant>(p->parts[1])->value, 2);
  EXPECT_FALSE(p->parts[3]);
}

// ---- names ----------------------------------------------------------------------------------------------------------

TEST(Language, NamesAreSharedInAnyOrder) {
  const auto p = part("LanguagePart { child: b, parts: [a, b] }\n b = a; a = LanguagePart { length: size }\n size = 2 * 1 m");
  EXPECT_EQ(p->child, p->parts[0]);
  EXPECT_EQ(p->child, p->parts[1]);
  EXPECT_EQ(p->child->length, 2);
  ASSERT_TRUE(p->child->origin);
  EXPECT_EQ(p->child->origin->name, "a");
  EXPECT_EQ(p->child->origin->location, (Location{intern("text"), 2, 13}));
  EXPECT_EQ(p->child->location_of("length"), (Location{intern("text"), 2, 36}));
}

TEST(Language, ChoicesComeBeforeNames) {
  EXPECT_EQ(part("visible = 3\nLanguagePart { mode: visible, count: visible }")->mode, LanguageMode::visible);
  EXPECT_EQ(part("m = \"hidden\"\nLanguagePart { mode: m }")->mode, LanguageMode::hidden);
  EXPECT_EQ(part_errors("LanguagePart { mode: visble }"),
            "1:22: LanguagePart.mode has no choice 'visble' (did you mean 'visible'?); known are visible, hidden");
  EXPECT_EQ(part_errors("LanguagePart { modes: [visible, hiden] }"),
            "1:33: LanguagePart.modes has no choice 'hiden' (did you mean 'hidden'?); known are visible, hidden");
}

TEST(Language, NameErrors) {
  EXPECT_EQ(part_errors("white = 1\nLanguagePart { count: whit + white }"),
            "2:23: 'whit' is not defined (did you mean 'white'?)");
  EXPECT_EQ(part_errors("a = 1\n  a = 2\nLanguagePart { count: a }"), "2:3: 'a' is already defined at line 1:1");
  EXPECT_EQ(part_errors("a = b\nb = c\nc = a\nLanguagePart { count: b }"), "1:5: 'b' is defined by itself: b → c → a → b");
  EXPECT_EQ(part_errors("a = LanguagePart { child: a }\nLanguagePart { child: a }"), "1:27: 'a' is defined by itself: a → a");
  EXPECT_EQ(part_errors("a = 1 m + 1\nLanguagePart { count: a, length: a }"), "1:9: cannot add a length to a plain number");
  EXPECT_EQ(part_errors("pi = 3\nLanguagePart {}"), "1:1: 'pi' has a fixed meaning and cannot be defined");
  EXPECT_EQ(part_errors("LanguagePart { child: LanguageConstant }"),
            "1:23: 'LanguageConstant' is a class: write LanguageConstant {}");
  EXPECT_EQ(part_errors("LanguagePart { color: rgb }"), "1:23: 'rgb' is a function: write rgb(…)");
}

TEST(Language, UnusedNamesAreCheckedAndWarnedOf) {
  EXPECT_EQ(part_errors("a = nothing\nLanguagePart {}"), "1:5: 'nothing' is not defined");
  testing::internal::CaptureStderr();
  part("lonely_name_1 = 1\nused = 2\nLanguagePart { count: used }");
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find("text:1:1: warning: 'lonely_name_1' is defined but not used"), std::string::npos) << said;
  EXPECT_EQ(said.find("'used'"), std::string::npos);
}

TEST(Language, ParamsAreReplaced) {
  const std::string text = "param seed = 1\nparam name = \"a\"\nparam mode = 2 + seed\n" + job_with("seed: seed + mode");
  const auto seed = [&](const LoadOptions& options) { return load_job_text(text, "params", {}, options)->seed; };
  EXPECT_EQ(seed({}), 4u);
  EXPECT_EQ(seed({{{"seed", "10"}}}), 22u);
  EXPECT_EQ(seed({{{"mode", "2 * 3"}, {"name", "bare words, even \"these\""}}}), 7u);
  const auto errors = [&](const LoadOptions& options) { return job_errors(text, options); };
  EXPECT_EQ(errors({{{"sed", "1"}}}), "there is no param 'sed' (did you mean 'seed'?)");
  EXPECT_EQ(errors({{{"seed", "1"}, {"seed", "2"}}}), "'seed' is given a value twice");
  EXPECT_EQ(errors({{{"seed", "1 +"}}}), "1:4: expected a value, not the end of the text");
  EXPECT_EQ(job_errors("s = 1\n" + job_with("seed: s"), {{{"s", "2"}}}), "'s' is not a param: only those can be replaced");
  try {
    load_job_text(text, "params", {}, {{{"seed", "what"}}});
    ADD_FAILURE();
  } catch (const Errors& e) {
    EXPECT_EQ(show(e.errors.front()), "-D seed:1:1: 'what' is not defined\n    1 | what\n      | ^");
  }
}

// ---- components -----------------------------------------------------------------------------------------------------

TEST(Language, ComponentErrors) {
  EXPECT_EQ(part_errors("LanguagePart { cout: 4 }"), "1:16: LanguagePart has no member 'cout' (did you mean 'count'?)");
  EXPECT_EQ(part_errors("LanguagPart { count: 4 }"), "1:1: there is no class 'LanguagPart' (did you mean 'LanguagePart'?)");
  EXPECT_EQ(part_errors("LanguagePart { count: 4, flag: true\n count: 5 }"), "2:2: 'count' is already set at line 1:16");
  EXPECT_EQ(part_errors("LanguageNeedy {}"), "1:1: LanguageNeedy needs 'source'");
  EXPECT_EQ(part("LanguagePart { child: LanguageNeedy { source: \"x\" } }")->child->class_info().name, "LanguageNeedy");
  EXPECT_EQ(part_errors("LanguagePart { count: 4000 }"), "1:23: LanguagePart.count must be from 0 to 1000, not 4000");
  EXPECT_EQ(part_errors("LanguagePart { count: 1.5 }"), "1:23: LanguagePart.count expects a whole number, not 1.5");
  EXPECT_EQ(part_errors("LanguagePart { length: 3 K }"), "1:24: LanguagePart.length expects a length [m], not a temperature");
  EXPECT_EQ(part_errors("x = \"s\"\nLanguagePart { length: x }"), "2:24: LanguagePart.length expects a number, not a string");
  EXPECT_EQ(part_errors("LanguagePart { child: \"s\" }").substr(0, 6), "1:23: ");
}

TEST(Language, FindsManyErrorsInOneRun) {
  EXPECT_EQ(part_errors("a = LanguagePart { cout: 1, count: wrong, length: 1 K }\n"
                        "b = = 2\n"
                        "LanguagePart { child: a, count: b, parts: [ LanguagePart { flag: 1 }, LanguagePat { x: y } ],\n"
                        "  mode 3, title: \"open\n"
                        "  uv: [1, 2 }\n"),
            "1:20: LanguagePart has no member 'cout' (did you mean 'count'?)\n"
            "1:36: 'wrong' is not defined\n"
            "1:51: LanguagePart.length expects a length [m], not a temperature\n"
            "2:5: expected a value, not '='\n"
            "3:66: LanguagePart.flag expects true or false, not a number\n"
            "3:71: there is no class 'LanguagePat' (did you mean 'LanguagePart'?)\n"
            "4:8: expected ':' after the member name 'mode', not '3'\n"
            "4:18: the string is not closed in its line: a '\"' is missing\n"
            "5:13: expected ',' or ']', not '}'");
  std::string many = "LanguagePart {\n";
  for (int i = 0; i < 100; ++i) many += "  wrong" + std::to_string(i) + ": 1\n";
  try {
    parse_component(many + "}");
    ADD_FAILURE();
  } catch (const Errors& e) {
    EXPECT_EQ(e.errors.size(), 50u);
  }
}

TEST(Language, SyntaxErrors) {
  EXPECT_EQ(part_errors("LanguagePart { count: 1 length: 2 }"), "1:25: expected ',' or a new line before 'length'");
  EXPECT_EQ(part_errors("LanguagePart { flag: true count: 2 }"),
            "1:27: expected ',' or a new line before the next member, not 'count'");
  EXPECT_EQ(part_errors("LanguagePart { count: }"), "1:23: expected a value, not '}'");
  EXPECT_EQ(part_errors("LanguagePart {\n count: 1"), "1:14: '{' is never closed");
  EXPECT_EQ(part_errors("LanguagePart {\n indices: [1, 2"), "2:11: '[' is never closed");
  EXPECT_EQ(part_errors("LanguagePart {} }"), "1:17: expected a new line or ';' after the statement, not '}'");
  EXPECT_EQ(part_errors("LanguagePart { count: 1 @ }"), "1:25: unexpected character '@'");
  EXPECT_EQ(part_errors("LanguagePart { title: \"ä\\q\" }"), "1:25: unknown escape in a string; there are \\\" \\\\ \\n \\t");
  EXPECT_EQ(part_errors("pram x = 1\nLanguagePart { count: x }"),
            "1:1: unknown statement 'pram' (did you mean 'param'?)\n2:23: 'x' is not defined");
  EXPECT_EQ(part_errors("white LanguagePart {}\nLanguagePart { child: white }"),
            "1:7: expected '=' or '{' after 'white', not 'LanguagePart'");
  EXPECT_EQ(part_errors("3\nLanguagePart {}"),
            "1:1: expected a statement (name = value, param, include, plugin or a component), not '3'");
  EXPECT_EQ(part_errors("include 3\nLanguagePart {}"), "1:9: expected the file to include, in quotes, not '3'");
  EXPECT_EQ(value_errors("1 2"), "1:3: expected the end of the expression, not '2'");
  EXPECT_EQ(value_errors(""), "1:1: expected a value, not the end of the text");
  EXPECT_EQ(value_errors("(1"), "1:1: '(' is never closed");
  EXPECT_EQ(value_errors("(1, 2)"), "1:3: expected ')', not ','");
}

TEST(Language, JobErrors) {
  EXPECT_EQ(job_errors(""), "there is no Job: a render description needs one Job { … }");
  EXPECT_EQ(job_errors("# nothing\n"), "there is no Job: a render description needs one Job { … }");
  const std::string job = job_with("seed: 1");
  EXPECT_EQ(job_errors(job + "\n" + job), "2:1: there is a Job already, at line 1:1");
  EXPECT_EQ(job_errors("LanguagePart {}\n" + job),
            "1:1: only the Job stands for itself; give this a name to use it by: name = LanguagePart { … }");
  EXPECT_EQ(job_errors("Jbo {}"),
            "1:1: only the Job stands for itself (did you mean 'Job'?); give this a name to use it by: name = Jbo { … }\n"
            "1:1: there is no class 'Jbo' (did you mean 'Job'?)");
  EXPECT_EQ(load_job_text(job_with("seed: 12"), "text")->seed, 12u);
}

TEST(Language, TextIsUtf8) {
  EXPECT_EQ(part("\xEF\xBB\xBFLanguagePart { title: \"日本\" }")->title, "日本");
  EXPECT_EQ(part_errors("\xEF\xBB\xBFx"), "1:2: expected '=' or '{' after 'x', not the end of the text");
  EXPECT_EQ(part_errors("LanguagePart { title: \"日本\", cout: 1 }"),
            "1:29: LanguagePart has no member 'cout' (did you mean 'count'?)");
  EXPECT_EQ(part_errors("\nä\xFF"), "2:2: the text is not valid UTF-8: byte 0xFF");
  for (const char* wrong : {"\x80", "\xC0\xAF", "\xE0\x80\xAF", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xE2\x82"})
    EXPECT_NE(part_errors(std::string("# ") + wrong).find("not valid UTF-8"), std::string::npos);
  EXPECT_EQ(part_errors("LanguagePart { ä: 1 }"), "1:16: unexpected character 'ä'");
  EXPECT_EQ(part("LanguagePart {\r\n  count: 4\r\n  length: 2\r\n}\r\n")->length, 2);
}

TEST(Language, DepthIsBounded) {
  for (const std::string open : {"[", "(", "-", "sqrt(", "LanguagePart{child:", "translate(["}) {
    std::string deep;
    for (int i = 0; i < 100000; ++i) deep += open;
    EXPECT_NE(value_errors(deep).find("too deeply nested: more than 256 levels"), std::string::npos) << open;
  }
  std::string sum = "1", chain = "n0 = LanguagePart {}\n", forward = "n0 = LanguagePart {}\n";
  for (int i = 1; i < 100000; ++i) sum += "+1";
  EXPECT_EQ(number(sum), 100000);
  for (int i = 1; i < 20000; ++i) {
    const std::string line = "n" + std::to_string(i) + " = LanguagePart { child: n" + std::to_string(i - 1) + " }\n";
    chain += line;
    forward.insert(0, line);
  }
  for (const auto& text : {chain, forward})
    EXPECT_NE(part_errors(text + "LanguagePart { child: n19999 }").find("nested too deeply"), std::string::npos);
}

// ---- files ----------------------------------------------------------------------------------------------------------

TEST(Language, IncludesShareOneNamespace) {
  const Folder folder;
  folder.write("sub/common.etd", "include \"../other.etd\"\nred = LanguagePart { file: \"red.ply\", count: n }\n");
  folder.write("other.etd", "n = 5\n");
  const std::string text = "include \"sub/common.etd\"\ninclude \"other.etd\"\nLanguagePart { child: red, file: \"me.ply\" }";
  const auto p = part(text, folder.path());
  EXPECT_EQ(p->child->count, 5);
  EXPECT_EQ(p->file.resolved(), folder.path() + "/me.ply");
  EXPECT_EQ(std::filesystem::path(p->child->file.resolved()).lexically_normal(),
            std::filesystem::path(folder.path()) / "sub/red.ply");

  folder.write("a.etd", "include \"b.etd\"\n" + job_with("seed: 1"));
  folder.write("b.etd", "\n  include \"a.etd\"\n");
  try {
    load_job(folder.path() + "/a.etd");
    ADD_FAILURE();
  } catch (const Errors& e) {
    const std::string a = folder.path() + "/a.etd", b = folder.path() + "/b.etd";
    ASSERT_EQ(e.errors.size(), 1u);
    EXPECT_STREQ(e.what(), ("the file includes itself: " + a + " → " + b + " → " + a).c_str());
    EXPECT_EQ(e.errors[0].location, (Location{intern(b), 2, 11}));
    EXPECT_EQ(show(e.errors[0]), b + ":2:11: " + e.what() + "\n    2 |   include \"a.etd\"\n      |           ^");
  }
}

TEST(Language, FileErrors) {
  const Folder folder;
  EXPECT_EQ(errors_of([&] { load_job(folder.path() + "/none.etd"); }),
            "cannot read '" + folder.path() + "/none.etd': No such file or directory");
  EXPECT_EQ(errors_of([&] { load_job(folder.path()); }), "cannot read '" + folder.path() + "': Is a directory");
  EXPECT_EQ(errors_of([&] { parse_component("include \"none.etd\"\nLanguagePart { count: unknown }", "text", folder.path()); }),
            "1:9: cannot read '" + folder.path() + "/none.etd': No such file or directory");
  EXPECT_NE(job_errors("plugin \"./none.so\"\n" + job_with("seed: 1")).find("1:8: "), std::string::npos);
  LoadOptions closed;
  closed.allow_files = false;
  EXPECT_EQ(job_errors("include \"a\"\nplugin \"b\"\nc = spectrum(\"d\")\n" + job_with("seed: 1"), closed),
            "1:9: files are not allowed here\n2:8: plugins are not allowed here\n3:14: files are not allowed here");
  EXPECT_EQ(load_job(folder.write("good.etd", job_with("seed: 9")))->seed, 9u);
}

// ---- messages -------------------------------------------------------------------------------------------------------

TEST(Language, ShowsTheLineWithACaret) {
  const auto shown = [](const std::string& text) {
    try {
      parse_component(text, "shown.etd");
    } catch (const Errors& e) {
      return show(e.errors.front());
    }
    return std::string();
  };
  EXPECT_EQ(shown("\n\tLanguagePart { cout: 4 }\r\n"),
            "shown.etd:2:17: LanguagePart has no member 'cout' (did you mean 'count'?)\n    2 |  LanguagePart { cout: 4 }\n    "
            "  |                 ^");
  const std::string long_line =
      shown("LanguagePart { title: \"" + std::string(500, 'x') + "é\", cout: 4, title: \"" + std::string(500, 'y') + "\" }");
  const size_t line = long_line.find("\n    1 | …");
  ASSERT_NE(line, std::string::npos) << long_line;
  EXPECT_LT(long_line.size(), 500u);
  // The caret stands under the first letter of the name.
  const std::string second = long_line.substr(line + 1, long_line.find('\n', line + 1) - line - 1);
  const std::string third = long_line.substr(long_line.rfind('\n') + 1);
  const size_t bytes_more = 2 + 1;  // of "…" and "é"
  EXPECT_EQ(second.find("cout"), third.find('^') + bytes_more) << long_line;
  EXPECT_EQ(show(Error("no place")), "no place");
  EXPECT_EQ(show(Error("no line", {intern("f.etd"), 0, 0})), "f.etd: no line");
  EXPECT_EQ(show(Error("no such line", {intern("shown.etd"), 99, 1})), "shown.etd:99:1: no such line");
}

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
  EXPECT_EQ(wrong("parts[x].count", "1"), "1:6: expected a place in the list such as [0]");
  EXPECT_EQ(wrong("child..count", "1"), "1:7: expected the name of a member, not ''");
  EXPECT_EQ(wrong("count", "4000"), "1:7: LanguagePart.count must be from 0 to 1000, not 4000");
  EXPECT_EQ(wrong("count", "1 +"), "1:10: expected a value, not the end of the text");
  EXPECT_EQ(wrong("mode", "visble"),
            "1:6: LanguagePart.mode has no choice 'visble' (did you mean 'visible'?); known are visible, hidden");
  EXPECT_EQ(p->count, 8);  // nothing half-set
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
  // Names that two components have, or that cannot be read, are replaced.
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

// ---- speed ----------------------------------------------------------------------------------------------------------

TEST(Language, LoadsLargeListsFast) {
  std::string text = "LanguagePart {\n points: [\n";
  const size_t rows = 500000;
  for (size_t i = 0; i < rows; ++i) {
    const std::string a = std::to_string(double(i) * 0.001), b = std::to_string(-double(i) * 0.37);
    text += "[" + a + ", " + b + ", 1.25],\n";
  }
  text += "]\n indices: [";
  for (size_t i = 0; i < rows; ++i) text += std::to_string(i) + "," + std::to_string(i + 1) + ",";
  text += "] }";
  ASSERT_GT(text.size(), 19000000u);
  const auto begin = std::chrono::steady_clock::now();
  const auto p = part(text);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  EXPECT_EQ(p->points.size(), rows);
  EXPECT_EQ(p->indices.size(), 2 * rows);
  EXPECT_EQ(p->points[1000].x, 1.0f);
  EXPECT_LT(seconds, 10) << "for " << text.size() << " bytes";
  RecordProperty("seconds", std::to_string(seconds));
  // One wrong entry at the end is found at its place.
  text.replace(text.size() - 3, 3, "x] }");
  EXPECT_NE(part_errors(text).find("'x' is not defined"), std::string::npos);
}

}  // namespace
}  // namespace etendue
