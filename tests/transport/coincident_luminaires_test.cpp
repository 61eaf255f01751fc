// Luminaires that coincide with other surfaces: every renderer hits the same one of the two, from either side.

#include "support/render_support.h"

namespace etendue {
namespace {

const char* const floor =
    "Rectangle { corner: [-2, -2, -1] m, edge_u: [4, 0, 0] m, edge_v: [0, 4, 0] m, shader: Lambertian { color: 0.6 } }\n";
const char* const camera = "PerspectiveCamera { from: [0.2, -3.4, 0.1] m, to: [0, 0, -0.4] m, up: [0, 0, 1], fov: 45 }";

// The height of the second surface when it coincides with the first, and when it lies a little behind it.
const char *const together = "0", *const behind = "0.0004";

/// Two surfaces seen from below. `height` is that of the one that the other hides where they coincide.
struct Place {
  const char* name;
  std::string (*objects)(const std::string& height);
};
void PrintTo(const Place& p, std::ostream* out) { *out << p.name; }

const Place places[] = {
    {"two_lamps",
     [](const std::string& height) {
       return "Rectangle { corner: [-0.5, -0.5, 0] m, edge_u: [0, 1, 0] m, edge_v: [1, 0, 0] m, emission: DiffuseEmission { "
              "radiance: 1 } }\nDisc { radius: 0.6 m, transform: translate(0.4, 0.1, " +
              height + ") * rotate(180, \"x\"), emission: CosineLobeEmission { exponent: 4, radiance: 4 } }\n";
     }},
    {"lamp_in_the_ceiling",
     [](const std::string& height) {
       return "Rectangle { corner: [-1.3, -1.1, " + height +
              "] m, edge_u: [0, 2.4, 0] m, edge_v: [2.7, 0, 0] m, shader: Lambertian { color: 0.7 } }\n"
              "TriangleMesh { positions: [-0.4, -0.3, 0, 0.1, 0.5, 0, 0.5, -0.4, 0] m, triangles: [0, 1, 2], emission: "
              "DiffuseEmission { radiance: 3 } }\n";
     }},
    // Each face emits to its own side, and reflects.
    {"two_faces_of_a_mesh", [](const std::string& height) {
       return "TriangleMesh { positions: [-0.4, -0.3, 0, 0.1, 0.5, 0, 0.5, -0.4, 0, -0.4, -0.3, " + height + ", 0.1, 0.5, " +
              height + ", 0.5, -0.4, " + height +
              "] m, triangles: [0, 1, 2, 3, 5, 4], shader: Lambertian { color: 0.5 }, emission: DiffuseEmission { radiance: 3 "
              "} "
              "}\n";
     }}};

/// Transforms under which float coordinates are rounded, and which place an instance with its own acceleration structure.
const char* const transforms[] = {"translate(0.1, 0.2, 0.3) * rotate(17, [1, 0.4, 0.3])",
                                  "translate(0.1, 0.2, 0.3) * scale(-1, 1, 1) * rotate(9, [0.2, 1, 0.1])"};

std::string placed(const std::string& what, const char* transform) {
  return std::string(floor) + "Instance { transform: " + transform + ", scene: BvhScene { objects: [" + what + "] } }";
}

class CoincidentLuminaires : public ::testing::TestWithParam<Place> {};

TEST_P(CoincidentLuminaires, AreTheSameForAllRenderers) {
  for (const char* transform : transforms) {
    const auto measured = [&](const std::string& renderer, const char* height, const char* structure) {
      const std::string objects = placed(GetParam().objects(height), transform);
      return test::measure(test::job_text(renderer, camera, 16, objects, structure));
    };
    const test::Measured all = measured("PathTracer { max_depth: 4, samples: 600 }", behind, "BruteForceScene"),
                         direct = measured("PathTracer { max_depth: 2, samples: 600 }", behind, "BruteForceScene");
    for (const char* renderer :
         {"PathTracer { max_depth: 4, samples: 400 }", "LightTracer { max_depth: 4, samples: 600 }",
          "BidirectionalPathTracer { max_depth: 4, samples: 200 }", "DirectRenderer { strategy: light, samples: 400 }",
          "DirectRenderer { strategy: shader, samples: 400 }",
          "VertexConnectionMerging { max_depth: 4, samples: 150, merging: false }"}) {
      const test::Measured& wanted = std::string(renderer).starts_with("Direct") ? direct : all;
      const test::Measured found = measured(renderer, together, "EmbreeScene");
      const double error = std::hypot(found.error, wanted.error);
      EXPECT_EQ(found.bad, 0u);
      EXPECT_LT(error / wanted.mean.y, 0.04) << renderer;
      EXPECT_NEAR(found.mean.y, wanted.mean.y, 4 * error + 2e-3 * wanted.mean.y) << renderer << ", " << transform;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Places, CoincidentLuminaires, ::testing::ValuesIn(places),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace etendue
