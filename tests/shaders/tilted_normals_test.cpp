// Shading normals that differ from the surface's: interpolated, bumped, or read from an image. A material that scatters all
// light with its own normal scatters all of it with any normal, so it is invisible in a furnace: the expected value is 1 by the
// definition of a furnace. No light is lost, and all renderers give the same result.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/component_test_support.h"
#include "support/image_file.h"
#include "support/render_support.h"

namespace etendue {
namespace {

using test::job_text;
using test::measure;
using test::Measured;

/// A ball of `rows` x 2 `rows` squares, without the triangles that degenerate at the poles: 4 rows (rows - 1) triangles.
std::string smooth_ball(int rows, const std::string& more) {
  std::string positions, normals, triangles;
  const auto vertex = [&](double theta, double phi) {
    const std::string p = fmt::format("[{:.9g},{:.9g},{:.9g}],", std::sin(theta) * std::cos(phi), std::cos(theta),
                                      -std::sin(theta) * std::sin(phi));
    positions += p;
    normals += p;
  };
  const int columns = 2 * rows;
  vertex(0, 0);
  for (int i = 1; i < rows; ++i)
    for (int k = 0; k < columns; ++k) vertex(M_PI * i / rows, 2 * M_PI * k / columns);
  vertex(M_PI, 0);
  const auto at = [&](int i, int k) {
    return i == 0 ? 0 : i == rows ? 1 + (rows - 1) * columns : 1 + (i - 1) * columns + k % columns;
  };
  for (int i = 0; i < rows; ++i)
    for (int k = 0; k < columns; ++k) {
      const int a = at(i, k), b = at(i + 1, k), c = at(i + 1, k + 1), d = at(i, k + 1);
      if (i > 0) triangles += fmt::format("[{},{},{}],", a, b, d);
      if (i + 1 < rows) triangles += fmt::format("[{},{},{}],", b, c, d);
    }
  return "TriangleMesh { positions: [" + positions + "], normals: [" + normals + "], triangles: [" + triangles + "], " + more +
         " }";
}

struct White {
  const char* name;
  const char* text;
  bool noisy = false;
};
void PrintTo(const White& w, std::ostream* out) { *out << w.name; }
// A metal of n = 0.01 and k = 99 reflects all but 1e-5.
const White whites[] = {
    {"Lambertian", "Lambertian { color: 1 }"},
    {"OrenNayar", "OrenNayar { color: 1, roughness: 0.6 }", true},
    {"Dielectric", "Dielectric { ior: 1.5 }"},
    {"RoughDielectric", "Dielectric { ior: 1.5, roughness: 0.4 }", true},
    {"ThinDielectric", "ThinDielectric { ior: 1.5 }"},
    {"Conductor", "Conductor { ior: complex(0.01, 99), roughness: 0.5 }", true},
    {"DiffuseTransmitter", "DiffuseTransmitter { reflectance: 0.5, transmittance: 0.5 }", true},
    {"Layered", "LayeredShader { top: Dielectric { ior: 1.5 }, bottom: Lambertian { color: 1 } }", true},
};

std::string furnace(const std::string& renderer, const std::string& object) {
  return job_text(renderer, "PerspectiveCamera { from: [3, 2, 4], to: [0, 0, 0], fov: 24 deg }", 24,
                  object + "\nEnvironment { emission: EnvironmentEmission { radiance: 1 } }", "EmbreeScene");
}
constexpr const char* traced = "PathTracer { max_depth: 200, samples: 64 }";

class TiltedNormals : public ::testing::TestWithParam<White> {};

TEST_P(TiltedNormals, LoseNothingInAFurnace) {
  // Normals across the map are tilted by up to 52 degrees to all sides.
  std::vector<float> rgb;
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) {
      const double a = 2.4 * (8 * y + x), s = 0.8 * ((x + 3 * y) % 5) / 4.0;
      for (const double c : {s * std::cos(a), s * std::sin(a), std::sqrt(1 - s * s)}) rgb.push_back(float(0.5 + 0.5 * c));
    }
  const test::ImageFile normals("tilted.exr", 8, 8, rgb);
  const std::string shader = GetParam().text;
  struct Surface {
    std::string name, object;
  };
  const Surface surfaces[] = {
      {"32 triangles", smooth_ball(3, "shader: " + shader)},  // 24 of them
      {"128 triangles", smooth_ball(6, "shader: " + shader)},
      {"512 triangles", smooth_ball(12, "shader: " + shader)},
      {"bumps", "Sphere { shader: BumpShader { shader: " + shader + ", height: NoiseMap { size: 0.2 m }, scale: 0.1 } }"},
      {"image",
       "Sphere { shader: NormalMapShader { shader: " + shader + ", file: \"" + normals.path + "\", repeat: [4, 4] } }"}};
  // The furnace alone, measured with the same wavelengths, so that the colour noise of their sum cancels.
  const double alone = measure(furnace(traced, "")).mean.y;
  for (const Surface& surface : surfaces) {
    const Measured m = measure(furnace(traced, surface.object));
    EXPECT_EQ(m.bad, 0u) << surface.name;
    // Less than a thousandth is lost; sampled rough lobes have varying weights: four standard errors more.
    EXPECT_NEAR(m.mean.y / alone, 1, 1e-3 + (GetParam().noisy ? 4 * m.error : 0)) << surface.name;
    EXPECT_LT(m.error, 4e-3) << surface.name;
  }
}

INSTANTIATE_TEST_SUITE_P(White, TiltedNormals, ::testing::ValuesIn(whites),
                         [](const auto& each) { return std::string(each.param.name); });

TEST(TiltedNormals, LoseWhatWouldCrossTheSurfaceWhenAsked) {
  const Measured m = measure(furnace(traced, smooth_ball(6, "shader: Dielectric { ior: 1.5 }, shading_normals: clipped")));
  EXPECT_LT(m.mean.y, 0.995);
  EXPECT_GT(m.mean.y, 0.9);
}

// For any two functions g and h of directions, the light carried from b to a is the same when computed from either end:
//     integral of g(a) R(a, b) |a . ng| h(b) da db = integral of h(b) I(b, a) |b . ng| g(a) db da,
// with R from samples of radiance and I from samples of importance (Veach 1997, eq. 5.14). Samples are used because mirrors and
// glass, being delta, cannot be evaluated.
TEST_P(TiltedNormals, CarryTheSameFromBothEnds) {
  const Ref<Shader> shader = ref_cast<Shader>(parse_component(GetParam().text));
  prepare_tree(*shader);
  Ref<SceneObject> carrier = ref_cast<SceneObject>(parse_component("Sphere { }"));
  carrier->shader = shader;
  prepare_tree(*carrier);
  SurfacePoint p = carrier->sample_area({0.3f, 0.6f}, 0).point;
  carrier->tangents(p);
  for (const float tilt : {0.2f, 0.6f, 1.1f}) {
    if (tilt > 1 && shader->stochastic()) continue;  // its importance has tails too heavy for so few samples
    const Frame frame(p.normal);
    p.shading_normal = normalize(Normal3(frame.to_world({std::sin(tilt) * 0.6f, std::sin(tilt) * 0.8f, std::cos(tilt)})));
    const Vector3 axis_g = frame.to_world({0.3f, -0.8f, 0.5f}), axis_h = frame.to_world({-0.5f, 0.6f, 0.6f});
    const auto g = [&](const Vector3& v) { return 1.1 + double(dot(axis_g, v)); };
    const auto h = [&](const Vector3& v) { return dot(axis_h, v) > 0.2f ? 1.0 : 0.25; };
    const Wavelengths w = test::wavelengths();
    test::Random random(7);
    double sums[2] = {0, 0}, squares[2] = {0, 0};
    constexpr int count = 200'000;
    for (int i = 0; i < count; ++i) {
      Arena arena;
      const Scatter& scatter = *shader->bind(p, w, arena);
      for (const int end : {0, 1}) {
        const Vector3 from = random.direction();
        const float choice = random();
        const auto s =
            scatter.sample(from, choice, random.pair(), {.transport = end == 0 ? Transport::radiance : Transport::importance});
        if (!s) continue;
        const double x = double(s->weight[0]) * std::abs(double(dot(p.normal, from))) *
                         (end == 0 ? g(from) * h(s->direction) : h(from) * g(s->direction));
        sums[end] += x;
        squares[end] += x * x;
      }
    }
    const double mean[2] = {sums[0] / count, sums[1] / count};
    const auto variance = [&](int end) { return (squares[end] / count - mean[end] * mean[end]) / count; };
    EXPECT_NEAR(mean[0], mean[1], 4.5 * std::sqrt(variance(0) + variance(1))) << "tilted by " << tilt;
    EXPECT_LT(std::sqrt(variance(0) + variance(1)), 0.05 * mean[0]);
  }
}

// A picture of a lamp's light on tilted normals, by paths from both ends: the importance is the adjoint of the radiance.
TEST(TiltedNormals, LookTheSameToAllRenderers) {
  const std::string lamp = "Sphere { centre: [0.5, 3, 2.5], radius: 0.7, emission: DiffuseEmission { radiance: 20 } }";
  struct Way {
    const char *normals, *slopes;
  };
  for (const auto& [normals, slopes] :
       {Way{"folded", ""}, {"clipped", ""}, {"clipped", ", shadowing: true, opposite_slopes: true"}})
    for (const White& white : {whites[0], whites[3], whites[5]}) {
      const std::string mode = std::string(", shading_normals: ") + normals;
      const std::string shader = white.text;
      const std::string objects =
          smooth_ball(3, "transform: translate(-1.1, 0, 0), shader: " + shader + mode) +
          "\nSphere { centre: [1.1, 0, 0], shader: BumpShader { shader: " + shader +
          ", height: NoiseMap { size: 0.3 m }, scale: 0.3" + slopes + " }" + mode +
          " }\nDisc { radius: 3, transform: translate(0, -1, 0) * rotate(-90, \"x\"), shader: Lambertian { color: 0.6 } }\n" +
          lamp;
      const auto rendered = [&](const std::string& renderer) {
        return measure(job_text(renderer, "PerspectiveCamera { from: [0, 1.5, 6], to: [0, -0.2, 0], fov: 42 deg }", 24, objects,
                                "EmbreeScene"));
      };
      const Measured path = rendered("PathTracer { max_depth: 6, samples: 512 }");
      for (const std::string other :
           {"BidirectionalPathTracer { max_depth: 6, samples: 256 }", "LightTracer { max_depth: 6, samples: 1024 }"}) {
        const Measured m = rendered(other);
        EXPECT_NEAR(m.mean.y / path.mean.y, 1, 4.5 * std::hypot(m.error, path.error) / path.mean.y)
            << white.name << ", " << normals << slopes << ", " << other << ": " << m.mean.y << " +- " << m.error << ", "
            << path.mean.y << " +- " << path.error;
        EXPECT_LT(m.error / path.mean.y, 0.05) << white.name << other;
      }
    }
}

}  // namespace
}  // namespace etendue
