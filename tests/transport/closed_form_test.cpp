// Configurations with a known answer, rendered. Each is held to 0.5 % and to 4.5 standard errors of its own estimate
// (two-sided 7e-6 for each), with a fixed seed.

#include <gtest/gtest.h>

#include "support/render_support.h"

namespace etendue::test {
namespace {

void expect_value(const Measured& m, double expected, double tolerance = 0.005) {
  EXPECT_EQ(m.bad, 0u);
  EXPECT_NEAR(m.mean.y, expected, tolerance * expected) << "standard error " << m.error;
  // The error bound assumes independent samples and is generous for low-discrepancy ones.
  EXPECT_NEAR(m.mean.y, expected, 4.5 * m.error + 2e-4 * expected);
}

const char* const unit_emission = "DiffuseEmission { radiance: 1, sides: both }";

std::string pinhole(const std::string& from, const std::string& to, const std::string& up = "[0, 1, 0]") {
  return "PerspectiveCamera { from: " + from + ", to: " + to + ", up: " + up + ", fov: 0.01 deg }";
}

std::string path_tracer(int depth, int samples, const std::string& more = "") {
  return "PathTracer { max_depth: " + std::to_string(depth) + ", samples: " + std::to_string(samples) + more + " }";
}

TEST(ClosedForm, FurnaceReachesItsLimit) {  // L = 1 / (1 - 0.8)
  const std::string sphere =
      std::string("Sphere { radius: 1, shader: Lambertian { color: 0.8 }, emission: ") + unit_emission + " }";
  for (const char* next_event : {"true", "false"}) {
    const auto m = measure(job_text(path_tracer(10000, 256, std::string(", next_event: ") + next_event),
                                    "PerspectiveCamera { from: [0.3, 0.1, 0.2] m, to: [0, 0, 1] m, fov: 90 deg }", 32, sphere));
    expect_value(m, 5);
  }
}

// Path guiding, direct light that is seen, and learning do not change the mean.
TEST(ClosedForm, GuidedFurnaceReachesItsLimit) {  // L = 1 / (1 - 0.8)
  const std::string sphere =
      std::string("Sphere { radius: 1, shader: Lambertian { color: 0.8 }, emission: ") + unit_emission + " }";
  for (const char* more : {"", ", next_event: false", ", learn_share: false, region_samples: 8"}) {
    const auto m = measure(job_text(std::string("GuidedPathTracer { max_depth: 10000, samples: 256") + more + " }",
                                    "PerspectiveCamera { from: [0.3, 0.1, 0.2] m, to: [0, 0, 1] m, fov: 90 deg }", 16, sphere));
    expect_value(m, 5);
  }
}

TEST(ClosedForm, FurnaceOfLimitedDepth) {
  const std::string box = R"(TriangleMesh {
      positions: [[-1,-1,-1],[1,-1,-1],[1,1,-1],[-1,1,-1],[-1,-1,1],[1,-1,1],[1,1,1],[-1,1,1]]
      triangles: [[0,1,2],[0,2,3],[4,6,5],[4,7,6],[0,4,5],[0,5,1],[1,5,6],[1,6,2],[2,6,7],[2,7,3],[3,7,4],[3,4,0]]
      shader: Lambertian { color: 0.8 }, emission: DiffuseEmission { radiance: 1, sides: both } })";
  const auto m =
      measure(job_text(path_tracer(9, 256), "PerspectiveCamera { from: [0.3, 0.1, 0.2], to: [0, 0, 1], fov: 90 }", 32, box));
  expect_value(m, 4.32891);
  const auto direct =
      measure(job_text(path_tracer(2, 256), "PerspectiveCamera { from: [0.3, 0.1, 0.2], to: [0, 0, 1], fov: 90 }", 32, box));
  expect_value(direct, 1.8);
}

// A Lambertian receiver of reflectance 1 seen by parallel rays: the mean of E / pi over it is the form factor.
TEST(ClosedForm, FormFactorOfParallelSquares) {
  const std::string objects =
      std::string("Rectangle { corner: [0,0,0], edge_u: [1,0,0], edge_v: [0,1,0], shader: Lambertian { color: 1 } }\n") +
      "Rectangle { corner: [0,0,1], edge_u: [1,0,0], edge_v: [0,1,0], emission: " + unit_emission + " }";
  expect_value(
      measure(job_text(path_tracer(2, 256),
                       "OrthographicCamera { from: [0.5,0.5,0.5], to: [0.5,0.5,0], up: [0,1,0], width: 1 }", 64, objects)),
      0.199825);
}

