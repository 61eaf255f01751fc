// Values of the render description language, tested on small components made for this purpose.

#include <gtest/gtest.h>

#include <chrono>

#include "etendue/describe/color.h"
#include "etendue/object_map.h"
#include "support/language_test_support.h"

namespace etendue::language_test {
namespace {

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
  EXPECT_EQ(value_errors("(1 m) cm"), "1:7: cannot give a length a second unit");
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

  EXPECT_EQ(value_errors("scale(0)"), "1:1: gives a singular transform: it has no inverse");
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
  EXPECT_EQ(list("[1\n-2]"), (std::vector<double>{1, -2}));      // stored as a packed list
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

// ---- speed ----------------------------------------------------------------------------------------------------------

TEST(Language, NumbersWithUnitsStandForMapsOfTheMembersUnit) {
  const auto thickness = [](const std::string& text) {
    const Ref<Component> film = parse_component("ThinFilm { thickness: " + text + " }");
    prepare_tree(*film);
    const Value map = get(*film, "thickness");
    return ref_cast<ObjectMap>(*map.as<Ref<Component>>())->scalar({});
  };
  EXPECT_EQ(thickness("400"), 400);  // in nm, the member's unit
  EXPECT_NEAR(thickness("400 nm"), 400, 1e-3);
  EXPECT_NEAR(thickness("0.4 um"), 400, 1e-3);
  EXPECT_THROW(thickness("3 deg"), Errors);
  EXPECT_THROW(parse_component("Lambertian { color: 3 m }"), Errors);
}

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
  // One wrong entry at the end is reported at its location.
  text.replace(text.size() - 3, 3, "x] }");
  EXPECT_NE(part_errors(text).find("'x' is not defined"), std::string::npos);
}

}  // namespace
}  // namespace etendue::language_test
