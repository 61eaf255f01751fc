// AmbientOcclusionRenderer and FeatureRenderer.
// Statistical tests use fixed seeds and hold at 4.5 standard errors (two-sided 7e-6 each), unless they say otherwise.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "etendue/render/job.h"
#include "support/simple_renderers_support.h"

namespace etendue::test {
namespace {

// ---- ambient occlusion ----------------------------------------------------------------------------------------------

TEST(AmbientOcclusionRenderer, InsideASphere) {
  // A direction at the angle t from the normal hits the sphere again after 2 R cos(t): with rays of length d the open fraction
  // is 1 - (d / 2R)^2.
  for (const double d : {0.0, 0.5, 1.0, 1.9}) {
    const Measured m = measure(job_text(fmt::format("AmbientOcclusionRenderer {{ distance: {}, rays: 8, samples: 32 }}", d),
                                        furnace_camera, 16, "Sphere { radius: 1, " + diffuse + " }"));
    const double expected = d > 0 ? 1 - d * d / 4 : 0;
    EXPECT_EQ(m.bad, 0u);
    EXPECT_NEAR(m.mean.y, expected, 4.5 * m.error + 1e-6) << d;
    EXPECT_LE(m.error, 0.005);
  }
}

TEST(AmbientOcclusionRenderer, BesideAWall) {
  // An infinitely wide wall of height h at distance a occludes (1 - 1 / sqrt(1 + h^2 / a^2)) / 2 of the hemisphere.
  const std::string wall = "Rectangle { corner: [1,-5000,0], edge_u: [0,10000,0], edge_v: [0,0,1] }";
  for (const char* from : {"[0,0,0.5]", "[0.01,0,3]"}) {
    const Measured m = measure(job_text("AmbientOcclusionRenderer { rays: 16, samples: 256 }", pinhole(from, "[0,0,0]"), 8,
                                        floor_of("Lambertian {}") + wall));
    EXPECT_NEAR(m.mean.y, 1 - (1 - std::sqrt(0.5)) / 2, 4.5 * m.error + 1e-5);
    EXPECT_LE(m.error, 0.001);
  }
}

TEST(AmbientOcclusionRenderer, IsWhiteInEverySampleWhereAllIsOpen) {
  for (const char* objects : {"Disc { radius: 0.1 }", "Disc { radius: 9 }"}) {
    Ready ready(job_text("AmbientOcclusionRenderer { samples: 4 }",
                         "PerspectiveCamera { from: [0,0,5], to: [0,0,0], up: [0,1,0], fov: 40 }", 2, objects));
    for (std::uint32_t n = 0; n < 4; ++n) {
      const Vector3 c = ready.rgb(1, 0, n);
      for (int i = 0; i < 3; ++i) EXPECT_NEAR(c[i], 1, 2e-6f);
    }
  }
}

// ---- features -------------------------------------------------------------------------------------------------------

void expect_color(const Vector3& c, float r, float g, float b, const std::string& what) {
  EXPECT_NEAR(c.x, r, 2e-5f * std::max(1.0f, r)) << what;
  EXPECT_NEAR(c.y, g, 2e-5f * std::max(1.0f, g)) << what;
  EXPECT_NEAR(c.z, b, 2e-5f * std::max(1.0f, b)) << what;
}

TEST(FeatureRenderer, ShowsExactValues) {
  // Parallel rays along -z; a plane that rises along x by 45 degrees, and one below it.
  const std::string objects = R"(
    Rectangle { corner: [-1,-1,-1], edge_u: [2,0,2], edge_v: [0,2,0] }
    Rectangle { corner: [-1,-1,-3], edge_u: [2,0,0], edge_v: [0,2,0], shader: Lambertian { color: 0.25 } })";
  const auto color = [&](const char* feature, float x, float y, bool from_below = false) {
    const std::string camera = fmt::format("OrthographicCamera {{ from: [{},{},{}], to: [{},{},0], up: [0,1,0], width: 1e-5 }}",
                                           x, y, from_below ? -5 : 4, x, y);
    return Ready(job_text(fmt::format("FeatureRenderer {{ feature: {} }}", feature), camera, 1, objects)).rgb(0, 0);
  };
  const float half = std::sqrt(0.5f);
  for (const char* normal : {"normal", "shading_normal"})
    expect_color(color(normal, 0, 0), 0.5f - 0.5f * half, 0.5f, 0.5f + 0.5f * half, normal);
  expect_color(color("depth", 0.5f, 0), 3.5f, 3.5f, 3.5f, "depth");
  expect_color(color("uv", 0.5f, -0.5f), 0.75f, 0.25f, 0, "uv");
  expect_color(color("facing", 0, 0), half, half, half, "facing");
  expect_color(color("facing", 0, 0, true), 1, 0, 0, "the back of the lower plane");
  expect_color(color("hit_count", 0, 0), 2, 2, 2, "hit_count");
  // The scene's centre is (0, 0, -1), its radius sqrt(3 + ...) half the diagonal of a box of 2 x 2 x 4.
  const float radius = std::sqrt(6.0f);
  expect_color(color("position", 0.5f, -0.5f), 0.5f + 0.25f / radius, 0.5f - 0.25f / radius, 0.5f + 0.75f / radius, "position");
  for (const char* feature : {"normal", "depth", "albedo", "uv", "object", "primitive", "position", "hit_count", "facing"})
    expect_color(color(feature, 5, 5), 0, 0, 0, std::string("nothing met: ") + feature);
}

TEST(FeatureRenderer, TellsObjectsAndPrimitivesApart) {
  const std::string objects = R"(
    Sphere { centre: [-1,1,0], radius: 0.4 }
    Rectangle { corner: [0.5,0.5,0], edge_u: [1,0,0], edge_v: [0,1,0] }
    BruteForceScene { objects: [ Sphere { centre: [-1,-1,0], radius: 0.4 }, Sphere { centre: [1,-1,0], radius: 0.4 } ] })";
  const std::string camera = "OrthographicCamera { from: [0,0,5], to: [0,0,0], up: [0,1,0], width: 4 }";
  Ready object(job_text("FeatureRenderer { feature: object }", camera, 2, objects));
  // Objects are smaller than pixels: the colours of those samples are compared that hit an object.
  std::vector<Vector3> colors;
  for (int pixel = 0; pixel < 4; ++pixel)
    for (std::uint32_t n = 0; n < 64; ++n) {
      const Vector3 c = object.rgb(pixel % 2, pixel / 2, n);
      if (c.x < 0.05f) continue;
      EXPECT_GE(std::min({c.x, c.y, c.z}), 0.0999f);
      EXPECT_LE(std::max({c.x, c.y, c.z}), 1.0001f);
      const auto same = [&](const Vector3& other) { return length(c - other) < 1e-4f; };
      if (std::ranges::none_of(colors, same)) colors.push_back(c);
    }
  EXPECT_EQ(colors.size(), 4u);

