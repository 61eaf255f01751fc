// The directions of light refracted by glass, in subpaths from the camera and from luminaires. Each sample is replayed; samples
// that hit the surfaces in the requested way give the direction in which they left the last of them.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/render_support.h"

namespace etendue::test {
namespace {

constexpr double exact_pi = 3.141592653589793;

struct Walk {
  const char* renderer;
  bool from_camera;
};
void PrintTo(const Walk& w, std::ostream* out) { *out << w.renderer << (w.from_camera ? " from the camera" : " from light"); }

class Refraction : public testing::TestWithParam<Walk> {
 protected:
  /// Directions of the subpaths that begin at `begin` towards `heading` (a unit vector in the plane z = 0, or along z) and are
  /// then transmitted (t) and reflected (r) in the order of `turns`.
  static std::vector<Vector3> leaving(const std::string& turns, const std::string& objects, const std::array<double, 3>& begin,
                                      const std::array<double, 3>& heading, double width, int samples,
                                      const std::string& wavelengths = "") {
    const auto& [x, y, z] = begin;
    const auto& [dx, dy, dz] = heading;
    const Walk& walk = GetParam();
    const bool along_z = dz != 0;
    // A lamp whose front faces the heading: the front is the cross product of its edges.
    const std::array<double, 3> u = along_z ? std::array{0.0, width, 0.0} : std::array{-dy * width, dx * width, 0.0},
                                v = along_z ? std::array{-dz * width, 0.0, 0.0} : std::array{0.0, 0.0, width};
    const std::string lamp = fmt::format(
        "Rectangle {{ corner: [{}, {}, {}], edge_u: [{}, {}, {}], edge_v: [{}, {}, {}], emission: SpotEmission {{ axis: [{}, "
        "{}, "
        "{}], inner_angle: 1e-4 deg, outer_angle: 2e-4 deg }} }}\n",
        x - (u[0] + v[0]) / 2, y - (u[1] + v[1]) / 2, z - (u[2] + v[2]) / 2, u[0], u[1], u[2], v[0], v[1], v[2], dx, dy, dz);
    const std::string up = along_z ? "[0, 1, 0]" : "[0, 0, 1]";
    std::string text = job_text(
        fmt::format("{} {{ max_depth: 8, samples: 1 }}", walk.renderer),
        walk.from_camera ? fmt::format("OrthographicCamera {{ from: [{}, {}, {}], to: [{}, {}, {}], up: {}, width: {} }}", x, y,
                                       z, x + dx, y + dy, z + dz, up, width)
                         : std::string("OrthographicCamera { from: [9, 9, 9], to: [10, 10, 10], width: 1 }"),
        2, objects + "Sphere { radius: 50 }\n" + (walk.from_camera ? "" : lamp), "EmbreeScene");
    if (!wavelengths.empty()) text.insert(text.find("renderer:"), "wavelengths: " + wavelengths + "\n ");
    const Render render(load_job_text(text, "bent.etd"));
    std::vector<Vector3> found;
    for (int n = 0; n < samples; ++n) {
      PathRecord record;
      render.replay(n % 2, n / 2 % 2, std::uint32_t(n / 4), record);
      const auto& path = walk.from_camera ? record.vertices : record.light_vertices;
      if (path.size() < turns.size() + 2) continue;
      std::string met;
      Vector3 direction(path[1].position - path[0].position);
      for (size_t i = 1; i <= turns.size(); ++i) {
        const Vector3 next = normalize(Vector3(path[i + 1].position - path[i].position));
        met += dot(path[i].normal, direction) * dot(path[i].normal, next) > 0 ? 't' : 'r';
        direction = next;
      }
      if (met == turns) found.push_back(direction);
    }
    return found;
  }
};

TEST_P(Refraction, R33_PrismAtMinimumDeviation) {  // 2 asin(n/2) - 60 degrees at the lines F, d and C
  const std::pair<double, double> lines[] = {{486.1327, 39.138}, {587.5618, 38.647}, {656.2725, 38.429}};
  for (const auto& [wavelength, deviation] : lines) {
    // Edges along z; the beam meets the face through (0, 1) and (-tan 30, 0), whose normal points 150 degrees from +x.
    const double angle = (-30 + (deviation + 60) / 2) * exact_pi / 180, x = std::cos(angle), y = std::sin(angle);
    const std::vector<Vector3> beams = leaving(
        "tt", R"(
      TriangleMesh { positions: [[0,1,-1],[-0.57735027,0,-1],[0.57735027,0,-1],[0,1,1],[-0.57735027,0,1],[0.57735027,0,1]]
        triangles: [[0,2,1],[3,4,5],[0,1,4],[0,4,3],[1,2,5],[1,5,4],[2,0,3],[2,3,5]], shader: Dielectric { ior: glass("N-BK7") } }
      )",
        {-0.288675 - 3 * x, 0.5 - 3 * y, 0}, {x, y, 0}, 1e-3, 40,
        fmt::format("HeroWavelengths {{ low: {}, high: {}, distribution: uniform }}", wavelength - 0.001, wavelength + 0.001));
    EXPECT_GT(beams.size(), 20u);
    for (const Vector3& beam : beams)
      EXPECT_NEAR(std::acos(double(beam.x) * x + double(beam.y) * y) * 180 / exact_pi, deviation, 0.005) << wavelength;
  }
}

// Light that is reflected once inside a drop leaves at all angles up to 42.078 degrees, most of it close to that.
TEST_P(Refraction, R34_Rainbow) {
  const std::vector<Vector3> back =
      leaving("trt", "Sphere { radius: 1, shader: Dielectric { ior: 1.333 } }\n", {0, 0, 40}, {0, 0, -1}, 2, 60000);
  ASSERT_GT(back.size(), 500u);
  double largest = 0;
  for (const Vector3& d : back) largest = std::max(largest, std::acos(double(d.z)) * 180 / exact_pi);
  EXPECT_NEAR(largest, 42.078, 0.005);
}

std::string walk_name(const testing::TestParamInfo<Walk>& walk) {
  return std::string(walk.param.renderer) + (walk.param.from_camera ? "FromCamera" : "FromLight");
}
INSTANTIATE_TEST_SUITE_P(Walks, Refraction,
                         testing::Values(Walk{"PathTracer", true}, Walk{"BidirectionalPathTracer", true},
                                         Walk{"BidirectionalPathTracer", false}, Walk{"LightTracer", false}),
                         walk_name);

}  // namespace
}  // namespace etendue::test
