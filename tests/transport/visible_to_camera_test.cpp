// Objects with visible_to_camera: false. Their light, their shadows and their mirror images agree with closed forms, and they
// are not seen themselves, for every renderer.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/closed_form_rows.h"

namespace etendue::closed_form {
namespace {

/// Irradiance at the distance r from the axis of a disc of radius R and radiance 1 that faces the receiver from height h
/// (Howell, "A catalog of radiation heat transfer configuration factors", B-12).
double irradiance_by_disc(double r, double radius, double h) {
  const double a = r * r + h * h, b = radius * radius;
  return exact_pi / 2 * (1 - (a - b) / std::sqrt((a + b) * (a + b) - 4 * b * r * r));
}

/// Its mean over the square of half width `half` around the axis.
double mean_by_disc(double half, double radius, double h) {
  constexpr int steps = 200;
  double sum = 0;
  for (int i = 0; i < steps; ++i)
    for (int k = 0; k < steps; ++k)
      sum += irradiance_by_disc(half * std::hypot((2 * i + 1.0) / steps - 1, (2 * k + 1.0) / steps - 1), radius, h);
  return sum / (steps * steps);
}

/// The radiance of a plate of reflectance 0.5 under such a disc.
double plate_under_the_disc() { return 0.5 / exact_pi * mean_by_disc(0.5, 1, 1); }

std::vector<Row> rows() {
  const std::string unseen = "visible_to_camera: false";
  const std::string disc = "Disc { radius: 1, transform: translate(0, 0, 1), emission: " + glow + ", " + unseen + " }";
  const std::string two = "max_depth: 2", three = "max_depth: 3";
  std::vector<Row> all;

  // An unseen lamp between the camera and a diffuse plate, covering the whole view.
  all.push_back({"DiscBefore",
                 square("[0, 0, 5]", "[0, 0, 0]", 1),
                 plate(4, 0, "shader: Lambertian { color: 0.5 }") + disc,
                 plate_under_the_disc,
                 {{"PathTracer", two, 64},
                  {"PathTracer", two + ", next_event: false", 256},
                  {"GuidedPathTracer", two, 256},
                  {"BidirectionalPathTracer", two, 32},
                  {"VertexConnectionMerging", two + ", merging: false", 32},
                  {"LightTracer", two, 1024},
                  {"InstantRadiosity", two, 64},
                  {"DistributionRenderer", two, 32},
                  {"DirectRenderer", "", 64},
                  {"PrimarySampleMetropolis", "inner: PathTracer { max_depth: 2 }", 1024},
                  {"MultiplexedMetropolis", two, 1024}}});
  // The same with a perspective camera, which PathSpaceMetropolis needs.
  all.push_back({"DiscBeforeAPinhole",
                 "PerspectiveCamera { from: [0, 0, 5], to: [0, 0, 0], up: [0, 1, 0], focal_length: 5, sensor_size: 1 }",
                 plate(4, 0, "shader: Lambertian { color: 0.5 }") + disc,
                 plate_under_the_disc,
                 {{"BidirectionalPathTracer", two, 32}, {"PathSpaceMetropolis", two, 1024}}});
  // A null-scattering pane in front of the disc does not make it visible.
  all.push_back({"DiscBehindAPane",
                 square("[0, 0, 5]", "[0, 0, 0]", 1),
                 plate(4, 0, "shader: Lambertian { color: 0.5 }") + plate(4, 3, "shader: PassThrough {}") + disc,
                 plate_under_the_disc,
                 {{"PathTracer", two, 64}, {"BidirectionalPathTracer", two, 32}, {"LightTracer", two, 1024}}});
  // A plate on a quarter of the image, in uniform light from all directions: the rest is black.
  all.push_back({"Environment",
                 square("[0, 0, 5]", "[0, 0, 0]", 2),
                 plate(0.5, 0, "shader: Lambertian { color: 0.5 }") +
                     "Environment { emission: EnvironmentEmission { radiance: 1 }, " + unseen + " }",
                 0.125,
                 {{"PathTracer", two, 256},
                  {"PathTracer", two + ", next_event: false", 256},
                  {"BidirectionalPathTracer", two, 128},
                  {"LightTracer", two, 2048},
                  {"DistributionRenderer", two, 64},
                  {"DirectRenderer", "", 128},
                  {"PrimarySampleMetropolis", "inner: PathTracer { max_depth: 2 }", 1024},
                  {"MultiplexedMetropolis", two, 1024}}});
  // The camera looks through the unseen disc into a mirror, which shows the disc.
  all.push_back({"InAMirror",
                 square("[0, 0, 5]", "[0, 0, 0]", 0.5),
                 plate(400, 0, "shader: PerfectSpecular { color: 1 }") + disc,
                 1,
                 {{"PathTracer", three, 4},
                  {"BidirectionalPathTracer", three, 4},
                  {"WhittedRenderer", three, 4},
                  {"DistributionRenderer", three, 4},
                  {"DirectRenderer", "", 4}}});
  // An unseen wall that blocks half of the light, and would block half of the view.
  all.push_back({"Shadow",
                 square("[0, 0, 9]", "[0, 0, 0]", 1),
                 plate(4, 0, "shader: Lambertian { color: 0.5 }") +
                     "Rectangle { corner: [-9, -9, 1], edge_u: [18, 0, 0], edge_v: [0, 9, 0], " + unseen +
                     " }\n Distant { direction: [0, 0, -1], emission: DiffuseEmission { radiance: 2 } }",
                 0.5 / exact_pi,
                 {{"PathTracer", two, 16},
                  {"BidirectionalPathTracer", two, 16},
                  {"LightTracer", two, 4096},
                  {"WhittedRenderer", two, 16},
                  {"DirectRenderer", "", 16}}});
  return all;
}

class VisibleToCamera : public testing::TestWithParam<Case> {};
TEST_P(VisibleToCamera, IsWhatIsKnown) { expect_row(GetParam()); }
INSTANTIATE_TEST_SUITE_P(ClosedForms, VisibleToCamera, testing::ValuesIn(cases(rows())), case_name);

}  // namespace
}  // namespace etendue::closed_form
