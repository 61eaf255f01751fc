// HairShader on round tubes and on flat ribbons.

#include "support/component_test_support.h"
#include "support/render_support.h"

namespace etendue {
namespace {

using test::create;

TEST(HairCurves, TubesAndRibbonsScatterAlike) {
  // Seen from afar over its whole width, and lit by one light in front, at the side or behind, where light has to pass through:
  // tube and ribbon look the same. 5 standard errors.
  for (const char* direction : {"[0.3, -1, 0.2]", "[1, 0.1, 0.3]", "[0.5, 1, -0.3]", "[0.1, 1, 0]"}) {
    SCOPED_TRACE(direction);
    test::Measured m[2];
    for (const bool ribbon : {false, true}) {
      const std::string curve =
          std::string("Curve { points: [[0, 0, -2], [0, 0, 2]], radius: [0.1], normals: [[0, 1, 0]], form: ") +
          (ribbon ? "ribbon" : "tube") +
          ", shader: HairShader { azimuthal_roughness: 0.2, longitudinal_roughness: 0.3, eumelanin: 0.5 } }\n";
      m[ribbon] = test::measure(
          test::job_text("PathTracer { max_depth: 2, samples: 512 }",
                         "OrthographicCamera { from: [0, 5, 0], to: [0, 0, 0], up: [0, 0, 1], width: 0.3 }", 8,
                         curve + "Distant { direction: " + direction + ", emission: DiffuseEmission { radiance: 1 } }"));
    }
    EXPECT_GT(m[0].mean.y, 10 * m[0].error);
    EXPECT_NEAR(m[0].mean.y, m[1].mean.y, 5 * std::hypot(m[0].error, m[1].error));
  }
}

TEST(HairCurves, OffsetsFollowFromNormalsOfTubes) {
  // Where the tube's normal is rotated by an angle around the fibre, h is the angle's sine: the values are those of a ribbon at
  // this h, seen along its own normal. Seen from behind, the ribbon is rotated by half a turn.
  const auto hair = create<Shader>("HairShader", {{"azimuthal_roughness", 0.15}});
  const auto tube = create<SceneObject>("Curve"), ribbon = create<SceneObject>("Curve", {{"form", "ribbon"}});
  Arena arena;
  const auto bound = [&](const Ref<SceneObject>& object, float turn, float v) {
    SurfacePoint p = test::surface_point(Normal3(0, std::sin(turn), std::cos(turn)));
    p.dpdu = {1, 0, 0};
    p.uv = {0.5f, v};
    p.object = object.get();
    return hair->bind(p, test::wavelengths(), arena);
  };
  const Vector3 out = normalize(Vector3{0.3f, 0, 1});
  for (const float h : {-0.8f, -0.3f, 0.0f, 0.6f}) {
    // h is measured along normal x fibre, which is y here.
    const Scatter* round = bound(tube, std::asin(h), 0.123f);
    const Scatter* flat = bound(ribbon, 0, (1 + h) / 2);
    const Scatter* behind = bound(ribbon, pi, (1 - h) / 2);
    for (const Vector3& in : {Vector3{-0.2f, 0.7f, 0.6f}, Vector3{-0.4f, -0.5f, 0.5f}, Vector3{-0.3f, 0.1f, -0.9f}}) {
      const Vector3 d = normalize(in);
      const float expected = flat->evaluate(out, d)[0];
      EXPECT_NEAR(round->evaluate(out, d)[0], expected, 2e-3f * expected + 1e-5f) << h;
      EXPECT_NEAR(behind->evaluate(out, d)[0], expected, 2e-3f * expected + 1e-5f) << h;
    }
  }
}

TEST(HairCurves, TheWallOfATubeIsNotThereFromInside) {
  const auto hair = create<Shader>("HairShader", {});
  const auto tube = create<SceneObject>("Curve");
  SurfacePoint p = test::surface_point({0, 0, 1});
  p.dpdu = {1, 0, 0};
  p.object = tube.get();
  Arena arena;
  const Scatter* scatter = hair->bind(p, test::wavelengths(), arena);
  const Vector3 out = normalize(Vector3{0.3f, 0.2f, -1});
  const auto s = scatter->sample(out, 0.3f, {0.4f, 0.6f});
  ASSERT_TRUE(s);
  EXPECT_EQ(s->lobe, null_scattering);
  EXPECT_EQ(s->direction, -out);
  EXPECT_EQ(s->weight[0], 1);
  EXPECT_FALSE(scatter->sample(-out, 0.3f, {0.4f, 0.6f}, {.lobes = null_scattering}));
}

}  // namespace
}  // namespace etendue
