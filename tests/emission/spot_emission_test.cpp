// SpotEmission. Statistical tests have fixed seeds and a significance of 1e-3 over all their cases together.

#include "etendue/describe/color.h"
#include "etendue/infinite_object.h"
#include "etendue/object_map.h"
#include "support/cone_emission_support.h"

namespace etendue::test {
namespace {

constexpr Cone cones[] = {{20, 30}, {0, 45}, {40, 40}, {0.05, 0.1}, {60, 130}, {180, 180}, {0, 180}};

TEST(SpotEmission, FallsOffBetweenItsAngles) {
  const Ref<SceneObject> lamp = prepared_as<SceneObject>(
      "Point { transform: rotate(90 deg, [1, 0, 0]), emission: SpotEmission { radiance: 3, inner_angle: 20, outer_angle: 60 } "
      "}");
  const SurfacePoint p = lamp->sample_area({}, 0).point;
  const Frame frame{Normal3(0, -1, 0)};  // the transform rotates +z to -y
  const auto at_cosine = [&](double c) {
    return double(lamp->emission->radiance(p, frame.to_world({0, float(std::sqrt(1 - c * c)), float(c)}), wavelengths())[0]);
  };
  const double inner = std::cos(20 * M_PI / 180), outer = 0.5;
  EXPECT_EQ(at_cosine(1), 3);
  EXPECT_EQ(at_cosine(inner + 1e-5), 3);
  EXPECT_NEAR(at_cosine(0.75 * inner + 0.25 * outer), 3 * 0.84375, 1e-5);
  EXPECT_NEAR(at_cosine((inner + outer) / 2), 1.5, 1e-5);
  EXPECT_NEAR(at_cosine(0.25 * inner + 0.75 * outer), 3 * 0.15625, 1e-5);
  EXPECT_EQ(at_cosine(outer - 1e-5), 0);
  EXPECT_EQ(at_cosine(-1), 0);
}

TEST(SpotEmission, APictureSpansTheOuterAngle) {
  // u = 0 and 1 lie where the angle to the axis is 30 degrees towards -x and +x. The picture transmits 0.2 in one half of u and
  // 0.7 in the other, for all v: each to half of the light.
  const std::string halves = "CheckerMap { repeat: [2, 0.5, 1], first: 0.2, second: 0.7 }";
  const Ref<SceneObject>
      plain = prepared_as<SceneObject>("Point { emission: SpotEmission { radiance: 2 } }"),
      lamp = prepared_as<SceneObject>("Point { emission: SpotEmission { radiance: 2, picture: " + halves + " } }"),
      quarters = prepared_as<SceneObject>(
          "Point { emission: SpotEmission { radiance: 2, picture: CheckerMap { repeat: [4, 0.5, 1], first: 0.2, "
          "second: 0.7 } } }");
  const Wavelengths w = wavelengths();
  const SurfacePoint p = lamp->sample_area({}, 0).point;
  const auto seen = [&](const Ref<SceneObject>& l, double x, double y) {
    const Vector3 d = normalize(Vector3{float(x), float(y), 1});
    return double(l->emission->radiance(p, d, w)[0] / plain->emission->radiance(p, d, w)[0]);
  };
  EXPECT_NEAR(seen(lamp, -0.01, 0.1), 0.2, 1e-6);
  EXPECT_NEAR(seen(lamp, 0.01, -0.1), 0.7, 1e-6);
  const double quarter = std::tan(30 * M_PI / 180) / 2;  // from the axis, on a plane at distance 1
  EXPECT_NEAR(seen(quarters, -1.02 * quarter, 0), 0.2, 1e-6);
  EXPECT_NEAR(seen(quarters, -0.98 * quarter, 0), 0.7, 1e-6);
  EXPECT_NEAR(seen(quarters, 0.98 * quarter, 0), 0.2, 1e-6);
  EXPECT_NEAR(seen(quarters, 1.02 * quarter, 0), 0.7, 1e-6);
  EXPECT_NEAR(double(lamp->emission->power(*lamp, w)[0]), 0.45 * double(plain->emission->power(*plain, w)[0]), 1e-3);
  expect_refused("SpotEmission { picture: 0.5, outer_angle: 90 deg }", "picture", "less than 90");
  expect_refused("SpotEmission { picture: 0.5, axis: [1, 0, 0] }", "picture", "+z");
}

TEST(SpotEmission, PowerOfAPointIsItsIntensityOverAllDirections) {
  for (const Cone& c : cones) {
    const double h = one_minus_cosine(c.inner), edge = one_minus_cosine(c.outer) - h;
    expect_power_over_all_directions(c, 2 * M_PI * (h + edge / 2));  // t^2 (3 - 2 t) has the mean 1/2
  }
}

TEST(SpotEmission, SamplesFollowDensity) {
  std::uint32_t seed = 50;
  for (const Cone& c : cones) expect_samples_follow_density(c, seed++, each_of(int(std::size(cones))));
}

TEST(SpotEmission, PowerOfASurface) {
  const Wavelengths w = wavelengths();
  for (const char* sides : {"front", "back", "both"})
    for (const Vector3 axis : {Vector3{0, 0, 1}, Vector3{1, 0, 1}, Vector3{1, 2, 0.3f}, Vector3{0.2f, 0, -1}})
      for (const Cone& c : {Cone{20, 30}, Cone{30, 80}, Cone{40, 130}}) {
        TestSquare square(2);
        square.reference();
        const auto emission = [&](double watts) {
          return create<EmissionShader>("SpotEmission",
                                        {{"sides", sides},
                                         {"axis", std::vector<double>{double(axis.x), double(axis.y), double(axis.z)}},
                                         {"inner_angle", c.inner},
                                         {"outer_angle", c.outer},
                                         {"radiance", 3.0},
                                         {"power", watts}});
        };
        const SurfacePoint p = square.sample_area({0.5f, 0.5f}, 0).point;
        const auto emitted = [&](const EmissionShader& e) {
          return 4 * integrate_around(
                         normalize(axis), {0, one_minus_cosine(c.inner), one_minus_cosine(c.outer), 2},
                         [&](const Vector3& d) { return double(e.radiance(p, d, w)[0]) * std::abs(double(d.z)); }, 200, 64);
        };
        const Ref<EmissionShader> plain = emission(0), strong = emission(20);
        const double wanted = emitted(*plain), power = double(plain->power(square, w)[0]);
        EXPECT_NEAR(power, wanted, 2e-3 * wanted + 1e-3) << sides << axis.z << " " << c.outer;
        if (wanted > 0) {
          EXPECT_NEAR(emitted(*strong), 20.0 / 470, 3e-3 * 20 / 470) << sides << axis.z << " " << c.outer;
          EXPECT_NEAR(double(strong->power(square, w)[0]), 20.0 / 470, 1e-6);
        } else {
          EXPECT_THROW(strong->power(square, w), Error);
        }
      }
}

TEST(SpotEmission, ASphereIsAsStrongAsAPointOfItsCrossSection) {
  const Wavelengths w = wavelengths();
  const Ref<SceneObject> sphere = prepared_as<SceneObject>("Sphere { radius: 1.5, emission: SpotEmission { radiance: 2 } }");
  const double omega = M_PI * (one_minus_cosine(20) + one_minus_cosine(30));
  EXPECT_NEAR(double(sphere->emission->power(*sphere, w)[0]), 2 * M_PI * 2.25 * omega, 1e-3 * 2 * M_PI * 2.25 * omega);
}

TEST(SpotEmission, EachObjectHasThePower) {
  const Wavelengths w = wavelengths();
  const Ref<ObjectMap> checker = create<ObjectMap>("CheckerMap", {{"first", 1.0}, {"second", 3.0}});
  const Ref<EmissionShader> plain = create<EmissionShader>("SpotEmission", {{"power", 5.0}}),
                            varied = create<EmissionShader>("SpotEmission", {{"power", 5.0}, {"radiance", checker}});
  std::vector<std::unique_ptr<TestSquare>> squares;  // more than are cached
  for (int i = 0; i < 1100; ++i) {
    squares.push_back(std::make_unique<TestSquare>(0.5f + 0.01f * float(i)));
    squares.back()->reference();
  }
  double first = 0;
  for (const auto& square : squares) {
    const SurfacePoint p = square->sample_area({0.5f, 0.5f}, 0).point;
    const double flux = double(plain->radiance(p, {0, 0, 1}, w)[0] * square->area(0));
    if (first == 0) first = flux;
    EXPECT_NEAR(flux, first, 1e-5 * first);
  }
  EXPECT_NEAR(double(varied->power(*squares[0], w)[0]), 5.0 / 470, 1e-6);
  EXPECT_NEAR(double(varied->power(*squares[99], w)[0]), 5.0 / 470, 1e-6);
}

TEST(SpotEmission, OnAnEnvironmentIsASun) {
  const Wavelengths w = wavelengths();
  const Ref<SceneObject> sky = prepared_as<SceneObject>(
      "Environment { transform: rotate(90 deg, [1, 0, 0]), emission: SpotEmission { radiance: 7, inner_angle: 0.2, "
      "outer_angle: "
      "0.3 } }");
  dynamic_cast<InfiniteObject&>(*sky).enclose({0, 0, 0}, 2);
  const double omega = M_PI * (one_minus_cosine(0.2) + one_minus_cosine(0.3));
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const SurfaceSample s = sky->sample_visible({0.1f, 0.2f, 0.3f}, random.pair(), 0);
    ASSERT_GT(s.pdf, 0);
    EXPECT_GT(s.direction.y, 0.9999f);  // light travels along -y, to which +z is rotated
    const double light = double(sky->emission->radiance(s.point, -s.direction, w)[0]);
    if (light > 0.7) {  // nearer to the edge, rounding of the direction matters
      EXPECT_NEAR(light / double(s.pdf), 7 * omega, 1e-2 * 7 * omega);
      EXPECT_NEAR(double(sky->visible_pdf({}, s.direction, s.point)), double(s.pdf), 1e-2 * double(s.pdf));
    }
  }
  EXPECT_EQ(sky->visible_pdf({}, {0, 0, 1}, sky->sample_visible({}, {0.5f, 0.5f}, 0).point), 0);
  EXPECT_NEAR(double(sky->emission->power(*sky, w)[0]), 7 * omega * M_PI * 4, 1e-4 * 7 * omega * M_PI * 4);
}

TEST(SpotEmission, RefusesWhatMakesNoCone) {
  expect_refused("SpotEmission { axis: [0, 0, 0] }", "axis", "not zero");
  expect_refused("SpotEmission { outer_angle: 10 deg }", "outer_angle", "no less than inner_angle");
  expect_refused("SpotEmission { radiance: -1 }", "radiance", "negative");
  expect_refused("SpotEmission { radiance: 0, power: 3 W }", "radiance", "black");
  EXPECT_THROW(parse_component("SpotEmission { outer_angle: 0 }"), Errors);
  EXPECT_THROW(parse_component("SpotEmission { outer_angle: 181 }"), Errors);
}

}  // namespace
}  // namespace etendue::test
