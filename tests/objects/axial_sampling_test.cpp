// Cylinders, cones, tubes and other surfaces around an axis, sampled by the solid angle under which they are seen.

#include "support/geometry_support.h"

namespace etendue {
namespace {

using namespace geometry_test;

struct Solid {
  std::string name;
  std::vector<Setting> settings;
};

const Solid cylinder{"Cylinder", {{"radius", 0.5}, {"height", 2}}};
const Solid open_cylinder{"Cylinder", {{"radius", 0.5}, {"height", 2}, {"caps", false}}};
const Solid tube{"Tube", {{"inner_radius", 0.3}, {"radius", 0.5}, {"height", 2}}};
const std::vector<Solid> solids{cylinder,
                                open_cylinder,
                                tube,
                                {"Cylinder", {{"radius", 1}, {"height", 0.05}}},
                                {"Cone", {{"radius", 0.5}, {"height", 1}}},
                                {"Cone", {{"radius", 0.2}, {"top_radius", 0.5}, {"height", 1}}},
                                {"Paraboloid", {{"radius", 0.5}, {"height", 1}}}};

/// The mean of 1 / pdf over samples of the visible surface (0 for samples that fail), which estimates the solid angle; and the
/// number of valid samples.
struct Seen {
  Mean solid_angle;
  double squares = 0;
  int found = 0;
  static constexpr int samples = 4000;

  Seen(const SceneObject& o, const Point3& from, float time = 0) {
    Random random(7);
    for (int i = 0; i < samples; ++i) {
      const SurfaceSample s = o.sample_visible(from, random.pair(), time);
      const double value = s.pdf > 0 ? 1 / double(s.pdf) : 0;
      solid_angle.add(value);
      squares += value * value / samples;
      found += s.pdf > 0;
      if (s.pdf > 0) {
        EXPECT_EQ(o.visible_pdf(from, s.direction, s.point), s.pdf);
      }
    }
  }
  /// The relative standard deviation of one sample.
  double deviation() const { return std::sqrt(std::max(0.0, squares / (solid_angle.value() * solid_angle.value()) - 1)); }
};

TEST(AxialSampling, SolidAnglesAreThoseOfClosedForms) {
  // A cap seen from the axis at a height c above it: 2 pi (1 - c / sqrt(c^2 + r^2)). A long cylinder at a distance d from the
  // axis: nearly 2 * 2 asin(r / d). From afar: the area of the silhouette over the squared distance. Tolerance: 5 standard
  // errors, and the part that is missing at the ends.
  const auto closed = object("Cylinder", {{"radius", 0.5}, {"height", 2}});
  for (const float c : {0.01f, 0.5f, 30.0f}) {
    const Seen seen(*closed, {0, 0, 1 + c});
    const double expected = 2 * M_PI * 0.25 / (std::hypot(double(c), 0.5) * (std::hypot(double(c), 0.5) + double(c)));
    EXPECT_NEAR(seen.solid_angle.value(), expected, 5 * seen.solid_angle.error() + 1e-5 * expected) << c;
  }
  const auto rod = object("Cylinder", {{"radius", 0.5}, {"height", 2000}});
  for (const float d : {0.501f, 0.7f, 3.0f}) {
    const Seen seen(*rod, {0, d, 10});
    EXPECT_NEAR(seen.solid_angle.value(), 4 * std::asin(0.5 / double(d)), 5 * seen.solid_angle.error() + 1e-4) << d;
    EXPECT_LT(seen.deviation(), 0.02) << d;
  }
  const Seen far(*closed, {3e4f, 0, 0});
  EXPECT_NEAR(far.solid_angle.value() * 9e8, 2, 1e-3);
  EXPECT_LT(far.deviation(), 0.01);
}

TEST(AxialSampling, RaysSeeWhatIsSampled) {
  // The solid angle found by uniform rays equals that of the samples: from afar, close to the side and above, looking through,
  // in a bore, right beside a tip; moving and stretched. 5 standard errors.
  const AnimatedTransform moving(
      {{0, Transform::scale({1.5f, 0.7f, 1})}, {1, Transform::translate({0.5f, 0, 0}) * Transform::rotate(1, {0, 1, 1})}});
  for (const Solid& solid : solids) {
    const auto o = object(solid.name, solid.settings, moving);
    const float time = 0.3f;
    for (const Point3 own : {Point3{2, 1, 0.3f},
                             {0.51f, 0, 0.1f},
                             {0.4f, 0.1f, 1.1f},
                             {0.1f, 0, 2},
                             {1, 0.5f, -1.5f},
                             {0.2f, 0.1f, 0.95f},
                             {0.1f, 0.1f, 0.2f}}) {
      SCOPED_TRACE(solid.name + " from " + std::to_string(own.x) + " " + std::to_string(own.z));
      const Point3 from = moving.at(time)(own);
      const Seen seen(*o, from, time);
      Mean rays;
      Random random(8);
      for (int i = 0; i < 4000; ++i) rays.add(o->occludes(ray(from, random.direction(), time)) ? 4 * M_PI : 0);
      EXPECT_NEAR(rays.value(), seen.solid_angle.value(), 5 * (rays.error() + seen.solid_angle.error()) + 1e-5);
    }
  }
}

TEST(AxialSampling, LittleIsLostAndDensitiesAreEven) {
  // From places where points sampled by area would have a large variance: the relative standard deviation of 1 / pdf.
  for (const Solid& solid : solids) {
    const auto o = object(solid.name, solid.settings);
    for (const Point3 from : {Point3{2, 1, 0.3f}, {0.51f, 0, 0.1f}, {1.01f, 0, 0}, {0.4f, 0.1f, 1.1f}, {1, 0.5f, -1.5f}}) {
      SCOPED_TRACE(solid.name + " from " + std::to_string(from.x) + " " + std::to_string(from.z));
      const Seen seen(*o, from);
      if (o->closed()) {
        EXPECT_GT(seen.found, 0.999 * Seen::samples);
      }
      EXPECT_LT(seen.deviation(), 0.5);
    }
  }
}

}  // namespace
}  // namespace etendue
