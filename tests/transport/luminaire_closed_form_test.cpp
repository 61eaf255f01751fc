// Delta luminaires and spotlights, rendered: closed forms, to 0.5 % and 4.5 standard errors.

#include <gtest/gtest.h>

#include "support/luminaire_test_support.h"
#include "support/render_support.h"

namespace etendue::test {
namespace {

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
  // From 60 degrees, by its direction or by a rotation.
  for (const char* sun : {"Distant { direction: [0.8660254, 0, -0.5], emission: DiffuseEmission {} }",
                          "Distant { transform: rotate(30 deg, [1,0,0]), emission: DiffuseEmission {} }"})
    expect_value(measure(job_text(path_tracer(4, 64), from_above, 8, std::string(plane) + sun)), 0.159155 / 2);
}

TEST(ClosedFormLuminaires, LambertSphereAtPhaseAngles) {  // (2/3) [sin a + (pi - a) cos a] / pi, over an image of 4 R^2
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

TEST(ClosedFormLuminaires, IrradianceOfASpotlight) {  // E = I cos / d^2; half of it halfway through the penumbra
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

// A sphere each of whose points emits radiance 1 within 80 degrees of +z, seen from there: a disc of radiance 1, pi/4 of the
// image. At most points, most of these directions lead into the sphere, and the points are seen all the same.
TEST(ClosedFormLuminaires, WhereNoLightLeavesInMostDirections) {
  const char* const ball =
      "Sphere { emission: SpotEmission { axis: [0,0,1], inner_angle: 80 deg, outer_angle: 80 deg, radiance: 1 } }";
  const char* const camera = "OrthographicCamera { from: [0,0,5], to: [0,0,0], up: [0,1,0], width: 2 }";
  for (const char* renderer :
       {"PathTracer { samples: 64 }", "LightTracer { samples: 2048 }", "BidirectionalPathTracer { samples: 64 }"})
    expect_value(measure(job_text(renderer, camera, 16, ball)), M_PI / 4, 0.01);
}

}  // namespace
}  // namespace etendue::test
