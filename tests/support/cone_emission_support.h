#pragma once
// Checks of spots, which all edges of their cones must pass.

#include <gtest/gtest.h>

#include "support/luminaire_test_support.h"

namespace etendue::test {

struct Cone {
  double inner, outer;         ///< [deg]
  std::string_view edge = "";  ///< of a ForeignSpotEmission; "": the cone is a SpotEmission's
};

inline std::string spot(const Cone& c, const std::string& more = "") {
  const std::string angles = "inner_angle: " + std::to_string(c.inner) + ", outer_angle: " + std::to_string(c.outer);
  if (c.edge.empty()) return "SpotEmission { " + angles + more + " }";
  return "ForeignSpotEmission { " + angles + ", edge: " + std::string(c.edge) + more + " }";
}

/// `solid_angle`: the integral of the profile over all directions.
inline void expect_power_over_all_directions(const Cone& c, double solid_angle) {
  const Wavelengths w = wavelengths();
  // The cone of a stretched object stays round, about the stretched axis.
  const Transform placement =
      Transform::translate({1, 2, 3}) * Transform::rotate(1, {1, 2, 3}) * Transform::scale({1, 3, 0.5f});
  for (const double watts : {0.0, 60.0}) {
    const Ref<SceneObject> lamp = prepared_as<SceneObject>(
        "Point { emission: " + spot(c, ", axis: [1, -2, 0.5], radiance: 2, power: " + std::to_string(watts)) + " }");
    lamp->transform = placement;
    const SurfacePoint p = lamp->sample_area({}, 0).point;
    const Vector3 axis = normalize(placement(Vector3{1, -2, 0.5f}));
    const double emitted = integrate_around(axis, {0, one_minus_cosine(c.inner), one_minus_cosine(c.outer), 2},
                                            [&](const Vector3& d) { return double(lamp->emission->radiance(p, d, w)[0]); });
    const double power = double(lamp->emission->power(*lamp, w)[0]);
    EXPECT_NEAR(power, emitted, 2e-3 * emitted) << c.edge << " " << c.inner << " " << c.outer << " " << watts;
    EXPECT_NEAR(power, watts > 0 ? watts / 470 : 2 * solid_angle, 1e-5 * power);
  }
}

/// Checks that the pdf integrates to 1, and that samples follow it with a significance.
inline void expect_samples_follow_density(const Cone& c, std::uint32_t seed, double significance) {
  constexpr int rows = 60, columns = 8, count = 40000;
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
  Random random(seed);
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
  EXPECT_GT(chi_square(counts, expected), significance) << c.edge << " " << c.inner << " " << c.outer;
}

}  // namespace etendue::test