TEST(ClosedForm, FormFactorOfSquaresAtRightAngles) {
  const std::string objects =
      std::string("Rectangle { corner: [0,0,0], edge_u: [1,0,0], edge_v: [0,1,0], shader: Lambertian { color: 1 } }\n") +
      "Rectangle { corner: [0,0,0], edge_u: [0,1,0], edge_v: [0,0,1], emission: " + unit_emission + " }";
  expect_value(
      measure(job_text(path_tracer(2, 256), "OrthographicCamera { from: [0.5,0.5,5], to: [0.5,0.5,0], up: [0,1,0], width: 1 }",
                       64, objects)),
      0.200044);
}

TEST(ClosedForm, FormFactorOfDiscs) {  // the image is the square around the disc
  const std::string objects = std::string("Disc { radius: 1, shader: Lambertian { color: 1 } }\n") +
                              "Disc { radius: 1, transform: translate(0, 0, 1), emission: " + unit_emission + " }";
  const auto m = measure(
      job_text(path_tracer(2, 256), "OrthographicCamera { from: [0,0,0.5], to: [0,0,0], up: [0,1,0], width: 2 }", 64, objects));
  expect_value(m, 0.381966 * double(pi) / 4);
}

TEST(ClosedForm, IrradianceOfRectangle) {
  const std::string objects =
      std::string("Rectangle { corner: [-9,-9,0], edge_u: [18,0,0], edge_v: [0,18,0], shader: Lambertian { color: 1 } }\n") +
      "Rectangle { corner: [-1,-1,1], edge_u: [2,0,0], edge_v: [0,2,0], emission: " + unit_emission + " }";
  for (const char* next_event : {"true", "false"})
    expect_value(measure(job_text(path_tracer(2, 4096, std::string(", next_event: ") + next_event),
                                  pinhole("[0, 0, 0.5]", "[0,0,0]"), 8, objects)),
                 1.740840 / double(pi));
}

TEST(ClosedForm, IrradianceOfSphere) {
  const std::string objects =
      std::string("Rectangle { corner: [-1,-1,0], edge_u: [2,0,0], edge_v: [0,2,0], shader: Lambertian { color: 1 } }\n") +
      "Sphere { centre: [0,0,3], radius: 1, emission: " + unit_emission + " }";
  expect_value(measure(job_text(path_tracer(2, 4096), pinhole("[0, 0.2, 0.5]", "[0,0,0]"), 8, objects)), 0.349066 / double(pi));
}

TEST(ClosedForm, IrradianceOfSphereHalfBelowTheHorizon) {
  const std::string objects = std::string("Disc { radius: 0.1, shader: Lambertian { color: 1 } }\n") +
                              "Sphere { centre: [3,0,0], radius: 1, emission: " + unit_emission + " }";
  expect_value(measure(job_text(path_tracer(2, 8192), pinhole("[0, 0.2, 0.5]", "[0,0,0]"), 8, objects)), 0.025567 / double(pi));
}

// Lambert's formula for a polygon seen from a point with normal n: E = L/2 sum_i beta_i n.(v_i x v_{i+1})/|v_i x v_{i+1}|.
double lambert_polygon(const std::vector<std::array<double, 3>>& v) {
  double sum = 0;
  for (size_t i = 0; i < v.size(); ++i) {
    const auto &a = v[i], &b = v[(i + 1) % v.size()];
    const double dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    const std::array<double, 3> c = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    const double n = std::sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
    const double la = std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]),
                 lb = std::sqrt(b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
    sum += std::acos(dot / (la * lb)) * c[2] / n;
  }
  return std::abs(sum) / 2;
}

TEST(ClosedForm, IrradianceOfTriangles) {
  const std::vector<std::vector<std::array<double, 3>>> triangles = {{{-1, -1, 1}, {1, -1, 1}, {0, 1, 1}},
                                                                     {{0.1, 0.2, 2}, {3, 0.5, 0.5}, {1, 2, 1}},
                                                                     {{-0.2, -0.1, 0.05}, {0.3, -0.1, 0.2}, {0, 0.4, 0.1}}};
  for (const auto& t : triangles) {
    std::string points;
    for (const auto& p : t)
      points +=
          (points.empty() ? "[" : ", [") + std::to_string(p[0]) + "," + std::to_string(p[1]) + "," + std::to_string(p[2]) + "]";
    const std::string objects = "Disc { radius: 0.01, shader: Lambertian { color: 0.5 } }\nTriangleMesh { positions: [" +
                                points + "], triangles: [[0,1,2]], emission: " + unit_emission + " }";
    expect_value(measure(job_text(path_tracer(2, 4096), pinhole("[0.0, 0.02, 0.01]", "[0,0,0]", "[1,0,0]"), 8, objects)),
                 0.5 * lambert_polygon(t) / double(pi));
  }
}

