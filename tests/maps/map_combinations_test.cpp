// Maps made of other maps: arithmetic, formulas, and mappings of the point at which a map is evaluated.

#include "components/maps/footprint.h"
#include "components/maps/mapping/mapping.h"
#include "components/maps/procedural/formula.h"
#include "etendue/describe/color.h"
#include "etendue/language/language.h"
#include "etendue/object_map.h"
#include "geometry/geometry.h"
#include "support/component_test_support.h"

namespace etendue {
namespace {

using test::create;
using test::Setting;

SurfacePoint at(float u, float v) {
  SurfacePoint p = test::surface_point({0, 0, 1});
  p.uv = {u, v};
  p.position = p.object_position = {u, v, 0};
  return p;
}
const Color rising = table_spectrum({360, 830}, {0.1f, 0.6f}), falling = table_spectrum({360, 830}, {0.9f, 0.2f});

TEST(CombinedMaps, ActOnSpectraAndNumbers) {
  struct Case {
    const char* name;
    float (*wanted)(float, float);
  };
  for (const Case& c : {Case{"AddMap", [](float a, float b) { return std::min(a + b, 1.0f); }},
                        Case{"SubtractMap", [](float a, float b) { return std::max(a - b, 0.0f); }},
                        Case{"MultiplyMap", [](float a, float b) { return a * b; }},
                        Case{"DivideMap", [](float a, float b) { return std::min(a / b, 1.0f); }},
                        Case{"MinMap", [](float a, float b) { return std::min(a, b); }},
                        Case{"MaxMap", [](float a, float b) { return std::max(a, b); }}}) {
    const Ref<ObjectMap> map = create<ObjectMap>(c.name, {{"first", rising}, {"second", falling}});
    for (const float hero : {380.0f, 450.0f, 590.0f}) {
      const Wavelengths w = test::wavelengths(hero);
      const Spectrum got = map->color(at(0, 0), w, ColorUse::reflectance), a = rising->evaluate(w, ColorUse::reflectance),
                     b = falling->evaluate(w, ColorUse::reflectance);
      for (int i = 0; i < spectrum_size; ++i) EXPECT_NEAR(got[i], c.wanted(a[i], b[i]), 1e-6f) << c.name;
    }
  }
  EXPECT_NEAR(create<ObjectMap>("SubtractMap", {{"first", 0.2}, {"second", 0.7}})->scalar(at(0, 0)), -0.5f, 1e-6f);
  EXPECT_NEAR(create<ObjectMap>("AddMap", {{"first", 0.5}, {"second", 0.75}, {"third", 2.0}})->scalar(at(0, 0)), 3.25f, 1e-6f);
  EXPECT_NEAR(create<ObjectMap>("MixMap", {{"first", 2.0}, {"second", 4.0}, {"amount", 0.25}})->scalar(at(0, 0)), 2.5f, 1e-6f);
  EXPECT_NEAR(create<ObjectMap>("PowerMap", {{"base", 3.0}, {"exponent", 2.0}})->scalar(at(0, 0)), 9, 1e-5f);
  const std::vector<double> from{2, 4}, to{1, -1};
  EXPECT_NEAR(create<ObjectMap>("RemapMap", {{"input", 3.5}, {"from", from}, {"to", to}})->scalar(at(0, 0)), -0.5f, 1e-6f);
  EXPECT_NEAR(create<ObjectMap>("RemapMap", {{"input", 9.0}, {"from", from}, {"to", to}})->scalar(at(0, 0)), -1, 1e-6f);
}

TEST(CombinedMaps, GiveFiniteValuesWhateverTheyAreGiven) {
  const auto value = [](const char* name, double a, double b, const char* x = "first", const char* y = "second") {
    return create<ObjectMap>(name, {{x, a}, {y, b}})->scalar(at(0, 0));
  };
  EXPECT_EQ(value("DivideMap", 1, 0), 0);
  EXPECT_EQ(value("DivideMap", 0, 0), 0);
  EXPECT_EQ(value("MultiplyMap", 1e30, 1e30), 0);
  EXPECT_EQ(value("PowerMap", -2, 0.5, "base", "exponent"), 0);
  EXPECT_EQ(value("PowerMap", 0, -1, "base", "exponent"), 0);
  EXPECT_TRUE(create<ObjectMap>("DivideMap", {{"first", rising}, {"second", 0.0}})
                  ->color(at(0, 0), test::wavelengths(), ColorUse::coefficient)
                  .finite());
}

TEST(CombinedMaps, AskForWhatIsMeant) {
  // An RGB radiance times an RGB factor contains the white's spectrum once.
  const Wavelengths w = test::wavelengths();
  const Color rgb = rgb_color("srgb", 2, 1, 0.5);
  const Spectrum light =
      create<ObjectMap>("MultiplyMap", {{"first", rgb}, {"second", rgb}})->color(at(0, 0), w, ColorUse::radiance);
  const Spectrum wanted = rgb->evaluate(w, ColorUse::radiance) * rgb->evaluate(w, ColorUse::coefficient);
  for (int i = 0; i < spectrum_size; ++i) EXPECT_NEAR(light[i], wanted[i], 1e-5f);
  const Ref<ObjectMap> sum = create<ObjectMap>("AddMap", {{"first", 0.8}, {"second", 0.7}});
  EXPECT_EQ(sum->color(at(0, 0), w, ColorUse::reflectance)[0], 1);
  EXPECT_NEAR(sum->color(at(0, 0), w, ColorUse::coefficient)[0], 1.5f, 1e-6f);
}

TEST(Formula, ComputesWhatIsWritten) {
  const auto value = [](const std::string& text) {
    const Spectrum values[] = {2.0f, 5.0f, NAN};
    return Formula(text, {"a", "b", "nan"}).run(values)[1];
  };
  const std::pair<const char*, double> table[] = {
      {"1 + 2 * 3", 7},
      {"(1 + 2) * 3", 9},
      {"8 - 2 - 1", 5},
      {"16 / 4 / 2", 2},
      {"-a + b", 3},
      {"- (a - b) * 2", 6},
      {"a - -b", 7},
      {"abs(a - b)", 3},
      {"sqrt(16)", 4},
      {"exp(log(b))", 5},
      {"sin(pi / 2) + cos(0)", 2},
      {"atan2(1, 1) * 4", M_PI},
      {"floor(2.7) + fract(2.75)", 2.75},
      {"mod(-1, 3)", 2},
      {"pow(a, 10)", 1024},
      {"min(a, b) + 10 * max(a, b)", 52},
      {"step(3, a) + step(3, b)", 1},
      {"clamp(b, 0, 1)", 1},
      {"mix(a, b, 0.5)", 3.5},
      {"smoothstep(0, 10, b)", 0.5},
      {"mean(a)", 2},
      {"1e-3 * 1e3", 1},
      // A subexpression that is not a finite number is 0.
      {"1 + a / 0", 1},
      {"nan + 3", 3},
      {"sqrt(-1) + log(0) + log(-1) + 1", 1},
      {"pow(-8, 1 / 3)", 0},
      {"1e38 * 1e38", 0},
      {"mod(1, 0)", 0},
      {"exp(1000)", 0},
  };
  for (const auto& [text, wanted] : table) EXPECT_NEAR(value(text), wanted, 2e-6 * std::abs(wanted) + 1e-6) << text;
}

TEST(Formula, ErrorsSayTheirPlace) {
  struct Case {
    const char* text;
    int column;
    const char* message;
  };
  for (const Case& c : {Case{"a + * b", 5, "expected"}, Case{"a + blu", 5, "blue"}, Case{"1 + sine(a)", 5, "sin"},
                        Case{"pow(a)", 1, "2 arguments"}, Case{"a + \"b\"", 5, "numbers"}, Case{"(a + b", 1, "never closed"},
                        Case{"a b", 3, "b"}, Case{"3 m", 3, "units"}, Case{"[1, 2]", 1, "numbers"},
                        Case{"a + 1e60", 5, "large"}, Case{"", 1, ""}}) {
    try {
      static_cast<void>(Formula(c.text, {"a", "b", "blue"}));
      ADD_FAILURE() << c.text;
    } catch (const Error& e) {
      EXPECT_EQ(e.location.column, c.column) << c.text << ": " << e.what();
      EXPECT_NE(std::string(e.what()).find(c.message), std::string::npos) << c.text << ": " << e.what();
    }
  }
  std::string deep = "1";
  for (int i = 0; i < 40; ++i) deep = "1 - (" + deep + ")";
  EXPECT_THROW(Formula(deep, {}), Error);

  const Ref<Component> map = parse_component("FormulaMap {\n  names: [\"a\"], maps: [0.5]\n  formula: \"a + c\"\n}", "f.etd");
  try {
    prepare_tree(*map);
    ADD_FAILURE();
  } catch (const Error& e) {
    EXPECT_STREQ(e.location.file, "f.etd");
    EXPECT_EQ(e.location.line, 3);
    EXPECT_EQ(e.location.column, 17) << e.what();
  }
}

TEST(FormulaMap, IsComputedPerWavelength) {
  const Ref<Component> made =
      parse_component("FormulaMap { formula: \"a * a + 0.1 * x\", names: [\"a\"], maps: [ConstantMap { value: 0.3 }] }");
  set(*made, "maps", Value(Value::List{Value(Ref<Component>(create<ObjectMap>("ConstantMap", {{"value", rising}})))}));
  prepare_tree(*made);
  const auto map = ref_cast<ObjectMap>(made);
  const Wavelengths w = test::wavelengths();
  const Spectrum a = rising->evaluate(w, ColorUse::reflectance), got = map->color(at(2, 0), w, ColorUse::reflectance);
  for (int i = 0; i < spectrum_size; ++i) EXPECT_NEAR(got[i], a[i] * a[i] + 0.2f, 1e-6f);
  EXPECT_NEAR(map->scalar(at(2, 0)), 0.35f * 0.35f + 0.2f, 1e-5f);
}

TEST(Mappings, TangentsFollowTheCoordinates) {
  test::Random random(1);
  for (int i = 0; i < 200; ++i) {
    SurfacePoint p = test::surface_point(Normal3(random.direction()));
    const Vector3 a = random.direction(), b = 3 * random.direction();
    set_uv(p, {{0.1f, 0.2f}, a, b});
    if (std::abs(dot(cross(a, b), Vector3(p.normal))) < 0.1f) continue;
    EXPECT_NEAR(dot(p.dpdu, a), 1, 1e-4f);
    EXPECT_NEAR(dot(p.dpdu, b), 0, 1e-4f);
    EXPECT_NEAR(dot(p.dpdv, a), 0, 1e-4f);
    EXPECT_NEAR(dot(p.dpdv, b), 1, 1e-4f);
    EXPECT_NEAR(dot(p.dpdu, p.normal), 0, 1e-4f);
    EXPECT_NEAR(dot(p.dpdv, p.normal), 0, 1e-4f);
  }
  // On a wall that is seen edge-on one coordinate does not change, so the footprint does not extend along it.
  SurfacePoint p = test::surface_point({1, 0, 0});
  set_uv(p, {{0, 0}, {1, 0, 0}, {0, 1, 0}});
  p.footprint = 0.1f;
  const Vector2 box = uv_footprint(p).box();
  EXPECT_NEAR(box.x, 0, 1e-4f);
  EXPECT_NEAR(box.y, 0.1f, 1e-4f);
}

/// A sphere with a transform, and points on it as they are found in a scene that is nested in another.
struct Nested {
  Ref<SceneObject> sphere = create<SceneObject>("Sphere");
  Transform inside =
      Transform::translate({1, 2, 3}) * Transform::rotate(0.6f, {0, 1, 1}) * Transform::scale({0.5f, 0.5f, 0.5f});
  Transform outside = Transform::translate({-2, 1, 0.5f}) * Transform::rotate(1.1f, {1, -1, 2}) * Transform::scale({2, 2, 2});

