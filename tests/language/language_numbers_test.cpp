// Numbers of the language to the last digits: each unit in each kind of member, arithmetic on numbers and lists, functions,
// colours, and points under transforms against matrices written by hand.

#include <gtest/gtest.h>

#include "etendue/describe/color.h"
#include "etendue/describe/registry.h"
#include "etendue/object_map.h"
#include "support/language_test_support.h"

namespace etendue {
namespace {

using language_test::number;
using language_test::part;

std::vector<double> list(const std::string& text) {
  const Value v = parse_value(text);
  const auto* n = v.as<Numbers>();
  return n ? n->values : std::vector<double>{};
}
void expect_list(const std::string& text, const std::vector<double>& expected) {
  const std::vector<double> got = list(text);
  ASSERT_EQ(got.size(), expected.size()) << text;
  for (size_t i = 0; i < got.size(); ++i) EXPECT_NEAR(got[i], expected[i], 1e-13 * std::abs(expected[i])) << text << " " << i;
}
/// A member of a component, in the member's own unit.
double member(const std::string& text, const std::string& name) {
  const Ref<Component> c = parse_component(text, "text");
  const Value v = get(*c, name);
  const auto* n = v.as<Number>();
  if (!n) {
    ADD_FAILURE() << text << ": " << v.kind();
    return 0;
  }
  const Member& m = *c->class_info().find(name);
  const Unit* unit = find_unit(m.unit);
  return unit ? n->value / unit->factor : n->value;
}

TEST(LanguageNumbers, UnitsHaveTheirFactors) {
  // In base units: metre, radian, kelvin, watt, lumen, candela, lux, second.
  const struct {
    const char* text;
    double value;
  } rows[] = {{"3 m", 3},     {"3 cm", 0.03},    {"3 mm", 0.003},      {"3 km", 3000}, {"3 um", 3e-6}, {"3 nm", 3e-9},
              {"3 rad", 3},   {"180 deg", M_PI}, {"3 deg", M_PI / 60}, {"3 K", 3},     {"3 W", 3},     {"3 mW", 0.003},
              {"3 kW", 3000}, {"3 lm", 3},       {"3 cd", 3},          {"3 lx", 3},    {"3 s", 3},     {"3 ms", 0.003}};
  for (const auto& r : rows) EXPECT_NEAR(number(r.text), r.value, 1e-15 * r.value) << r.text;
  EXPECT_EQ(units().size(), 17u);
  // In members' units, as floats.
  EXPECT_FLOAT_EQ(part("LanguagePart { length: 25 mm }")->length, 0.025f);
  EXPECT_FLOAT_EQ(part("LanguagePart { length: 25 um }")->length, 25e-6f);
  EXPECT_FLOAT_EQ(part("LanguagePart { length: 25 nm }")->length, 25e-9f);
  EXPECT_FLOAT_EQ(part("LanguagePart { length: 0.25 km }")->length, 250);
  EXPECT_FLOAT_EQ(part("LanguagePart { wavelength: 0.53 um }")->wavelength, 530);
  EXPECT_FLOAT_EQ(part("LanguagePart { wavelength: 5.3e-7 m }")->wavelength, 530);
  EXPECT_FLOAT_EQ(part("LanguagePart { angle: 0.5 rad }")->angle, 28.64788976f);
  EXPECT_FLOAT_EQ(part("LanguagePart { angle: 30 deg }")->angle, 30);
  const Ref<LanguagePart> p = part("LanguagePart { from: [10, 20, 30] cm, points: [[1, 2, 3], [4, 5, 6]] mm }");
  EXPECT_EQ(p->from, (Point3{0.1f, 0.2f, 0.3f}));
  EXPECT_FLOAT_EQ(p->points[1].z, 0.006f);
  EXPECT_NEAR(member("DiffuseEmission { power: 1.5 kW }", "power"), 1500, 1e-9);
  EXPECT_NEAR(member("DiffuseEmission { power: 20 mW }", "power"), 0.02, 1e-12);
  EXPECT_NEAR(member("DiffuseEmission { luminous_flux: 800 lm }", "luminous_flux"), 800, 1e-9);
  EXPECT_NEAR(member("DiffuseEmission { luminous_intensity: 70 cd }", "luminous_intensity"), 70, 1e-9);
  EXPECT_NEAR(member("DiffuseEmission { illuminance: 500 lx }", "illuminance"), 500, 1e-9);
  EXPECT_NEAR(member("PerspectiveCamera { shutter_close: 20 ms }", "shutter_close"), 0.02, 1e-8);
  // A map of thicknesses in nanometres, given as a length.
  for (const char* text : {"ThinFilm { thickness: 0.4 um }", "ThinFilm { thickness: 400 nm }", "ThinFilm { thickness: 400 }"}) {
    const Ref<Component> film = parse_component(text, "text");
    const Value v = get(*film, "thickness");
    const auto map = ref_cast<ObjectMap>(*v.as<Ref<Component>>());
    prepare_tree(*map);
    EXPECT_NEAR(map->scalar(SurfacePoint()), 400, 1e-4f) << text;
  }
}

TEST(LanguageNumbers, Arithmetic) {
  EXPECT_EQ(number("1 + 2 * 3 - 4 / 8"), 6.5);
  EXPECT_EQ(number("-(2 - 5) * -2"), -6);
  EXPECT_EQ(number("2 - 3 - 4"), -5);
  EXPECT_EQ(number("64 / 4 / 2"), 8);
  EXPECT_NEAR(number("2 m + 30 cm - 5 mm"), 2.295, 1e-15);
  EXPECT_NEAR(number("3 m / 2 cm"), 150, 1e-12);
  EXPECT_NEAR(number("1e-3 * 4 km"), 4, 1e-15);
  EXPECT_NEAR(number(".5e2 + 1.25E-1"), 50.125, 1e-15);
  expect_list("[1, 2, 3, 4, 5] + [10, 20, 30, 40, 50]", {11, 22, 33, 44, 55});
  expect_list("[1, 2, 3, 4, 5] - [10, 20, 30, 40, 51]", {-9, -18, -27, -36, -46});
  expect_list("[1, 2, 3, 4] * 2.5", {2.5, 5, 7.5, 10});
  expect_list("2.5 * [1, 2, 3, 4]", {2.5, 5, 7.5, 10});
  expect_list("[1, 2, 3, 4] / 8", {0.125, 0.25, 0.375, 0.5});
  expect_list("-[1, -2, 3]", {-1, 2, -3});
  expect_list("[1, 2, 3] cm", {0.01, 0.02, 0.03});
  expect_list("[1 cm, 2 mm, 0]", {0.01, 0.002, 0});
  expect_list("[1, 2, 3] * 2 mm", {0.002, 0.004, 0.006});
}

TEST(LanguageNumbers, Functions) {
  EXPECT_NEAR(number("sqrt(2)"), M_SQRT2, 1e-15);
  EXPECT_NEAR(number("sin(30 deg)"), 0.5, 1e-15);
  EXPECT_NEAR(number("cos(1 rad)"), 0.540302305868139717, 1e-15);
  EXPECT_NEAR(number("tan(60 deg)"), 1.732050807568877294, 1e-14);
  EXPECT_EQ(number("min(3, -1, 2)"), -1);
  EXPECT_EQ(number("max(3, -1, 5, 2)"), 5);
  EXPECT_NEAR(number("max(3 cm, 20 mm)"), 0.03, 1e-15);
  EXPECT_NEAR(number("abs(-3 cm)"), 0.03, 1e-15);
  EXPECT_NEAR(number("pow(2, 0.5)"), M_SQRT2, 1e-15);
  EXPECT_NEAR(number("pow(10, -3)"), 1e-3, 1e-18);
}

double value_at(const std::string& text, float wavelength, ColorUse use) {
  const Value v = parse_value(text);
  const auto* c = v.as<Color>();
  if (!c || !*c) {
    ADD_FAILURE() << text;
    return 0;
  }
  return double((*c)->at(wavelength, use));
}

TEST(LanguageNumbers, Colours) {
  const auto xyz = [](const std::string& text, ColorUse use) {
    const Value v = parse_value(text);
    const Color white = illuminant_spectrum("D65");
    return to_xyz(**v.as<Color>(), use, use == ColorUse::reflectance ? white.get() : nullptr);
  };
  // Each byte of a hexadecimal colour is a component, encoded.
  const auto linear = [](double byte) { return decode_transfer("srgb", byte / 255); };
  const auto& m = rgb_space("srgb").to_xyz;
  for (const auto& [text, r, g, b] : {std::tuple{"srgb(\"#4080c1\")", 0x40, 0x80, 0xc1},
                                      {"srgb(\"#A17f33\")", 0xa1, 0x7f, 0x33},
                                      {"srgb(\"#30FF05\")", 0x30, 0xff, 0x05}}) {
    const Xyz c = xyz(text, ColorUse::radiance);
    EXPECT_NEAR(c.x, m[0] * linear(r) + m[1] * linear(g) + m[2] * linear(b), 6e-4) << text;
    EXPECT_NEAR(c.y, m[3] * linear(r) + m[4] * linear(g) + m[5] * linear(b), 6e-4) << text;
    EXPECT_NEAR(c.z, m[6] * linear(r) + m[7] * linear(g) + m[8] * linear(b), 6e-4) << text;
  }
  // The colour is written back with all digits.
  EXPECT_EQ((*parse_value("srgb(\"#337f0a\")").as<Color>())->expression(),
            (*parse_value("srgb(51 / 255, 127 / 255, 10 / 255)").as<Color>())->expression());
  const Xyz c = xyz("xyz(0.3, 0.4, 0.2)", ColorUse::radiance);
  EXPECT_NEAR(c.x, 0.3, 5e-4);
  EXPECT_NEAR(c.y, 0.4, 5e-4);
  EXPECT_NEAR(c.z, 0.2, 5e-4);
  // Wavelengths without a unit are in nanometres.
  for (const char* text : {"spectrum([400, 500, 700], [1, 3, 2])", "spectrum([400, 500, 700] nm, [1, 3, 2])",
                           "spectrum([0.4, 0.5, 0.7] um, [1, 3, 2])"}) {
    EXPECT_NEAR(value_at(text, 450, ColorUse::radiance), 2, 1e-4) << text;
    EXPECT_NEAR(value_at(text, 600, ColorUse::radiance), 2.5, 1e-4) << text;
  }
  EXPECT_NEAR(value_at("2.5 * spectrum([400, 500], [1, 3])", 450, ColorUse::radiance), 5, 1e-5);
  EXPECT_NEAR(value_at("spectrum([400, 500], [1, 3]) / 4", 450, ColorUse::radiance), 0.5, 1e-6);
  EXPECT_NEAR(value_at("blackbody(3000 K)", 600, ColorUse::radiance),
              double(blackbody_spectrum(3000)->at(600, ColorUse::radiance)), 1e-3);
  const Color index = *parse_value("complex(0.2, spectrum([400, 600], [2, 4]))").as<Color>();
  EXPECT_NEAR(index->at(500, ColorUse::coefficient), 0.2f, 1e-7f);
  EXPECT_NEAR(index->imaginary()->at(500, ColorUse::coefficient), 3, 1e-6f);
  const Color twice = *parse_value("2 * complex(0.2, 3)").as<Color>();
  EXPECT_NEAR(twice->at(500, ColorUse::coefficient), 0.4f, 1e-7f);
  EXPECT_NEAR(twice->imaginary()->at(500, ColorUse::coefficient), 6, 1e-6f);
}

// ---- transforms
// -------------------------------------------------------------------------------------------------------------------

void expect_point(const std::string& transform, const Point3& from, const std::array<double, 3>& to, float time = 0) {
  const Point3 p = part("LanguagePart { transform: " + transform + " }")->transform.at(time)(from);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(double(p[i]), to[size_t(i)], 3e-6) << transform << " " << i;
}

TEST(LanguageNumbers, Transforms) {
  const Point3 p{1, 2, 3};
  expect_point("translate(1 cm, 2 m, -3)", p, {1.01, 4, 0});
  expect_point("translate([1, 2, -3] mm)", p, {1.001, 2.002, 2.997});
  expect_point("scale(2)", p, {2, 4, 6});
  expect_point("scale(2, 3, -4)", p, {2, 6, -12});
  expect_point("rotate(90 deg, \"x\")", p, {1, -3, 2});
  expect_point("rotate(90, \"y\")", p, {3, 2, -1});
  expect_point("rotate(0.5 rad, \"z\")", p, {std::cos(0.5) - 2 * std::sin(0.5), std::sin(0.5) + 2 * std::cos(0.5), 3});
  expect_point("rotate(33, \"z\")", p,
               {std::cos(33 * M_PI / 180) - 2 * std::sin(33 * M_PI / 180),
                std::sin(33 * M_PI / 180) + 2 * std::cos(33 * M_PI / 180), 3});
  // A rotation by a third of a turn about the diagonal permutes the axes.
  expect_point("rotate(120 deg, [1, 1, 1])", p, {3, 1, 2});
  expect_point("rotate(-120, [2, 2, 2])", p, {2, 3, 1});
  // About a slanted axis, by quaternions: v' = v + 2 w (u x v) + 2 u x (u x v), u = n sin(a / 2), w = cos(a / 2).
  for (const double angle : {25.0, 140.0, -70.0}) {
    const std::array<double, 3> axis{1, -2, 0.5}, v{1, 2, 3};
    const double norm = std::sqrt(1 + 4 + 0.25), half = angle * M_PI / 360, w = std::cos(half);
    std::array<double, 3> u{};
    for (size_t i = 0; i < 3; ++i) u[i] = axis[i] / norm * std::sin(half);
    const auto cross = [](const std::array<double, 3>& a, const std::array<double, 3>& b) {
      return std::array<double, 3>{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    };
    const auto t = cross(u, v), tt = cross(u, t);
    expect_point("rotate(" + std::to_string(angle) + ", [1, -2, 0.5])", p,
                 {v[0] + 2 * (w * t[0] + tt[0]), v[1] + 2 * (w * t[1] + tt[1]), v[2] + 2 * (w * t[2] + tt[2])});
  }
  expect_point("translate(1, 0, 0) * scale(2)", p, {3, 4, 6});
  expect_point("scale(2) * translate(1, 0, 0)", p, {4, 4, 6});
  expect_point("matrix(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, -11, 12)", p, {18, 46, 8});
  expect_point("matrix([1, 2, 3, 4, 5, 6, 7, 8, 9, 10, -11, 12, 0, 0, 0, 1])", p, {18, 46, 8});
  // z points from `from` to `to`, y is up, and x = up x forward.
  expect_point("look_at([1, 0, 0], [1, 0, 5], [0, 1, 0])", p, {2, 2, 3});
  expect_point("look_at([0, 0, 2], [3, 0, 2], [0, 0, 1])", p, {3, 1, 4});
}

TEST(LanguageNumbers, KeyframesTurnAtAnEvenRateAndStretchLinearly) {
  const std::string turn = "keyframes(0 s, rotate(0, \"z\"), 2 s, rotate(100, \"z\"))";
  for (const double time : {0.0, 0.5, 1.0, 1.7, 2.0}) {
    const double a = 50 * time * M_PI / 180;
    expect_point(turn, {1, 2, 3}, {std::cos(a) - 2 * std::sin(a), std::sin(a) + 2 * std::cos(a), 3}, float(time));
  }
  const std::string grow = "keyframes(0, scale(1), 500 ms, translate(2, 0, 0) * scale(3, 1, 2), 1, scale(1))";
  expect_point(grow, {1, 2, 3}, {1 + 0.4 * 2 + 0.4 * 2, 2, 3 * 1.4}, 0.2f);
  expect_point(grow, {1, 2, 3}, {5, 2, 6}, 0.5f);
  expect_point(grow, {1, 2, 3}, {1 + 0.5 * 2 + 0.5 * 2, 2, 3 * 1.5}, 0.75f);
  expect_point(grow, {1, 2, 3}, {1, 2, 3}, 7);
}

}  // namespace
}  // namespace etendue
