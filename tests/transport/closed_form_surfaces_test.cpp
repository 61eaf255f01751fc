// Surfaces that light each other, with a known answer, by every renderer that can find all of their light.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/closed_form_rows.h"

namespace etendue::closed_form {
namespace {

/// The mean of f over the square of half width h around the origin.
template <class F>
double mean_over_square(double h, const F& f) {
  constexpr int steps = 200;
  double sum = 0;
  for (int i = 0; i < steps; ++i)
    for (int k = 0; k < steps; ++k) sum += f(h * ((2 * i + 1.0) / steps - 1), h * ((2 * k + 1.0) / steps - 1));
  return sum / (steps * steps);
}

/// Irradiance by a rectangle a x b of radiance 1, parallel to the receiver at height 1, at the point under one of its corners.
double irradiance_at_corner(double a, double b) {
  const double p = std::sqrt(1 + a * a), q = std::sqrt(1 + b * b);
  return 0.5 * (a / p * std::atan(b / p) + b / q * std::atan(a / q));
}

/// The mean of the irradiance by a square of radiance 1 and half width 1 at height 1, divided by pi, over the square of half
/// width 0.5 under its middle.
double square_under_a_rectangle() {
  return mean_over_square(0.5, [](double x, double y) {
    double e = 0;
    for (const double sx : {-1.0, 1.0})
      for (const double sy : {-1.0, 1.0}) e += irradiance_at_corner(1 + sx * x, 1 + sy * y);
    return e / exact_pi;
  });
}

/// Irradiance of the plane through the centre of a sphere of radius 1 and radiance 1, at the distance r: row 9.
double irradiance_beside_sphere(double r) { return std::atan(1 / std::sqrt(r * r - 1)) - std::sqrt(r * r - 1) / (r * r); }

/// The mean of that, divided by pi, over the square of half width 3, with the sphere itself (which a camera above sees with
/// radiance 1). With u = sqrt(r^2 - 1), r dr = u du.
double sphere_on_a_floor() {
  constexpr int steps = 400;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double phi = (i + 0.5) / steps * exact_pi / 4, end = std::sqrt(std::pow(3 / std::cos(phi), 2) - 1);
    for (int k = 0; k < steps; ++k) {
      const double u = (k + 0.5) / steps * end;
      sum += irradiance_beside_sphere(std::sqrt(1 + u * u)) * u * end;
    }
  }
  return (8 * sum * exact_pi / 4 / (steps * steps) / exact_pi + exact_pi) / 36;
}

std::vector<Row> surface_rows() {
  const std::string inside = "PerspectiveCamera { from: [0.3, 0.1, 0.2], to: [0, 0, 1], fov: 90 }";
  const std::string box = R"(TriangleMesh {
      positions: [[-1,-1,-1],[1,-1,-1],[1,1,-1],[-1,1,-1],[-1,-1,1],[1,-1,1],[1,1,1],[-1,1,1]]
      triangles: [[0,1,2],[0,2,3],[4,6,5],[4,7,6],[0,4,5],[0,5,1],[1,5,6],[1,6,2],[2,6,7],[2,7,3],[3,7,4],[3,4,0]]
      shader: Lambertian { color: 0.8 }, emission: )" +
                          glow + " }";
  const std::string endless = "max_depth: 10000", nine = "max_depth: 9", two = "max_depth: 2";
  struct Samples {
    int path, directions, bidirectional, balance, light, distribution, direct, whitted;
  };
  const auto all = [&](const Samples& n) {
    std::vector<Way> ways = {{"PathTracer", two, n.path},
                             {"PathTracer", two + ", next_event: false", n.directions},
                             {"BidirectionalPathTracer", two, n.bidirectional},
                             {"BidirectionalPathTracer", two + ", heuristic: balance", n.balance},
                             {"LightTracer", two, n.light},
                             {"DistributionRenderer", two, n.distribution},
                             {"DirectRenderer", "", n.direct},
                             {"WhittedRenderer", "", n.whitted}};
    std::erase_if(ways, [](const Way& w) { return w.samples == 0; });
    return ways;
  };
  std::vector<Row> rows;

