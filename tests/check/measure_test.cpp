// Meters read what closed forms say. Each value is held to 5 standard errors of its own estimate (Student's distribution with
// 15 degrees of freedom: 1.6e-4, fixed seeds), and its error to 0.5 %.

#include "check/measure/measure.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>

#include "etendue/describe/color.h"
#include "support/program_support.h"
#include "support/render_support.h"

namespace etendue {
namespace {

constexpr double exact_pi = 3.14159265358979323846, range = 470, lumens_per_watt = 683;

std::string job_text(const std::string& renderer, const std::string& camera, const std::string& objects,
                     const std::string& rest = "") {
  return "Job { renderer: " + renderer + "\n camera: " + camera + "\n scene: BruteForceScene { objects: [" + objects + "] }\n" +
         rest + "}";
}

measure::Measurement measured(const std::string& text, const measure::Options& options = {.samples = 1 << 18, .bands = 10}) {
  return measure::measure(load_job_text(text, "test.etd"), options);
}

void expect(const measure::Reading& reading, double value, const std::string& what, double least_error = 1e-5) {
  EXPECT_NEAR(reading.value, value, 5 * reading.error + least_error * value) << what;
  EXPECT_LT(reading.error, 5e-3 * value) << what;
}

/// A spectrum of 1 at all wavelengths with this irradiance or radiance per nanometre.
void expect_flat(const measure::Measurement& m, double value, const std::string& what) {
  expect(m.total, value * range, what + ", total");
  expect(m.photometric, value * lumens_per_watt * observer_y_integral(), what + ", for the eye");
  ASSERT_EQ(m.bands.size(), 10u);
  // At the ends of the spectrum few wavelengths are sampled.
  for (size_t b = 1; b < 8; ++b)
    EXPECT_NEAR(m.bands[b].reading.value, value, 6 * m.bands[b].reading.error + 1e-5 * value) << what << ", band " << b;
}

const std::string up = "IrradianceMeter { from: [0.3, 0.1, -0.2] m, normal: [0, 1, 0] }";

// A disc of radius r at the height h over the meter: E = pi L r^2 / (r^2 + h^2).
TEST(Measure, IrradianceOfADisc) {
  for (const std::string renderer : {"PathTracer", "LightTracer", "BidirectionalPathTracer", "VertexConnectionMerging"})
    expect_flat(measured(job_text(renderer + " {}", up, R"(
        Disc { radius: 1 m, transform: translate(0.3 m, 2.1 m, -0.2 m) * rotate(90 deg, "x"), emission: DiffuseEmission { radiance: 1 } }
        Rectangle { corner: [-5, -1, -5] m, edge_u: [0, 0, 10] m, edge_v: [10, 0, 0] m, shader: Lambertian { color: 0.5 } })")),
                exact_pi / 5, renderer);
}

// A rectangle of a x b with a corner above the meter at the height h, parallel to its plane (configuration factor C-11 of
// Howell): E = L / 2 (A / sqrt(1 + A^2) atan(B / sqrt(1 + A^2)) + B / sqrt(1 + B^2) atan(A / sqrt(1 + B^2))), A = a/h, B = b/h.
TEST(Measure, IrradianceOfARectangle) {
  const double a = 1.5 / 2, b = 0.8 / 2, p = std::sqrt(1 + a * a), q = std::sqrt(1 + b * b);
  for (const std::string renderer : {"PathTracer", "LightTracer"})
    expect_flat(measured(job_text(renderer + " {}", up, R"(
        Rectangle { corner: [0.3, 2.1, -0.2] m, edge_u: [1.5, 0, 0] m, edge_v: [0, 0, 0.8] m, emission: DiffuseEmission { radiance: 1, sides: both } })")),
                (a / p * std::atan(b / p) + b / q * std::atan(a / q)) / 2, renderer);
}

// A point of the intensity 1 W/(sr nm) at the distance d: E = cos(theta) / d^2, which no ray finds; a ball that hides it.
TEST(Measure, IrradianceOfAPoint) {
  const std::string lamp = "Point { transform: translate(0.3 m, 2.1 m, 0.8 m), emission: DiffuseEmission { radiance: 1 } }\n";
  for (const std::string renderer : {"PathTracer", "LightTracer", "BidirectionalPathTracer"})
    expect_flat(measured(job_text(renderer + " {}", up, lamp)), 2 / std::sqrt(5.0) / 5, renderer);
  EXPECT_EQ(measured(job_text("PathTracer {}", up, lamp + "Sphere { centre: [0.3, 1.1, 0.3] m, radius: 0.1 m }")).total.value,
            0);
  EXPECT_EQ(
      measured(job_text("PathTracer {}", "IrradianceMeter { from: [0.3, 0.1, -0.2] m, normal: [0, -1, 0] }", lamp)).total.value,
      0);
}

// The light of a point that a floor scatters to a meter that faces the floor: an infinite Lambertian plane of the reflectance
// 1/2 at the distance h below both has the radiance rho I h / (pi d^3) around; directly below a spot meter d = h.
TEST(Measure, RadianceOfALitFloor) {
  const std::string floor = R"(
        Point { transform: translate(0, 2 m, 0), emission: DiffuseEmission { radiance: 1 } }
        Rectangle { corner: [-9, 0, -9] m, edge_u: [0, 0, 18] m, edge_v: [18, 0, 0] m, shader: Lambertian { color: 0.5 } })";
  expect_flat(
      measured(job_text("PathTracer {}", "RadianceMeter { from: [0, 1, 0] m, to: [0, 0, 0] m, angle: 0.2 deg }", floor)),
      0.5 / exact_pi / 4, "PathTracer");
}

// Inside a sphere that emits everywhere: radiance 1 in any cone, irradiance pi on any plane; hidden from cameras or not.
TEST(Measure, InsideALuminaire) {
  for (const std::string hidden : {"true", "false"}) {
    const std::string ball =
        "Sphere { radius: 3 m, visible_to_camera: " + hidden + ", emission: DiffuseEmission { radiance: 1, sides: both } }";
    for (const double angle : {1.0, 40.0, 180.0, 360.0})
      expect_flat(
          measured(job_text("PathTracer {}",
                            "RadianceMeter { from: [1, 1, 0] m, to: [0, 0.5, 0] m, angle: " + std::to_string(angle) + " deg }",
                            ball)),
          1, "cone");
    expect_flat(measured(job_text("PathTracer {}", "IrradianceMeter { from: [1, 1, 0] m, normal: [1, 2, -0.5] }", ball)),
                exact_pi, "plane");
  }
}

// A spot meter of the half angle alpha sees a point of the intensity 1 at the distance d: the mean radiance over the cone's
// solid angle is 1 / (d^2 2 pi (1 - cos(alpha))).
TEST(Measure, RadianceOfAPointInTheCone) {
  expect_flat(measured(job_text("PathTracer {}", "RadianceMeter { from: [0, 0, 0] m, to: [0, 0, 1] m, angle: 20 deg }",
                                "Point { transform: translate(0.1 m, 0, 2 m), emission: DiffuseEmission { radiance: 1 } }")),
              1 / (4.01 * 2 * exact_pi * (1 - std::cos(exact_pi / 18))), "point");
}

// The bands of a file's own film are measured: a line in one of them.
TEST(Measure, BandsOfTheFile) {
  const measure::Measurement m = measured(job_text(
      "PathTracer {}", up,
      "Sphere { radius: 3 m, emission: DiffuseEmission { radiance: spectrum([588, 589, 590], [0, 1, 0]), sides: both } }",
      "image: SpectralFilm { edges: [360, 580, 600, 830] nm }"));
  ASSERT_EQ(m.bands.size(), 3u);
  EXPECT_EQ(m.bands[0].reading.value, 0);
  EXPECT_EQ(m.bands[2].reading.value, 0);
  EXPECT_EQ(m.bands[1].low, 580);
  EXPECT_NEAR(m.total.value, exact_pi, 0.05 * exact_pi);
  EXPECT_NEAR(m.bands[1].reading.value * 20, m.total.value, 1e-9);
  EXPECT_GT(m.x.value, 0.55);  // sodium is at x = 0.569
  const std::string json = measure::measurement_json(m), text = measure::measurement_text(m);
  EXPECT_NE(json.find("\"illuminance\""), std::string::npos);
  EXPECT_NE(text.find("580 to 600"), std::string::npos);
}

// Each measurement is made of several renders with seeds of their own, and measurements with neighbouring seeds have none in
// common. Of two renders the mean m and its standard error e tell the values: m - e and m + e.
TEST(Measure, SeedsAreIndependent) {
  const std::string lamp =
      "Disc { radius: 1 m, transform: translate(0.3 m, 2.1 m, -0.2 m) * rotate(90 deg, \"x\"), emission: DiffuseEmission { "
      "radiance: 1 } }";
  const auto renders_of = [&](int seed) {
    const std::string text = job_text("PathTracer {}", up, lamp, "seed: " + std::to_string(seed));
    const measure::Reading r = measured(text, {.samples = 1 << 14, .renders = 2, .bands = 1}).total;
    return std::array{r.value - r.error, r.value + r.error};
  };
  for (const double a : renders_of(1))
    for (const double b : renders_of(2)) EXPECT_GT(std::abs(a - b), 1e-9 * a);
}

using MeasureProgram = RunsProgram;

// A zero that is there because the renderer cannot find the light is not shown without a word.
TEST_F(MeasureProgram, WarnsOfLightThatIsMissed) {
  std::ofstream(folder / "sky.etd") << job_text("LightTracer {}", up,
                                                "Environment { emission: DiffuseEmission { radiance: 1 } }");
  EXPECT_EQ(run({"measure", "sky.etd", "--samples", "1e4", "--bands", "1"}), 0) << err;
  EXPECT_TRUE(says("LightTracer cannot find")) << err;
}

TEST(Measure, RefusesACrop) {
  EXPECT_THROW(measured(job_text("PathTracer {}", up, "Sphere {}", "image: ImageBuffer { crop: [0, 0, 4, 4] }")), Error);
}

}  // namespace
}  // namespace etendue
