// The delta lights Point and Distant. Statistical tests have fixed seeds and a significance of 1e-3 over all their cases
// together.

#include <gtest/gtest.h>

#include "etendue/describe/color.h"
#include "etendue/infinite_object.h"
#include "etendue/object_map.h"
#include "support/luminaire_test_support.h"

namespace etendue::test {
namespace {

// ---- Point ----------------------------------------------------------------------------------------------------------

TEST(Point, IsFoundWhereItIs) {
  const Ref<SceneObject> point = prepared_as<SceneObject>("Point { position: [1, 2, 3] }");
  EXPECT_TRUE(point->delta());
  EXPECT_FALSE(point->infinite());
  EXPECT_TRUE(point->bounds().empty());
  EXPECT_EQ(point->area(0), 4);
  point->transform = Transform::translate({0, 0, 1}) * Transform::scale({2, 2, 2});
  prepare_tree(*point);
  const SurfaceSample a = point->sample_area({0.3f, 0.6f}, 0.25f);
  EXPECT_EQ(a.pdf, 1);
  EXPECT_TRUE(a.delta);
  EXPECT_FALSE(a.infinite);
  EXPECT_EQ(a.point.position, (Point3{2, 4, 7}));
  EXPECT_EQ(a.point.object_position, (Point3{1, 2, 3}));
  EXPECT_EQ(a.point.normal, Normal3{});
  EXPECT_EQ(a.point.shading_normal, Normal3{});
  EXPECT_EQ(a.point.error, 0);
  EXPECT_EQ(a.point.object, point.get());
  EXPECT_EQ(a.point.time, 0.25f);
  EXPECT_EQ(point->area_pdf(a.point), 1);

  const SurfaceSample s = point->sample_visible({2, 1, 3}, {0.3f, 0.6f}, 0);
  EXPECT_TRUE(s.delta);
  EXPECT_FLOAT_EQ(s.pdf, 25);
  EXPECT_FLOAT_EQ(s.distance, 5);
  expect_near(s.direction, {0, 0.6f, 0.8f});
  EXPECT_EQ(s.point.position, (Point3{2, 4, 7}));
  EXPECT_EQ(point->visible_pdf({2, 1, 3}, s.direction, s.point), 0);
  EXPECT_EQ(point->sample_visible({2, 4, 7}, {0.3f, 0.6f}, 0).pdf, 0);

  point->transform = motion(Transform(), Transform::translate({4, 0, 0}));
  prepare_tree(*point);
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
  EXPECT_EQ(sun->sample_area({0.5f, 0.5f}, 0).pdf, 0);
  dynamic_cast<InfiniteObject&>(*sun).enclose({1, 1, 1}, 3);
  EXPECT_FLOAT_EQ(sun->area(0), 9);
  const Point3 from{2, 0, 1};
  SurfaceSample s = sun->sample_visible(from, {0.1f, 0.2f}, 0.5f);
  EXPECT_EQ(s.pdf, 1);
  EXPECT_TRUE(s.delta && s.infinite);
  EXPECT_EQ(s.distance, infinity);
  expect_near(s.direction, {0, 0.6f, -0.8f});
  EXPECT_EQ(s.point.normal, Normal3{});
  EXPECT_EQ(s.point.shading_normal, Normal3{});
  EXPECT_EQ(s.point.object, sun.get());
  EXPECT_EQ(s.point.time, 0.5f);
  EXPECT_GT(distance(s.point.position, {1, 1, 1}), 3);
  expect_near(normalize(s.point.position - from), s.direction);
  EXPECT_EQ(sun->visible_pdf(from, s.direction, s.point), 0);

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
  dynamic_cast<InfiniteObject&>(*sun).enclose({0, 0, 0}, 3);
  EXPECT_NEAR(double(sun->emission->power(*sun, w)[0]), 2 * M_PI * 9, 1e-4);
  // On the axis of a spot's profile, and within its edge.
  for (const double angle : {0.0, 25.0}) {
    const Ref<SceneObject> beam =
        prepared_as<SceneObject>("Distant { direction: [" + std::to_string(std::sin(angle * M_PI / 180)) + ", 0, " +
                                 std::to_string(std::cos(angle * M_PI / 180)) + "], emission: SpotEmission { radiance: 2 } }");
    dynamic_cast<InfiniteObject&>(*beam).enclose({0, 0, 0}, 3);
    const SurfaceSample s = beam->sample_visible({0.1f, 0.2f, 0.3f}, {}, 0);
    const double irradiance = double(beam->emission->radiance(s.point, -s.direction, w)[0] / s.pdf);
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

}  // namespace
}  // namespace etendue::test
