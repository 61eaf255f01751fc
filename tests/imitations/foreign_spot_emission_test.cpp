// ForeignSpotEmission. Statistical tests have fixed seeds and a significance of 1e-3 over all their cases together.

#include "support/cone_emission_support.h"

namespace etendue::test {
namespace {

constexpr Cone cones[] = {
    {15, 20, "linear"},       {0, 45, "linear"},           {40, 40, "linear"},        {0.05, 0.1, "linear"},
    {60, 130, "linear"},      {0, 180, "linear"},          {1, 2.5, "linear"},        {15, 20, "square"},
    {40, 40, "square"},       {0.05, 0.1, "square"},       {0, 180, "square"},        {15, 20, "quartic"},
    {40, 40, "quartic"},      {0, 180, "quartic"},         {15, 20, "smooth_angle"},  {0, 45, "smooth_angle"},
    {40, 40, "smooth_angle"}, {0.05, 0.1, "smooth_angle"}, {60, 130, "smooth_angle"}, {0, 180, "smooth_angle"}};

/// The integral of the profile over all directions: for a linear edge 2 pi (1 - (sin b - sin a) / (b - a)), integrated by
/// parts; for an edge that is smooth in the angle by the midpoint rule; for the others from the mean over the edge: of t^2 it
/// is 1/3, of t^4 it is 1/5.
double solid_angle(const Cone& c) {
  const double a = c.inner * M_PI / 180, b = c.outer * M_PI / 180;
  const double h = one_minus_cosine(c.inner), beyond = one_minus_cosine(c.outer) - h;
  if (a == b) return 2 * M_PI * h;
  if (c.edge == "smooth_angle") {
    constexpr int n = 20000;
    double sum = 0;
    for (int i = 0; i < n; ++i) {
      const double t = (i + 0.5) / n;
      sum += t * t * (3 - 2 * t) * std::sin(b - t * (b - a)) / n;
    }
    return 2 * M_PI * (h + (b - a) * sum);
  }
  if (c.edge != "linear") return 2 * M_PI * (h + beyond / (c.edge == "square" ? 3 : 5));
  return 2 * M_PI * (1 - (std::sin(b) - std::sin(a)) / (b - a));
}

TEST(ForeignSpotEmission, ALinearEdgeFallsWithTheAngle) {
  const Ref<SceneObject> lamp = prepared_as<SceneObject>(
      "Point { emission: ForeignSpotEmission { radiance: 3, inner_angle: 15, outer_angle: 20, edge: linear } }");
  const SurfacePoint p = lamp->sample_area({}, 0).point;
  for (const double angle : {0.0, 14.99, 15.5, 16.0, 17.5, 19.0, 19.9, 20.01, 100.0}) {
    const double a = angle * M_PI / 180, wanted = 3 * std::clamp((20 - angle) / 5, 0.0, 1.0);
    const Vector3 d{float(std::sin(a) * 0.6), float(std::sin(a) * 0.8), float(std::cos(a))};
    EXPECT_NEAR(double(lamp->emission->radiance(p, d, wavelengths())[0]), wanted, 1e-5) << angle;
  }
}

TEST(ForeignSpotEmission, ASmoothEdgeByTheAngleIsHalfInItsMiddle) {
  const Ref<SceneObject> lamp = prepared_as<SceneObject>(
      "Point { emission: ForeignSpotEmission { radiance: 3, inner_angle: 20, outer_angle: 60, edge: smooth_angle } }");
  const SurfacePoint p = lamp->sample_area({}, 0).point;
  for (const auto& [angle, wanted] :
       {std::pair(19.9, 3.0), {30.0, 3 * 0.84375}, {40.0, 1.5}, {50.0, 3 * 0.15625}, {60.1, 0.0}}) {
    const double a = angle * M_PI / 180;
    EXPECT_NEAR(double(lamp->emission->radiance(p, {0, float(std::sin(a)), float(std::cos(a))}, wavelengths())[0]), wanted,
                1e-4)
        << angle;
  }
}

TEST(ForeignSpotEmission, EdgesFallWithPowers) {
  for (const auto& [edge, power] : {std::pair("square", 2), std::pair("quartic", 4)}) {
    const Ref<SceneObject> lamp = prepared_as<SceneObject>(
        std::string("Point { emission: ForeignSpotEmission { radiance: 3, inner_angle: 10, outer_angle: 60, edge: ") + edge +
        " } }");
    const SurfacePoint p = lamp->sample_area({}, 0).point;
    const double inner = std::cos(10 * M_PI / 180), outer = 0.5;
    for (const double t : {0.0, 0.25, 0.5, 0.9, 1.0}) {
      const double c = outer + t * (inner - outer);
      const Vector3 d{float(std::sqrt(1 - c * c)), 0, float(c)};
      EXPECT_NEAR(double(lamp->emission->radiance(p, d, wavelengths())[0]), 3 * std::pow(t, power), 1e-5) << edge << t;
    }
  }
}

TEST(ForeignSpotEmission, PowerOfAPointIsItsIntensityOverAllDirections) {
  for (const Cone& c : cones) expect_power_over_all_directions(c, solid_angle(c));
}

TEST(ForeignSpotEmission, SamplesFollowDensity) {
  std::uint32_t seed = 57;
  for (const Cone& c : cones) expect_samples_follow_density(c, seed++, each_of(int(std::size(cones))));
}

}  // namespace
}  // namespace etendue::test
