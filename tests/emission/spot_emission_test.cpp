// SpotEmission. Statistical tests have fixed seeds and a significance of 1e-3 over all their cases together.

#include <gtest/gtest.h>

#include "etendue/describe/color.h"
#include "etendue/infinite_object.h"
#include "etendue/object_map.h"
#include "support/luminaire_test_support.h"

namespace etendue::test {
namespace {

struct Cone {
  double inner, outer;
  std::string_view edge = "smooth";
};
constexpr Cone cones[] = {{20, 30},
                          {0, 45},
                          {40, 40},
                          {0.05, 0.1},
                          {60, 130},
                          {180, 180},
                          {0, 180},
                          {15, 20, "linear"},
                          {0, 45, "linear"},
                          {40, 40, "linear"},
                          {0.05, 0.1, "linear"},
                          {60, 130, "linear"},
                          {0, 180, "linear"},
                          {1, 2.5, "linear"},
                          {15, 20, "square"},
                          {40, 40, "square"},
                          {0.05, 0.1, "square"},
                          {0, 180, "square"},
                          {15, 20, "quartic"},
                          {40, 40, "quartic"},
                          {0, 180, "quartic"},
                          {15, 20, "smooth_angle"},
                          {0, 45, "smooth_angle"},
                          {40, 40, "smooth_angle"},
                          {0.05, 0.1, "smooth_angle"},
                          {60, 130, "smooth_angle"},
                          {0, 180, "smooth_angle"}};

/// The integral of the profile over all directions: for a linear edge 2 pi (1 - (sin b - sin a) / (b - a)), integrated by
/// parts; for an edge that is smooth in the angle by the midpoint rule; for the others from the mean over the edge: of t^2 (3 -
/// 2 t) it is 1/2, of t^2 it is 1/3, of t^4 it is 1/5.
double solid_angle(const Cone& c) {
  const double a = c.inner * M_PI / 180, b = c.outer * M_PI / 180;
  const double h = one_minus_cosine(c.inner), beyond = one_minus_cosine(c.outer) - h;
  if (c.edge == "smooth_angle" && a < b) {
    constexpr int n = 20000;
    double sum = 0;
    for (int i = 0; i < n; ++i) {
      const double t = (i + 0.5) / n;
      sum += t * t * (3 - 2 * t) * std::sin(b - t * (b - a)) / n;
    }
    return 2 * M_PI * (h + (b - a) * sum);
  }
  const double parts = c.edge == "square" ? 3 : c.edge == "quartic" ? 5 : 2;
  if (c.edge != "linear" || a == b) return 2 * M_PI * (h + beyond / parts);
  return 2 * M_PI * (1 - (std::sin(b) - std::sin(a)) / (b - a));
}

std::string spot(const Cone& c, const std::string& more = "") {
  return "SpotEmission { inner_angle: " + std::to_string(c.inner) + ", outer_angle: " + std::to_string(c.outer) +
         ", edge: " + std::string(c.edge) + more + " }";
}

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

TEST(SpotEmission, ALinearEdgeFallsWithTheAngle) {
  const Ref<SceneObject> lamp = prepared_as<SceneObject>(
      "Point { emission: SpotEmission { radiance: 3, inner_angle: 15, outer_angle: 20, edge: linear } }");
  const SurfacePoint p = lamp->sample_area({}, 0).point;
  for (const double angle : {0.0, 14.99, 15.5, 16.0, 17.5, 19.0, 19.9, 20.01, 100.0}) {
    const double a = angle * M_PI / 180, wanted = 3 * std::clamp((20 - angle) / 5, 0.0, 1.0);
    const Vector3 d{float(std::sin(a) * 0.6), float(std::sin(a) * 0.8), float(std::cos(a))};
    EXPECT_NEAR(double(lamp->emission->radiance(p, d, wavelengths())[0]), wanted, 1e-5) << angle;
  }
}

TEST(SpotEmission, ASmoothEdgeByTheAngleIsHalfInItsMiddle) {
  const Ref<SceneObject> lamp = prepared_as<SceneObject>(
      "Point { emission: SpotEmission { radiance: 3, inner_angle: 20, outer_angle: 60, edge: smooth_angle } }");
  const SurfacePoint p = lamp->sample_area({}, 0).point;
  for (const auto& [angle, wanted] :
       {std::pair(19.9, 3.0), {30.0, 3 * 0.84375}, {40.0, 1.5}, {50.0, 3 * 0.15625}, {60.1, 0.0}}) {
    const double a = angle * M_PI / 180;
    EXPECT_NEAR(double(lamp->emission->radiance(p, {0, float(std::sin(a)), float(std::cos(a))}, wavelengths())[0]), wanted,
                1e-4)
        << angle;
  }
}

TEST(SpotEmission, EdgesFallWithPowers) {
  for (const auto& [edge, power] : {std::pair("square", 2), std::pair("quartic", 4)}) {
    const Ref<SceneObject> lamp = prepared_as<SceneObject>(
        std::string("Point { emission: SpotEmission { radiance: 3, inner_angle: 10, outer_angle: 60, edge: ") + edge + " } }");
    const SurfacePoint p = lamp->sample_area({}, 0).point;
    const double inner = std::cos(10 * M_PI / 180), outer = 0.5;
    for (const double t : {0.0, 0.25, 0.5, 0.9, 1.0}) {
      const double c = outer + t * (inner - outer);
      const Vector3 d{float(std::sqrt(1 - c * c)), 0, float(c)};
      EXPECT_NEAR(double(lamp->emission->radiance(p, d, wavelengths())[0]), 3 * std::pow(t, power), 1e-5) << edge << t;
    }
  }
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
  const Wavelengths w = wavelengths();
  // The cone of a stretched object stays round, about the stretched axis.
  const Transform placement =
      Transform::translate({1, 2, 3}) * Transform::rotate(1, {1, 2, 3}) * Transform::scale({1, 3, 0.5f});
  for (const Cone& c : cones)
    for (const double watts : {0.0, 60.0}) {
      const Ref<SceneObject> lamp = prepared_as<SceneObject>(
          "Point { emission: " + spot(c, ", axis: [1, -2, 0.5], radiance: 2, power: " + std::to_string(watts)) + " }");
      lamp->transform = placement;
      const SurfacePoint p = lamp->sample_area({}, 0).point;
      const Vector3 axis = normalize(placement(Vector3{1, -2, 0.5f}));
      const double emitted = integrate_around(axis, {0, one_minus_cosine(c.inner), one_minus_cosine(c.outer), 2},
                                              [&](const Vector3& d) { return double(lamp->emission->radiance(p, d, w)[0]); });
      const double power = double(lamp->emission->power(*lamp, w)[0]);
      EXPECT_NEAR(power, emitted, 2e-3 * emitted) << c.inner << " " << c.outer << " " << watts;
      const double omega = solid_angle(c);
      EXPECT_NEAR(power, watts > 0 ? watts / 470 : 2 * omega, 1e-5 * power);
    }
}

TEST(SpotEmission, SamplesFollowDensity) {
  constexpr int rows = 60, columns = 8, count = 40000;
  std::uint32_t seed = 50;
  for (const Cone& c : cones) {
    const Ref<SceneObject> lamp = prepared_as<SceneObject>("Point { emission: " + spot(c, ", axis: [1, -2, 0.5]") + " }");
    lamp->transform = Transform::rotate(1, {1, 2, 3});
    const SurfacePoint p = lamp->sample_area({}, 0).point;
    const Vector3 axis = normalize(lamp->transform.still()(Vector3{1, -2, 0.5f}));
    const double reach = one_minus_cosine(c.outer);
    const auto pdf = [&](const Vector3& d) { return double(lamp->emission->pdf(p, d)); };
    EXPECT_NEAR(integrate_around(axis, {0, one_minus_cosine(c.inner), reach, 2}, pdf), 1, 2e-3) << c.inner;
    // Rows of equal steps in 1 - cos up to the cone's edge; the pdf is integrated numerically for the probability of each cell.
    std::vector<double> expected, counts(size_t(rows * columns));
    for (int row = 0; row < rows; ++row) {
      const double inner = one_minus_cosine(c.inner), low = reach * row / rows, high = reach * (row + 1) / rows;
      const std::vector<double> borders =
          inner > low && inner < high ? std::vector<double>{low, inner, high} : std::vector<double>{low, high};
      const double chance = integrate_around(axis, borders, pdf, 100, 1);
      for (int k = 0; k < columns; ++k) expected.push_back(chance / columns * count);
    }
    const Frame frame{Normal3(axis)};
    Random random(seed++);
    for (int i = 0; i < count; ++i) {
      const DirectionSample s = lamp->emission->sample(p, random.pair());
      ASSERT_NEAR(length(s.direction), 1, 1e-5f);
      EXPECT_NEAR(double(s.pdf), pdf(s.direction), 2e-3 * double(s.pdf) + 2e-3 / reach);
      const Vector3 v = frame.to_local(s.direction);
      const double h = double(length_squared(s.direction - axis)) / 2;
      const int row = std::min(int(h / reach * rows), rows - 1);
      const int column = std::min(int((std::atan2(double(v.y), double(v.x)) / (2 * M_PI) + 0.5) * columns), columns - 1);
      ++counts[size_t(row * columns + column)];
    }
    EXPECT_GT(chi_square(counts, expected), each_of(int(std::size(cones)))) << c.inner << " " << c.outer;
  }
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