  Ready primitive(job_text("FeatureRenderer { feature: primitive }",
                           "OrthographicCamera { from: [1,1,5], to: [1,1,0], up: [0,1,0], width: 0.9 }", 1, objects));
  colors.clear();
  for (std::uint32_t n = 0; n < 64; ++n) {
    const Vector3 c = primitive.rgb(0, 0, n);
    if (std::ranges::none_of(colors, [&](const Vector3& other) { return length(c - other) < 1e-4f; })) colors.push_back(c);
  }
  EXPECT_EQ(colors.size(), 2u);  // the two triangles of the rectangle
}

TEST(FeatureRenderer, AlbedoIsTheColourUnderWhiteLight) {
  const Ref<Job> job =
      load_job_text(job_text("FeatureRenderer { feature: albedo, samples: 1024 }", pinhole("[0,0,1]", "[0,0,0]"), 8,
                             floor_of("Lambertian { color: rgb(0.2, 0.5, 0.7) }")),
                    "test.etd");
  const Measured m = measure(job);
  const auto& f = rgb_space("srgb").from_xyz;
  const double wanted[3] = {0.2, 0.5, 0.7};
  for (size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(f[3 * i] * m.mean.x + f[3 * i + 1] * m.mean.y + f[3 * i + 2] * m.mean.z, wanted[i], 0.01);
}

}  // namespace
}  // namespace etendue::test
