// Luminaires without extent, spotlights, the homogeneous medium and the boundary that is not there. Statistical tests have
// fixed seeds and a significance of 1e-3 over all their cases together.

#include <gtest/gtest.h>

#include "component_test_support.h"
#include "etendue/color.h"
#include "etendue/object_map.h"
#include "render_support.h"

namespace etendue::test {
namespace {

Ref<Component> prepared(const std::string& text) {
  Ref<Component> made = parse_component(text, "test.etd");
  prepare_tree(*made);
  return made;
}
template <class T>
Ref<T> prepared_as(const std::string& text) {
  return ref_cast<T>(prepared(text));
}

/// Refused when it is prepared, at a column of the text, with a message that says some words.
void expect_refused(const std::string& text, const std::string& member, const std::string& words) {
  const Ref<Component> made = parse_component(text, "test.etd");
  try {
    prepare_tree(*made);
    ADD_FAILURE() << "accepted: " << text;
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find(words), std::string::npos) << e.what();
    EXPECT_STREQ(e.location.file, "test.etd");
    EXPECT_EQ(e.location.line, 1);
    const size_t at = text.find(member + ":");
    ASSERT_NE(at, std::string::npos);
    EXPECT_GE(e.location.column, int(at) + 1) << text << " -> " << e.what();
    EXPECT_LE(e.location.column, int(at + member.size()) + 3) << text << " -> " << e.what();
  }
}

/// A motion from one transform to another over a second.
AnimatedTransform motion(const Transform& from, const Transform& to) {
  return AnimatedTransform(std::vector<AnimatedTransform::Key>{{0, from}, {1, to}});
}

void expect_near(const Vector3& a, const Vector3& b, float tolerance = 1e-6f) { EXPECT_LT(length(a - b), tolerance); }

/// The integral over all directions of a function: midpoints in 1 - cos(theta) to an axis, finer between borders of it.
double integrate_around(const Vector3& axis, const std::vector<double>& borders, const std::function<double(const Vector3&)>& f,
                        int steps = 2000, int sectors = 8) {
  const Frame frame{Normal3(axis)};
  double sum = 0;
  for (size_t part = 0; part + 1 < borders.size(); ++part) {
    const double dh = (borders[part + 1] - borders[part]) / steps;
    for (int i = 0; i < steps; ++i)
      for (int k = 0; k < sectors; ++k) {
        const double h = borders[part] + (i + 0.5) * dh, r = std::sqrt(h * (2 - h)), phi = 2 * M_PI * (k + 0.5) / sectors;
        sum += f(frame.to_world({float(r * std::cos(phi)), float(r * std::sin(phi)), float(1 - h)})) * dh * 2 * M_PI / sectors;
      }
  }
  return sum;
}

double one_minus_cosine(double degrees) { return 2 * std::pow(std::sin(degrees * M_PI / 360), 2); }

// ---- Point ----------------------------------------------------------------------------------------------------------

TEST(Point, IsFoundWhereItIs) {
  const Ref<SceneObject> point = prepared_as<SceneObject>("Point { position: [1, 2, 3] }");
  EXPECT_TRUE(point->delta());
  EXPECT_FALSE(point->infinite());
  EXPECT_TRUE(point->bounds().empty());
  EXPECT_EQ(point->area(0), 4);
  point->transform = Transform::translate({0, 0, 1}) * Transform::scale({2, 2, 2});
  const SurfaceSample a = point->sample_area({0.3f, 0.6f}, 0.25f);
  EXPECT_EQ(a.density, 1);
  EXPECT_TRUE(a.delta);
  EXPECT_FALSE(a.infinite);
  EXPECT_EQ(a.point.position, (Point3{2, 4, 7}));
  EXPECT_EQ(a.point.object_position, (Point3{1, 2, 3}));
  EXPECT_EQ(a.point.normal, Normal3{});
  EXPECT_EQ(a.point.shading_normal, Normal3{});
  EXPECT_EQ(a.point.error, 0);
  EXPECT_EQ(a.point.object, point.get());
  EXPECT_EQ(a.point.time, 0.25f);
  EXPECT_EQ(point->area_density(a.point), 1);

  const SurfaceSample s = point->sample_visible({2, 1, 3}, {0.3f, 0.6f}, 0);
  EXPECT_TRUE(s.delta);
  EXPECT_FLOAT_EQ(s.density, 25);
  EXPECT_FLOAT_EQ(s.distance, 5);
  expect_near(s.direction, {0, 0.6f, 0.8f});
  EXPECT_EQ(s.point.position, (Point3{2, 4, 7}));
  EXPECT_EQ(point->visible_density({2, 1, 3}, s.direction, s.point), 0);
  EXPECT_EQ(point->sample_visible({2, 4, 7}, {0.3f, 0.6f}, 0).density, 0);

  point->transform = motion(Transform(), Transform::translate({4, 0, 0}));
  EXPECT_LT(distance(point->sample_area({0.5f, 0.5f}, 0.5f).point.position, {3, 2, 3}), 1e-5f);
}

TEST(Point, RefusesASurface) {
  expect_refused("Point { shader: Lambertian {} }", "shader", "no surface");
  expect_refused("Point { interior: HomogeneousVolume {} }", "interior", "no inside");
}

TEST(Point, DiffusePowerIsIntensityOverAllDirections) {
  const Ref<SceneObject> point =
      prepared_as<SceneObject>("Point { transform: scale(3, 3, 3), emission: DiffuseEmission { power: 60 W } }");
  const Wavelengths w = wavelengths();
  const SurfaceSample s = point->sample_area({0.5f, 0.5f}, 0);
  const double emitted = integrate_around(
      {0, 0, 1}, {0, 2}, [&](const Vector3& d) { return double(point->emission->radiance(s.point, d, w)[0]); }, 50);
  EXPECT_NEAR(emitted, 60.0 / 470, 1e-5);  // flat from 360 to 830 nm
  EXPECT_NEAR(double(point->emission->power(*point, w)[0]), 60.0 / 470, 1e-6);
}

// ---- Distant --------------------------------------------------------------------------------------------------------

TEST(Distant, LightTravelsItsWay) {
  const Ref<SceneObject> sun = prepared_as<SceneObject>("Distant { direction: [0, -3, 4] }");
  EXPECT_TRUE(sun->delta());
  EXPECT_TRUE(sun->infinite());
  EXPECT_TRUE(sun->bounds().empty());
  EXPECT_EQ(sun->sample_area({0.5f, 0.5f}, 0).density, 0);
  sun->enclose({1, 1, 1}, 3);
  EXPECT_FLOAT_EQ(sun->area(0), 9);
  const Point3 from{2, 0, 1};
  SurfaceSample s = sun->sample_visible(from, {0.1f, 0.2f}, 0.5f);
  EXPECT_EQ(s.density, 1);
  EXPECT_TRUE(s.delta && s.infinite);
  EXPECT_EQ(s.distance, infinity);
  expect_near(s.direction, {0, 0.6f, -0.8f});
  EXPECT_EQ(s.point.normal, Normal3{});
  EXPECT_EQ(s.point.shading_normal, Normal3{});
  EXPECT_EQ(s.point.object, sun.get());
  EXPECT_EQ(s.point.time, 0.5f);
  EXPECT_GT(distance(s.point.position, {1, 1, 1}), 3);
  expect_near(normalize(s.point.position - from), s.direction);
  EXPECT_EQ(sun->visible_density(from, s.direction, s.point), 0);

  sun->transform = Transform::rotate(pi / 2, {1, 0, 0});  // y to z, z to -y
  expect_near(sun->sample_visible(from, {}, 0).direction, {0, 0.8f, 0.6f});
  expect_near(sun->sample_visible(from, {}, 0).point.object_position - Point3{}, {0, 0.6f, -0.8f});
  sun->transform = motion(Transform(), Transform::rotate(pi / 2, {1, 0, 0}));
  expect_near(sun->sample_visible(from, {}, 1).direction, {0, 0.8f, 0.6f}, 1e-5f);
  const float half = std::sqrt(0.5f);
  expect_near(sun->sample_visible(from, {}, 0.5f).direction, {0, half * (0.6f + 0.8f), half * (0.6f - 0.8f)}, 1e-5f);
}

TEST(Distant, PowerIsIrradianceTimesTheScenesDisc) {
  const Wavelengths w = wavelengths();
  const Ref<SceneObject> sun = prepared_as<SceneObject>("Distant { emission: DiffuseEmission { radiance: 2 } }");
  sun->enclose({0, 0, 0}, 3);
  EXPECT_NEAR(double(sun->emission->power(*sun, w)[0]), 2 * M_PI * 9, 1e-4);
  // On the axis of a spotlight's profile, and where it is half.
  for (const double angle : {0.0, 25.0}) {
    const Ref<SceneObject> beam =
        prepared_as<SceneObject>("Distant { direction: [" + std::to_string(std::sin(angle * M_PI / 180)) + ", 0, " +
                                 std::to_string(std::cos(angle * M_PI / 180)) + "], emission: SpotEmission { radiance: 2 } }");
    beam->enclose({0, 0, 0}, 3);
    const SurfaceSample s = beam->sample_visible({0.1f, 0.2f, 0.3f}, {}, 0);
    const double irradiance = double(beam->emission->radiance(s.point, -s.direction, w)[0] / s.density);
    const double t =
        (std::cos(25 * M_PI / 180) - std::cos(30 * M_PI / 180)) / (std::cos(20 * M_PI / 180) - std::cos(30 * M_PI / 180));
    EXPECT_NEAR(irradiance, angle == 0 ? 2 : 2 * t * t * (3 - 2 * t), 1e-3);
    EXPECT_NEAR(double(beam->emission->power(*beam, w)[0]), irradiance * M_PI * 9, 1e-3);
    expect_near(beam->emission->sample(s.point, {0.5f, 0.5f}).direction, -s.direction);
  }
}

TEST(Distant, RefusesNoDirectionAndASurface) {
  expect_refused("Distant { direction: [0, 0, 0] }", "direction", "not zero");
  expect_refused("Distant { shader: Lambertian {} }", "shader", "no surface");
  expect_refused("Distant { interior: HomogeneousVolume {} }", "interior", "no inside");
  EXPECT_NO_THROW(prepared("Distant { direction: [0, 1e-30, 1e-30] }"));
  EXPECT_NO_THROW(prepared("Distant { direction: [0, 1e30, 1e30] }"));
}

// ---- SpotEmission ---------------------------------------------------------------------------------------------------

struct Cone {
  double inner, outer;
};
constexpr Cone cones[] = {{20, 30}, {0, 45}, {40, 40}, {0.05, 0.1}, {60, 130}, {180, 180}, {0, 180}};

std::string spot(const Cone& c, const std::string& more = "") {
  return "SpotEmission { inner_angle: " + std::to_string(c.inner) + ", outer_angle: " + std::to_string(c.outer) + more + " }";
}

TEST(SpotEmission, FallsOffBetweenItsAngles) {
  const Ref<SceneObject> lamp = prepared_as<SceneObject>(
      "Point { transform: rotate(90 deg, [1, 0, 0]), emission: SpotEmission { radiance: 3, inner_angle: 20, outer_angle: 60 } "
      "}");
  const SurfacePoint p = lamp->sample_area({}, 0).point;
  const Frame frame{Normal3(0, -1, 0)};  // where the transform turns +z
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

TEST(SpotEmission, PowerOfAPointIsItsIntensityOverAllDirections) {
  const Wavelengths w = wavelengths();
  // A stretched object's cone stays round around the stretched axis.
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
      const double omega = M_PI * (one_minus_cosine(c.inner) + one_minus_cosine(c.outer));
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
    const auto density = [&](const Vector3& d) { return double(lamp->emission->density(p, d)); };
    EXPECT_NEAR(integrate_around(axis, {0, one_minus_cosine(c.inner), reach, 2}, density), 1, 2e-3) << c.inner;
    // Rows of equal steps in 1 - cos to the edge of the cone; for the probability of each the density is integrated again.
    std::vector<double> expected, counts(size_t(rows * columns));
    for (int row = 0; row < rows; ++row) {
      const double inner = one_minus_cosine(c.inner), low = reach * row / rows, high = reach * (row + 1) / rows;
      const std::vector<double> borders =
          inner > low && inner < high ? std::vector<double>{low, inner, high} : std::vector<double>{low, high};
      const double chance = integrate_around(axis, borders, density, 100, 1);
      for (int k = 0; k < columns; ++k) expected.push_back(chance / columns * count);
    }
    const Frame frame{Normal3(axis)};
    Random random(seed++);
    for (int i = 0; i < count; ++i) {
      const DirectionSample s = lamp->emission->sample(p, random.pair());
      ASSERT_NEAR(length(s.direction), 1, 1e-5f);
      EXPECT_NEAR(double(s.density), density(s.direction), 2e-3 * double(s.density) + 2e-3 / reach);
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
  std::vector<std::unique_ptr<TestSquare>> squares;  // more than are remembered
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
  sky->enclose({0, 0, 0}, 2);
  const double omega = M_PI * (one_minus_cosine(0.2) + one_minus_cosine(0.3));
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const SurfaceSample s = sky->sample_visible({0.1f, 0.2f, 0.3f}, random.pair(), 0);
    ASSERT_GT(s.density, 0);
    EXPECT_GT(s.direction.y, 0.9999f);  // light travels along what was +z and is now -y
    const double light = double(sky->emission->radiance(s.point, -s.direction, w)[0]);
    if (light > 0.7) {  // nearer to the edge rounding of the direction shows
      EXPECT_NEAR(light / double(s.density), 7 * omega, 1e-2 * 7 * omega);
      EXPECT_NEAR(double(sky->visible_density({}, s.direction, s.point)), double(s.density), 1e-2 * double(s.density));
    }
  }
  EXPECT_EQ(sky->visible_density({}, {0, 0, 1}, sky->sample_visible({}, {0.5f, 0.5f}, 0).point), 0);
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

// ---- HomogeneousVolume ----------------------------------------------------------------------------------------------

constexpr double anisotropies[] = {0, 1e-4, 0.3, -0.3, 0.9, -0.9, 0.99};

Ref<VolumeShader> medium(double g) { return create<VolumeShader>("HomogeneousVolume", {{"anisotropy", g}}); }

TEST(HomogeneousVolume, PhaseFunctionIsNormalisedWithItsMeanCosine) {
  const Vector3 out = normalize(Vector3{0.3f, -0.5f, 0.8f});
  for (const double g : anisotropies) {
    const Ref<VolumeShader> m = medium(g);
    const auto phase = [&](const Vector3& in) { return double(m->phase({}, out, in)); };
    const Vector3 peak = g < 0 ? out : -out;
    const std::vector<double> borders{0, 1e-4, 1e-3, 1e-2, 0.1, 2};
    EXPECT_NEAR(integrate_around(peak, borders, phase, 1000, 2), 1, 1e-4) << g;
    const double mean =
        integrate_around(peak, borders, [&](const Vector3& in) { return phase(in) * -double(dot(in, out)); }, 1000, 2);
    EXPECT_NEAR(mean, g, 1e-4);
    // Henyey & Greenstein's formula, straight on and at right angles.
    EXPECT_NEAR(phase(-out), (1 - g * g) / (4 * M_PI * std::pow(1 - g, 3)), 1e-4 * phase(-out));
    const Vector3 across = Frame(Normal3(out)).s;
    EXPECT_NEAR(phase(across), (1 - g * g) / (4 * M_PI * std::pow(1 + g * g, 1.5)), 1e-4 * phase(across));
    EXPECT_NEAR(double(m->phase({}, across, out)), phase(across), 1e-4 * phase(across));
  }
}

TEST(HomogeneousVolume, SamplesFollowThePhaseFunction) {
  constexpr int rows = 40, columns = 12, count = 100000;
  std::uint32_t seed = 70;
  for (const double g : anisotropies) {
    const Ref<VolumeShader> m = medium(g);
    const Vector3 out = normalize(Vector3{-0.2f, 0.9f, 0.1f}), peak = g < 0 ? out : -out;
    // Rows of equal probability, by Henyey and Greenstein's distribution of 1 - cos to the peak.
    const double a = std::abs(g);
    const auto below = [&](double h) {
      return a < 1e-3 ? h / 2 : (1 - a * a) / (2 * a) * (1 / (1 - a) - 1 / std::sqrt((1 - a) * (1 - a) + 2 * a * h));
    };
    const std::vector<double> expected(size_t(rows * columns), double(count) / (rows * columns));
    std::vector<double> counts(expected.size());
    const Frame frame{Normal3(peak)};
    Random random(seed++);
    double cosines = 0, squares = 0;
    for (int i = 0; i < count; ++i) {
      float density = 0;
      const Vector3 in = m->sample_phase({}, out, random.pair(), density);
      ASSERT_NEAR(length(in), 1, 1e-5f);
      EXPECT_NEAR(density, m->phase({}, out, in), 1e-3f * density);
      const Vector3 v = frame.to_local(in);
      const double h = double(length_squared(in - peak)) / 2, cosine = -double(dot(in, out));
      const int row = std::min(int(below(h) * rows), rows - 1);
      const int column = std::min(int((std::atan2(double(v.y), double(v.x)) / (2 * M_PI) + 0.5) * columns), columns - 1);
      ++counts[size_t(row * columns + column)];
      cosines += cosine / count;
      squares += cosine * cosine / count;
    }
    EXPECT_GT(chi_square(counts, expected), each_of(int(std::size(anisotropies)))) << g;
    // 3.8 standard errors: significance 1e-3 over all cases together.
    EXPECT_NEAR(cosines, g, 3.8 * std::sqrt((squares - cosines * cosines) / count)) << g;
  }
}

TEST(HomogeneousVolume, AVeryNarrowPeakStaysExact) {
  const Ref<VolumeShader> m = medium(0.9999);
  Random random(4);
  int near = 0;
  for (int i = 0; i < 1000; ++i) {
    float density = 0;
    const Vector3 out = random.direction(), in = m->sample_phase({}, out, random.pair(), density);
    EXPECT_NEAR(density, m->phase({}, out, in), 2e-2f * density);
    near += length(in + out) < 3e-4f;
  }
  EXPECT_GT(near, 500);  // P = 0.68 for sin(theta) up to 3 (1 - g)
}

TEST(HomogeneousVolume, CoefficientsPerWavelength) {
  const Ref<VolumeShader> m = prepared_as<VolumeShader>(
      "HomogeneousVolume { absorption: 2.5, scattering: blackbody(3000 K), emission: blackbody(2856 K) }");
  const Wavelengths w = wavelengths();
  const VolumeCoefficients c = m->coefficients({1, 2, 3}, 0.5f, w);
  const Color scattering = blackbody_spectrum(3000), emission = blackbody_spectrum(2856);
  for (int i = 0; i < spectrum_size; ++i) {
    EXPECT_EQ(c.absorption[i], 2.5f);
    EXPECT_FLOAT_EQ(c.scattering[i], scattering->evaluate(w, ColorUse::coefficient)[i]);
    EXPECT_FLOAT_EQ(c.emission[i], emission->evaluate(w, ColorUse::radiance)[i]);
    EXPECT_FLOAT_EQ(m->majorant(w)[i], c.extinction()[i]);
  }
  EXPECT_TRUE(m->homogeneous());
  EXPECT_TRUE(m->emits());
  EXPECT_FALSE(medium(0)->emits());
  EXPECT_TRUE(medium(0)->coefficients({}, 0, w).emission.black());
}

TEST(HomogeneousVolume, RefusesWhatCannotBe) {
  expect_refused("HomogeneousVolume { absorption: -1 }", "absorption", "negative");
  expect_refused("HomogeneousVolume { scattering: -0.5 }", "scattering", "negative");
  expect_refused("HomogeneousVolume { emission: -1 }", "emission", "negative");
  expect_refused("HomogeneousVolume { absorption: metal(\"Au\") }", "absorption", "complex");
  expect_refused("HomogeneousVolume { anisotropy: 1 }", "anisotropy", "both excluded");
  expect_refused("HomogeneousVolume { anisotropy: -1 }", "anisotropy", "both excluded");
  EXPECT_THROW(parse_component("HomogeneousVolume { anisotropy: 1.5 }"), Errors);
}

// ---- PassThrough ----------------------------------------------------------------------------------------------------

TEST(PassThrough, EverythingGoesStraightOn) {
  const Ref<Shader> shader = create<Shader>("PassThrough");
  EXPECT_TRUE(shader->transmits());
  EXPECT_EQ(shader->possible_lobes(), Lobes(pass_through));
  EXPECT_EQ(shader->interior_index(wavelengths())[0], 1);
  // The shading normal disagrees with the surface from many of these directions: nothing may be lost there.
  const SurfacePoint p = surface_point({0.1f, 0.2f, 1}, {0.9f, 0.1f, 0.3f});
  Random random(6);
  for (int i = 0; i < 1000; ++i) {
    Arena arena;
    const Scatter* scatter = shader->bind(p, wavelengths(), arena);
    ASSERT_NE(scatter, nullptr);
    const Vector3 out = random.direction();
    for (const Transport transport : {Transport::radiance, Transport::importance}) {
      const auto s = scatter->sample(out, random(), random.pair(), transport);
      ASSERT_TRUE(s.has_value());
      EXPECT_LT(length(s->direction + out), 1e-6f);
      EXPECT_EQ(s->lobe, pass_through);
      EXPECT_TRUE(s->specular());
      EXPECT_TRUE(s->transmitted());
      EXPECT_EQ(s->density, 1);
      EXPECT_EQ(s->eta, 1);
      EXPECT_FALSE(s->dispersive);
      for (int k = 0; k < spectrum_size; ++k) EXPECT_NEAR(s->weight[k], 1, 1e-6f / std::abs(dot(p.normal, out)));
      EXPECT_TRUE(scatter->evaluate(out, -out, transport).black());
      EXPECT_EQ(scatter->density(out, -out, transport), 0);
    }
    EXPECT_EQ(scatter->albedo(out)[0], 1);
    EXPECT_TRUE(scatter->albedo(out, smooth_lobes).black());
    EXPECT_FALSE(scatter->sample(out, 0.5f, random.pair(), Transport::radiance, smooth_lobes).has_value());
  }
}

// ---- rendered: closed forms, to 0.5 % and 4.5 standard errors -----------------------------------------------------------

void expect_value(const Measured& m, double expected, double tolerance = 0.005) {
  EXPECT_EQ(m.bad, 0u);
  EXPECT_NEAR(m.mean.y, expected, tolerance * expected) << "standard error " << m.error;
  EXPECT_NEAR(m.mean.y, expected, 4.5 * m.error + 2e-4 * expected);
}
std::string path_tracer(int depth, int samples) {
  return "PathTracer { max_depth: " + std::to_string(depth) + ", samples: " + std::to_string(samples) + " }";
}
const char* const plane =
    "Rectangle { corner: [-9,-9,0], edge_u: [18,0,0], edge_v: [0,18,0], shader: Lambertian { color: 0.5 } }\n";
const char* const from_above = "PerspectiveCamera { from: [0, 0.3, 3], to: [0,0,0], up: [0,1,0], fov: 0.01 deg }";

TEST(ClosedFormLuminaires, PointInAnIntegratingSphere) {  // L = (I / R^2) (rho / pi) / (1 - rho), I = pi
  const char* const camera = "PerspectiveCamera { from: [0.3, 0.1, 0.2], to: [0, 0, 1], fov: 90 }";
  const std::string sphere = "Sphere { radius: 1, shader: Lambertian { color: 0.5 } }\n";
  for (const char* emission : {"DiffuseEmission { radiance: 3.14159265 }", "DiffuseEmission { power: 18555.42 W }"})
    expect_value(measure(job_text(path_tracer(1000, 64), camera, 16, sphere + "Point { emission: " + emission + " }")), 1);
}

TEST(ClosedFormLuminaires, PlaneUnderDistantLight) {  // L = rho E / pi
  expect_value(measure(job_text(path_tracer(4, 64), from_above, 8,
                                plane + std::string("Distant { direction: [0,0,-2], emission: DiffuseEmission {} }"))),
               0.159155);
  // From 60 degrees, by its own direction and turned there.
  for (const char* sun : {"Distant { direction: [0.8660254, 0, -0.5], emission: DiffuseEmission {} }",
                          "Distant { transform: rotate(30 deg, [1,0,0]), emission: DiffuseEmission {} }"})
    expect_value(measure(job_text(path_tracer(4, 64), from_above, 8, std::string(plane) + sun)), 0.159155 / 2);
}

TEST(ClosedFormLuminaires, LambertSphereAtPhaseAngles) {  // (2/3) [sin a + (pi - a) cos a] / pi, over a picture of 4 R^2
  const std::pair<double, double> phases[] = {{0, 0.666667}, {45, 0.503606}, {90, 0.212207}, {135, 0.032202}};
  for (const auto& [angle, expected] : phases) {
    const double a = angle * M_PI / 180;
    const std::string objects = "Sphere { radius: 1, shader: Lambertian { color: 1 } }\nDistant { direction: [" +
                                std::to_string(-std::sin(a)) + ", 0, " + std::to_string(-std::cos(a)) +
                                "], emission: DiffuseEmission {} }";
    expect_value(measure(job_text(path_tracer(4, 64),
                                  "OrthographicCamera { from: [0,0,5], to: [0,0,0], up: [0,1,0], width: 2 }", 64, objects)),
                 expected / 4);
  }
}

TEST(ClosedFormLuminaires, IrradianceOfASpotlight) {  // E = I cos / d^2, full inside, half of it half way
  const std::string inside = "Point { position: [0,1,2], emission: SpotEmission { radiance: 5, axis: [0,-1,-2] } }";
  const double e = 5 * (2 / std::sqrt(5.0)) / 5;
  expect_value(measure(job_text(path_tracer(2, 64), from_above, 4, plane + inside)), 0.5 * e / M_PI);
  // 1 W in a cone of 20 and 30 degrees: I = 1 / (Omega 470) per nm.
  const std::string strong = "Point { position: [0,0,2], emission: SpotEmission { power: 470 W, axis: [0,0,-1] } }";
  const double intensity = 1 / (M_PI * (one_minus_cosine(20) + one_minus_cosine(30)));
  expect_value(measure(job_text(path_tracer(2, 64), from_above, 4, plane + strong)), 0.5 * intensity / 4 / M_PI);
  const double cosine = (std::cos(20 * M_PI / 180) + std::cos(30 * M_PI / 180)) / 2;
  const std::string half = "Point { position: [0,0,2], emission: SpotEmission { radiance: 5, axis: [" +
                           std::to_string(std::sqrt(1 - cosine * cosine)) + ", 0, " + std::to_string(-cosine) + "] } }";
  expect_value(measure(job_text(path_tracer(2, 64), from_above, 4, plane + half)), 0.5 * 2.5 / 4 / M_PI);
}

TEST(ClosedFormLuminaires, SunWithASoftEdgeOnAnEnvironment) {  // E = L Omega, straight from above
  const std::string sun =
      "Environment { emission: SpotEmission { radiance: 10000, inner_angle: 0.2, outer_angle: 0.3, axis: [0,0,-1] } }";
  const double omega = M_PI * (one_minus_cosine(0.2) + one_minus_cosine(0.3));
  expect_value(measure(job_text(path_tracer(2, 64), from_above, 8, plane + sun)), 0.5 * 1e4 * omega / M_PI);
}

TEST(ClosedFormLuminaires, LightSeenThroughABoundaryThatIsNotThere) {
  const std::string objects =
      "Rectangle { corner: [-9,-9,-5], edge_u: [18,0,0], edge_v: [0,18,0], emission: DiffuseEmission { radiance: 2 } }\n"
      "Sphere { radius: 1, shader: PassThrough {} }";
  expect_value(measure(job_text(path_tracer(8, 16), "OrthographicCamera { from: [0,0,5], to: [0,0,0], up: [0,1,0], width: 2 }",
                                16, objects)),
               2);
}

}  // namespace
}  // namespace etendue::test