  Nested() {
    set(*sphere, "transform", Value(inside));
    prepare_tree(*sphere);
  }
  SurfacePoint point(test::Random& random) const {
    SurfacePoint p = sphere->sample_area(random.pair(), 0).point;
    sphere->tangents(p);
    carry_out(outside, p);
    p.footprint = 0.03f;
    p.footprint_cosine = 0.8f;
    return p;
  }
};

TEST(Mappings, PlacementGoesThroughNestedScenes) {
  const Nested nested;
  test::Random random(2);
  const Transform wanted = nested.outside * nested.inside;
  for (int i = 0; i < 100; ++i) {
    const SurfacePoint p = nested.point(random);
    Transform scratch;
    const Transform::Matrix& got = placement(p, scratch).matrix();
    for (size_t k = 0; k < 12; ++k) EXPECT_NEAR(got[k], wanted.matrix()[k], 1e-4f) << k;
    // The composed transform does not change the sphere's size, so its textures have the same footprint.
    EXPECT_NEAR(solid_point(p, MapSpace::object, 1).width, p.footprint / std::sqrt(p.footprint_cosine), 1e-4f * p.footprint);
  }
}

TEST(Mappings, TransformedMapsSeeTheFootprintMovedAlong) {
  // A transform of the map leaves surface coordinates unchanged, and with them the footprint in them.
  const Nested nested;
  const Ref<ObjectMap> fine = create<ObjectMap>("CheckerMap", {{"repeat", std::vector<double>{60, 30, 1}}});
  test::Random random(4);
  double without = 0;
  for (const Transform& t :
       {Transform::rotate(70, {1, 2, 3}), Transform::scale({1, -3, 0.5f}) * Transform::rotate(40, {3, 1, 0})})
    for (const bool world : {false, true}) {
      const Ref<ObjectMap> moved = create<ObjectMap>("TransformedMap", {{"map", fine}});
      set(*moved, "transform", Value(t));
      set(*moved, "world", Value(world));
      prepare_tree(*moved);
      for (int i = 0; i < 200; ++i) {
        SurfacePoint p = nested.point(random);
        const Frame frame(p.normal);
        p.footprint_cosine = 0.1f + 0.9f * random();
        const float sine = safe_sqrt(1 - square(p.footprint_cosine)), angle = 2 * pi * random();
        p.ray_direction =
            sine * (std::cos(angle) * frame.s + std::sin(angle) * frame.t) - p.footprint_cosine * Vector3(p.normal);
        EXPECT_NEAR(moved->scalar(p), fine->scalar(p), 5e-3f);
        SurfacePoint circle = p;
        circle.ray_direction = {};
        without = std::max(without, std::abs(double(fine->scalar(circle)) - double(fine->scalar(p))));
        p.footprint = 0;
        EXPECT_EQ(moved->scalar(p), fine->scalar(p));
      }
    }
  EXPECT_GT(without, 0.1);  // the footprint's direction matters here
}

TEST(Mappings, AgreeWithTheSphereItself) {
  const Nested nested;
  const Ref<ObjectMap> uv = create<ObjectMap>("UvMap"), spherical = create<ObjectMap>("SphericalMap", {{"map", uv}});
  const Ref<ObjectMap> fine = create<ObjectMap>("CheckerMap", {{"repeat", std::vector<double>{60, 30, 1}}}),
                       mapped = create<ObjectMap>("SphericalMap", {{"map", fine}});
  test::Random random(3);
  const Wavelengths w = test::wavelengths();
  for (int i = 0; i < 200; ++i) {
    const SurfacePoint p = nested.point(random);
    if (std::abs(p.object_normal.z) > 0.95f) continue;  // near the poles the directions of the tangents dominate
    for (int k = 0; k < spectrum_size; ++k) EXPECT_NEAR(uv->reflectance(p, w)[k], spherical->reflectance(p, w)[k], 2e-3f);
    EXPECT_NEAR(fine->scalar(p), mapped->scalar(p), 1e-2f);  // filtered over the same footprint
  }
}

TEST(Mappings, PlanarAndTriplanarAreFilteredOverTheFootprint) {
  const Ref<ObjectMap> checker = create<ObjectMap>("CheckerMap", {{"repeat", std::vector<double>{1, 1, 1}}});
  const Ref<ObjectMap> planar = create<ObjectMap>("PlanarMap", {{"map", checker}}),
                       triplanar = create<ObjectMap>("TriplanarMap", {{"map", checker}});
  SurfacePoint p = test::surface_point({0, 0, 1});
  test::Random random(4);
  for (int i = 0; i < 20; ++i) {
    p.position = p.object_position = {10 * random(), 10 * random(), 0};
    p.footprint = 3 * random();
    float mean = 0;
    SurfacePoint q = p;
    q.footprint = 0;
    for (int k = 0; k < 10000; ++k) {
      q.object_position =
          p.object_position + p.footprint * Vector3{(float(k % 100) - 49.5f) / 100, (float(k / 100) - 49.5f) / 100, 0};
      mean += planar->scalar(q) / 10000;
    }
    EXPECT_NEAR(planar->scalar(p), mean, 1e-2f);
    EXPECT_NEAR(triplanar->scalar(p), mean, 1e-2f);
  }
}

TEST(Mappings, ChangesOfCoordinatesKeepTheFootprint) {
  // A map repeated twice as densely equals the map at doubled coordinates, sharp or filtered; likewise for solid textures.
  test::TestSquare square(1);
  square.reference();
  const std::vector<double> eight{8, 8, 1}, four{4, 4, 1}, two{2, 2};
  const Ref<ObjectMap> dense = create<ObjectMap>("CheckerMap", {{"repeat", eight}}),
                       coarse = create<ObjectMap>("CheckerMap", {{"repeat", four}});
  const Ref<ObjectMap> doubled = create<ObjectMap>(
      "UvTransformMap", {{"map", coarse}, {"scale", two}, {"angle", 90.0}, {"shift", std::vector<double>{2.25, 1}}});
  const Ref<ObjectMap> fine = create<ObjectMap>("FbmMap", {{"size", 0.25}}),
                       whole = create<ObjectMap>("FbmMap", {{"size", 1.0}});
  const Ref<ObjectMap> moved = create<ObjectMap>("TransformedMap", {{"map", whole}});
  const Ref<ObjectMap> moved_world =
      create<ObjectMap>("TransformedMap", {{"map", create<ObjectMap>("FbmMap", {{"space", "world"}})}});
  for (const Ref<ObjectMap>& m : {moved, moved_world}) set(*m, "transform", Value(Transform::scale({4, 4, 4})));
  set(*moved_world, "world", Value(true));
  for (const Ref<ObjectMap>& m : {moved, moved_world}) prepare_tree(*m);
  test::Random random(5);
  for (int i = 0; i < 100; ++i) {
    SurfacePoint p = at(random(), random());
    p.object = &square;
    p.footprint = i % 2 ? 0.2f * random() : 0;
    EXPECT_NEAR(dense->scalar(p), doubled->scalar(p), 1e-3f);
    EXPECT_NEAR(fine->scalar(p), moved->scalar(p), 1e-4f);
    EXPECT_NEAR(fine->scalar(p), moved_world->scalar(p), 1e-4f);
  }
}

}  // namespace
}  // namespace etendue