  rows.push_back({"R01_Furnace",
                  inside,
                  "Sphere { radius: 1, shader: Lambertian { color: 0.8 }, emission: DiffuseEmission { radiance: 1, sides: "
                  "back } }",
                  5,
                  {{"PathTracer", endless, 32},
                   {"BidirectionalPathTracer", endless, 8},
                   {"BidirectionalPathTracer", endless + ", heuristic: balance", 8},
                   {"LightTracer", endless, 96},
                   {"DistributionRenderer", endless, 16}}});
  rows.push_back({"R02_FurnaceOfNine",
                  inside,
                  box,
                  5 * (1 - std::pow(0.8, 9)),
                  {{"PathTracer", nine, 8},
                   {"BidirectionalPathTracer", nine, 8},
                   {"LightTracer", nine, 256},
                   {"DistributionRenderer", nine, 4}}});
  rows.push_back({"R02_FurnaceOfTwo", inside, box, 1.8, all({8, 8, 8, 8, 288, 4, 8, 0})});

  const std::string middle =
                        "Point { emission: DiffuseEmission { radiance: 3.14159265 } }\nSphere { radius: 1, shader: Lambertian "
                        "{ color: 0.5 } }",
                    aside = "PerspectiveCamera { from: [0, 0, -0.3], to: [0, 0, -1], fov: 80 }";
  rows.push_back({"R03_PointInSphere",
                  aside,
                  middle,
                  1,
                  {{"PathTracer", endless, 8},
                   {"BidirectionalPathTracer", endless, 4},
                   {"LightTracer", endless, 128},
                   {"DistributionRenderer", endless, 4}}});
  rows.push_back({"R03_PointInSphereDirectly", aside, middle, 0.5, all({8, 0, 8, 8, 256, 4, 8, 1})});

  const std::string receiver = "Rectangle { corner: [0,0,0], edge_u: [1,0,0], edge_v: [0,1,0], " + diffuse + " }\n";
  rows.push_back({"R04_ParallelSquares", square("[0.5, 0.5, 0.5]", "[0.5, 0.5, 0]", 1),
                  receiver + "Rectangle { corner: [0,0,1], edge_u: [1,0,0], edge_v: [0,1,0], emission: " + glow + " }",
                  0.199825, all({8, 80, 8, 16, 512, 4, 8, 0})});
  rows.push_back({"R05_SquaresAtRightAngles", square("[0.5, 0.5, 5]", "[0.5, 0.5, 0]", 1),
                  receiver + "Rectangle { corner: [0,0,0], edge_u: [0,1,0], edge_v: [0,0,1], emission: " + glow + " }",
                  0.200044, all({8, 64, 8, 24, 512, 4, 8, 0})});
  rows.push_back(
      {"R06_Discs", square("[0, 0, 0.5]", "[0, 0, 0]", 2),  // the image is the square around the disc
       "Disc { radius: 1, " + diffuse + " }\nDisc { radius: 1, transform: translate(0, 0, 1), emission: " + glow + " }",
       0.381966 * exact_pi / 4, all({16, 128, 16, 16, 160, 8, 16, 0})});

  rows.push_back({"R07_Rectangle", pinhole("[0, 0, 0.5]", "[0, 0, 0]"), plate(9, 0, diffuse) + plate(1, 1, "emission: " + glow),
                  1.740840 / exact_pi, all({8, 32, 8, 8, 0, 4, 8, 0})});
  rows.push_back({"R07_RectangleOverASquare", square("[0, 0, 0.5]", "[0, 0, 0]", 1),
                  plate(0.5, 0, diffuse) + plate(1, 1, "emission: " + glow), square_under_a_rectangle,
                  all({8, 48, 8, 8, 768, 4, 8, 0})});