TEST(ClosedForm, NoriTriangleLights) {
  const std::string folder = std::string(ETENDUE_SOURCE_DIR) + "/../shared/validation/nori/pa4/tests/meshes/";
  if (FILE* f = std::fopen((folder + "floor.obj").c_str(), "r"))
    std::fclose(f);
  else
    return;
  const double expected[5] = {0.0898393, 0.0229200, 0.0534195, 0.0205314, 0.2617399};
  for (int i = 0; i < 5; ++i) {
    const std::string objects = "TriangleMesh { file: \"" + folder +
                                "floor.obj\", shader: Lambertian { color: 0.5 } }\nTriangleMesh { file: \"" + folder +
                                "polylum" + std::to_string(i + 1) + ".obj\", emission: DiffuseEmission { radiance: 1 } }";
    expect_value(
        measure(job_text(path_tracer(2, 4096),
                         "PerspectiveCamera { from: [0,0.01,0], to: [0,0,0], up: [0,0,1], fov: 1e-6 deg }", 8, objects)),
        expected[i]);
  }
}

TEST(ClosedForm, TransmittanceOfGlassSlab) {  // (1 - R)/(1 + R) with R = 0.04, all internal reflections
  const std::string objects = std::string(R"(
    TriangleMesh { positions: [[-9,-9,0],[9,-9,0],[9,9,0],[-9,9,0],[-9,-9,1],[9,-9,1],[9,9,1],[-9,9,1]]
      triangles: [[0,2,1],[0,3,2],[4,5,6],[4,6,7],[0,1,5],[0,5,4],[1,2,6],[1,6,5],[2,3,7],[2,7,6],[3,0,4],[3,4,7]], shader: Dielectric { ior: 1.5 } }
    Rectangle { corner: [-9,-9,-3], edge_u: [18,0,0], edge_v: [0,18,0], emission: )") +
                              unit_emission + " }";
  expect_value(measure(job_text(path_tracer(1000, 4096), pinhole("[0,0,3]", "[0,0,0]"), 8, objects)), 0.923077);
}

// A uniform furnace stays uniform through glass: the factor of the squared index on the way in is undone on the way out.
TEST(ClosedForm, FurnaceThroughGlass) {
  const std::string objects = R"(
    Sphere { radius: 1, shader: Dielectric { ior: glass("N-SF11") } }
    Environment { emission: DiffuseEmission { radiance: 1, sides: both } })";
  expect_value(
      measure(job_text(path_tracer(10000, 512), "PerspectiveCamera { from: [0,0,-3], to: [0,0,0], fov: 30 }", 32, objects)), 1);
}

// A beam through a prism at minimum deviation is deviated as Sellmeier's formula predicts: 2 asin(n/2) - 60 degrees.
TEST(ClosedForm, PrismDeviation) {
  const struct {
    double wavelength, deviation;
  } lines[] = {{486.1327, 39.138}, {587.5618, 38.647}, {656.2725, 38.429}};
  for (const auto& line : lines) {
    // Edges along z; the beam meets the face through (0,1) and (-tan 30, 0), whose normal points 150 degrees from +x.
    const double incidence = (line.deviation + 60) / 2, heading = (-30 + incidence) * double(pi) / 180;
    const std::string w = fmt::format("HeroWavelengths {{ low: {}, high: {}, distribution: uniform }}", line.wavelength - 0.001,
                                      line.wavelength + 0.001);
    const std::string camera =
        fmt::format("OrthographicCamera {{ from: [{}, {}, 0], to: [-0.288675, 0.5, 0], up: [0,0,1], width: 1e-6 }}",
                    -0.288675 - 3 * std::cos(heading), 0.5 - 3 * std::sin(heading));
    std::string text = job_text(path_tracer(8, 1), camera, 1, R"(
      TriangleMesh { positions: [[0,1,-1],[-0.57735027,0,-1],[0.57735027,0,-1],[0,1,1],[-0.57735027,0,1],[0.57735027,0,1]]
        triangles: [[0,2,1],[3,4,5],[0,1,4],[0,4,3],[1,2,5],[1,5,4],[2,0,3],[2,3,5]], shader: Dielectric { ior: glass("N-BK7") } }
      Sphere { radius: 50 })");
    text.insert(text.find("renderer:"), "wavelengths: " + w + "\n ");
    const Render render(load_job_text(text, "prism.etd"));
    bool found = false;
    for (std::uint32_t n = 0; n < 100 && !found; ++n) {
      PathRecord record;
      render.replay(0, 0, n, record);
      if (record.vertices.size() < 4) continue;
      if (record.vertices[1].lobe != "specular transmission" || record.vertices[2].lobe != "specular transmission") continue;
      const Vector3 begin = Vector3(record.vertices[0].normal),
                    end = normalize(Vector3(record.vertices[3].position - record.vertices[2].position));
      EXPECT_NEAR(std::acos(double(dot(begin, end))) * 180 / double(pi), line.deviation, 0.005) << line.wavelength;
      found = true;
    }
    EXPECT_TRUE(found);
  }
}

}  // namespace
}  // namespace etendue::test
