// Images of scenes with lamps in nested scenes: the same as without nesting, with the same noise.

#include "support/process.h"
#include "support/render_support.h"

namespace etendue {
namespace {

const char* const floor_and_wall =
    "Rectangle { corner: [-3, -3, 0] m, edge_u: [6, 0, 0] m, edge_v: [0, 6, 0] m, shader: Lambertian { color: 0.6 } }\n"
    "Rectangle { corner: [-3, 3, 0] m, edge_u: [6, 0, 0] m, edge_v: [0, 0, 4] m, shader: Lambertian { color: 0.6 } }\n";
// Below the lamps, so that the camera does not see them.
const char* const camera =
    "PerspectiveCamera { from: [0, 0, 0.35] m, to: [0, 1, 0] m, up: [0, 0, 1], fov: 50, shutter_close: 1 s }";

/// A sphere, a textured rectangle, a mesh and a spotlight, each with its own transform after `before`.
std::vector<std::string> lamps(const std::string& before) {
  return {
      "Sphere { radius: 0.08 m, transform: " + before + " * translate(0, 0, 0.1), emission: DiffuseEmission { power: 9 W } }",
      "Rectangle { corner: [-0.2, -0.2, 0] m, edge_u: [0.4, 0, 0] m, edge_v: [0, 0.4, 0] m, transform: " + before +
          " * rotate(20, \"x\"), emission: DiffuseEmission { sides: both, radiance: CheckerMap { first: 0.01, second: 0.1, "
          "repeat: [3, 3, 3] } } }",
      "TriangleMesh { positions: [0.1, 0, 0, 0, 0.1, 0, -0.1, 0, 0, 0, 0, 0.2] m, triangles: [0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, "
      "3], "
      "transform: " +
          before + " * translate(0.4, 0, 0), emission: CosineLobeEmission { exponent: 3, power: 5 W } }",
      "Point { position: [0, 0.3, 0.2] m, transform: " + before +
          ", emission: SpotEmission { axis: [0, 1, -1], power: 4 W, outer_angle: 40 } }"};
}
std::string listed(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += part + "\n";
  return text;
}

const char* const inner[] = {"translate(-0.8, 0, 0) * rotate(40, \"z\")", "translate(0.8, 0, 0.2) * scale(-0.7, 1, 0.8)"};
const char* const outer[] = {"translate(-0.9, 0.6, 0.6) * scale(0.6, 1, 1.2)", "translate(1, 0.5, 1) * rotate(-30, \"y\")"};

std::string nested() {
  std::string text = floor_and_wall;
  std::string pair = "BvhScene { objects: [";
  const std::string lamp = "EmbreeScene { objects: [ " + listed(lamps("scale(1)")) + " ] }";
  for (const char* place : inner) pair += "Instance { transform: " + std::string(place) + ", scene: " + lamp + " }\n";
  pair += "] }";
  for (const char* place : outer) text += "Instance { transform: " + std::string(place) + ", scene: " + pair + " }\n";
  return text;
}
std::string flat() {
  std::string text = floor_and_wall;
  for (const char* o : outer)
    for (const char* i : inner) text += listed(lamps(std::string(o) + " * " + i));
  return text;
}

// Compares the means and the noise of the images, for paths from the camera and from the lamps.
class NestedPictures : public ::testing::TestWithParam<const char*> {};

TEST_P(NestedPictures, AreThoseWithoutNesting) {
  const auto picture = [&](const std::string& objects) {
    return test::measure(test::job_text(GetParam(), camera, 32, objects, "EmbreeScene"));
  };
  const test::Measured a = picture(nested()), b = picture(flat());
  EXPECT_EQ(a.bad, 0u);
  EXPECT_NEAR(a.mean.y / b.mean.y, 1, 4 * std::hypot(a.error, b.error) / b.mean.y);
  EXPECT_NEAR(a.mean.x / b.mean.x, 1, 4 * std::hypot(a.error, b.error) / b.mean.y);
  EXPECT_LT(std::max(a.error, b.error) / b.mean.y, 0.03);  // so that the comparison is sensitive
  EXPECT_NEAR(a.error / b.error, 1, 0.25);
}

INSTANTIATE_TEST_SUITE_P(Renderers, NestedPictures,
                         ::testing::Values("PathTracer { max_depth: 4, samples: 64 }",
                                           "PathTracer { max_depth: 4, samples: 64, light_sampler: TreeLightSampler {} }",
                                           "BidirectionalPathTracer { max_depth: 4, samples: 32 }",
                                           "LightTracer { max_depth: 4, samples: 128 }",
                                           "WhittedRenderer { max_depth: 4, samples: 16 }",
                                           "DirectRenderer { strategy: light, samples: 64 }"),
                         [](const auto& each) {
                           const std::string text = each.param;
                           return text.substr(0, text.find(' ')) + std::to_string(each.index);
                         });

TEST(NestedCheck, CountsWhatIsSeen) {
  const TemporaryFolder folder;
  const std::string file = ETENDUE_SOURCE_DIR "/scenes/verify/nested_lamps.etd";
  Process process(ETENDUE_BINARY_DIR "/etendue", {"check", file}, folder);
  ASSERT_EQ(process.wait(), 0) << process.err();
  const std::string text = process.out();
  for (const char* line :
       {"objects     10, 35 in all places where nested scenes stand", "scenes      3, 10 in all places",
        "triangles   20, 70 in all places", "luminaires  24: 6 point lights, 18 area lights; 24 in nested scenes",
        "renderers that find all light of this scene: ", "LightTracer"})
    EXPECT_NE(text.find(line), std::string::npos) << line << "\n" << text;
}

}  // namespace
}  // namespace etendue