  rows.push_back({"R08_Sphere", pinhole("[0, 0.2, 0.5]", "[0, 0, 0]"),
                  plate(1, 0, diffuse) + "Sphere { centre: [0, 0, 3], radius: 1, emission: " + glow + " }", 0.349066 / exact_pi,
                  all({8, 0, 8, 8, 0, 4, 8, 0})});
  // On a shell around the sphere the irradiance is that of the row everywhere.
  rows.push_back({"R08_SphereInAShell", "PerspectiveCamera { from: [0, 0, 1.2], to: [0, 0, 3], fov: 120 }",
                  "Sphere { radius: 3, " + diffuse + " }\nSphere { radius: 1, emission: DiffuseEmission { radiance: 1 } }",
                  1.0 / 9, all({8, 256, 8, 12, 512, 4, 8, 0})});
  rows.push_back({"R09_HalfASphere", pinhole("[0, 0.2, 0.5]", "[0, 0, 0]"),
                  "Disc { radius: 0.1, " + diffuse + " }\nSphere { centre: [3, 0, 0], radius: 1, emission: " + glow + " }",
                  irradiance_beside_sphere(3) / exact_pi, all({32, 0, 32, 32, 0, 24, 32, 0})});
  rows.push_back({"R09_HalfASphereOverASquare", square("[0, 0, 5]", "[0, 0, 0]", 6),
                  plate(3, 0, diffuse) + "Sphere { radius: 1, emission: DiffuseEmission { radiance: 1 } }", sphere_on_a_floor,
                  all({24, 128, 32, 32, 64, 16, 24, 0})});

  // Inclined by 60 degrees, so that an irradiance of 2 perpendicular to the light is 1 on the plane.
  rows.push_back({"R10_Sun", square("[0, 0, 5]", "[0, 0, 0]", 1.4),
                  plate(0.75, 0, "shader: Lambertian { color: 0.5 }") +
                      "Distant { direction: [0.8660254, 0, -0.5], emission: DiffuseEmission { radiance: 2 } }",
                  0.5 / exact_pi, all({8, 0, 8, 12, 192, 4, 8, 1})});
  const std::pair<int, Samples> phases[] = {{0, {8, 0, 8, 12, 40, 4, 8, 2}},
                                            {45, {8, 0, 8, 16, 64, 4, 8, 4}},
                                            {90, {8, 0, 24, 28, 128, 24, 8, 28}},
                                            {135, {64, 0, 96, 96, 384, 64, 64, 64}}};
  for (const auto& [degrees, samples] : phases) {
    const double a = degrees * exact_pi / 180, intensity = 2.0 / 3 * (std::sin(a) + (exact_pi - a) * std::cos(a)) / exact_pi;
    rows.push_back({fmt::format("R11_SphereAtPhase{}", degrees), square("[0, 0, 5]", "[0, 0, 0]", 2),
                    fmt::format("Sphere {{ radius: 1, {} }}\nDistant {{ direction: [{:.9f}, 0, {:.9f}], emission: {} }}",
                                diffuse, -std::sin(a), -std::cos(a), glow),
                    intensity / 4, all(samples)});
  }

  // A black disc closes off a cap of f = 2 % of the sphere's wall; between other points of the wall light travels as without
  // it. A point light in the centre emits 1 W, of which 1 - f arrives at the wall, uniformly: the white wall's radiance is rho
  // / (pi A (1 - f)) * (1 - f) * (1 + rho (1 - f) + ...) = rho / (pi A (1 - rho (1 - f))).
  const std::string port =
      "Point { emission: DiffuseEmission { radiance: 0.0795774715 } }\nSphere { radius: 1, shader: "
      "Lambertian { color: 0.98 } }\nDisc { radius: 0.3, transform: translate(0, 0, 0.96) }";
  rows.push_back({"R13_IntegratingSphere",
                  aside,
                  port,
                  0.626861,
                  {{"PathTracer", endless, 48},
                   {"LightTracer", endless, 64},
                   {"DistributionRenderer", endless + ", light_samples: 1, diffuse_samples: 1", 64}}});
  // Limited to twelve segments: with some 25 bounces, each connected to each, BidirectionalPathTracer would take a minute.
  rows.push_back({"R13_IntegratingSphereOfTwelve",
                  aside,
                  port,
                  0.626861 * (1 - std::pow(0.98 * 0.98, 11)),
                  {{"PathTracer", "max_depth: 12", 16},
                   {"BidirectionalPathTracer", "max_depth: 12", 8},
                   {"LightTracer", "max_depth: 12", 96},
                   {"DistributionRenderer", "max_depth: 12", 4}}});
  return rows;
}

class Surfaces : public testing::TestWithParam<Case> {};
TEST_P(Surfaces, HaveTheirClosedForm) { expect_row(GetParam()); }
INSTANTIATE_TEST_SUITE_P(Rows, Surfaces, testing::ValuesIn(cases(surface_rows())), case_name);

}  // namespace
}  // namespace etendue::closed_form
