// Coincident surfaces of several objects, and objects with one absorbing side.

#include <gtest/gtest.h>

#include "support/render_support.h"

namespace etendue::test {
namespace {

/// A box 20 wide and deep, between two heights.
std::string box(double low, double high, const std::string& members, double half = 10) {
  const auto p = [&](int x, int y, double z) {
    return "[" + std::to_string(x * half) + "," + std::to_string(y * half) + "," + std::to_string(z) + "]";
  };
  std::string points;
  for (const double z : {low, high})
    for (const auto& [x, y] : {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)})
      points += (points.empty() ? "" : ",") + p(x, y, z);
  return "TriangleMesh { positions: [" + points +
         "], triangles: [[0,2,1],[0,3,2],[4,5,6],[4,6,7],[0,5,4],[0,1,5],[1,6,5],[1,2,6],[2,7,6],[2,3,7],[3,4,7],[3,0,4]], " +
         members + " }\n";
}

const char* const plate =
    "Rectangle { corner: [-4,-4,-3], edge_u: [8,0,0], edge_v: [0,8,0], emission: DiffuseEmission { radiance: 1 } }\n";
const char* const from_above = "OrthographicCamera { from: [0.1, 0.2, 1000], to: [0.1, 0.2, 0], up: [0, 1, 0], width: 0.1 }";

std::string fog(const std::string& medium) { return "shader: PassThrough {}, interior: HomogeneousVolume { " + medium + " }"; }
std::string glass(const std::string& ior, int priority) {
  return "shader: Dielectric { ior: " + ior + " }, priority: " + std::to_string(priority);
}

const char* const structures[] = {"EmbreeScene", "BruteForceScene"};

// Behind the second box there are 2 m, in which a medium that was not left would absorb all light.
TEST(Coincident, BoxesOfFogThatShareAFace) {
  for (const char* structure : structures)
    for (const char* renderer : {"PathTracer", "BidirectionalPathTracer"})
      for (const bool upper_first : {false, true}) {
        const std::string upper = box(-0.5, 0, fog("absorption: 1")), lower = box(-1, -0.5, fog("absorption: 3"));
        const Measured m = measure(job_text(std::string(renderer) + " { max_depth: 5, samples: 256 }", from_above, 8,
                                            (upper_first ? upper + lower : lower + upper) + plate, structure));
        EXPECT_NEAR(m.mean.y, std::exp(-2.0), 1e-3 * m.mean.y) << structure << " " << renderer << " " << upper_first;
      }
  const Measured light =
      measure(job_text("LightTracer { max_depth: 5, samples: 4096 }",
                       "OrthographicCamera { from: [0, 0, 1000], to: [0, 0, 0], up: [0, 1, 0], width: 6 }", 16,
                       box(-0.5, 0, fog("absorption: 1")) + box(-1, -0.5, fog("absorption: 3")) + plate));
  EXPECT_NEAR(light.mean.y, std::exp(-2.0), 0.005 * std::exp(-2.0));
}

TEST(Coincident, TheCameraInTheSecondOfTwoBoxes) {
  const std::string inside = "OrthographicCamera { from: [0.1, 0.2, -0.75], to: [0.1, 0.2, -2], up: [0, 1, 0], width: 0.1 }";
  for (const char* structure : structures) {
    const Measured m =
        measure(job_text("PathTracer { max_depth: 5, samples: 1024 }", inside, 4,
                         box(-0.5, 0, fog("absorption: 1")) + box(-1, -0.5, fog("absorption: 3")) + plate, structure));
    EXPECT_NEAR(m.mean.y, std::exp(-0.75), 1e-3 * m.mean.y) << structure;
  }
}

// Plates without absorption, with all reflections between their surfaces, have T = 1 / (1 + sum of R / (1 - R)) (Stokes 1862).
TEST(Coincident, GlassOnWater) {
  double sum = 0;
  for (const auto& [a, b] : {std::pair(1.0, 1.5), std::pair(1.5, 1.33), std::pair(1.33, 1.0)}) {
    const double r = (a - b) * (a - b) / ((a + b) * (a + b));
    sum += r / (1 - r);
  }
  for (const char* structure : structures)
    for (const char* renderer : {"PathTracer", "BidirectionalPathTracer", "WhittedRenderer"})
      for (const int water : {0, 1, 2}) {
        if (std::string(structure) != "EmbreeScene" && std::string(renderer) != "PathTracer") continue;
        for (const bool upside_down : {false, true}) {
          const std::string objects = upside_down ? box(-0.5, 0, glass("1.33", water)) + box(-1, -0.5, glass("1.5", 1))
                                                  : box(-0.5, 0, glass("1.5", 1)) + box(-1, -0.5, glass("1.33", water));
          const Measured m = measure(
              job_text(std::string(renderer) + " { max_depth: 12, samples: 1024 }", from_above, 8, objects + plate, structure));
          EXPECT_NEAR(m.mean.y, 1 / (1 + sum), 0.003) << structure << " " << renderer << " " << water << " " << upside_down;
        }
      }
}

// Glass that stands on the floor has no air below it, as if it were sunk into the floor a little.
TEST(Coincident, GlassOnTheFloor) {
  const std::string rest =
      R"(Rectangle { corner: [-4,-4,0], edge_u: [8,0,0], edge_v: [0,8,0], shader: Lambertian { color: 0.8 } }
    Environment { emission: DiffuseEmission { radiance: 1, sides: both } })";
  const auto render = [&](double bottom) {
    return measure(job_text("PathTracer { samples: 4096, max_depth: 32 }",
                            "OrthographicCamera { from: [0.1, 0.2, 10], to: [0, 0, 0.5], up: [0, 1, 0], width: 1 }", 16,
                            box(bottom, 1, glass("1.5", 0), 1) + "\n" + rest, "EmbreeScene"));
  };
  const Measured on = render(0), in = render(-0.1);
  EXPECT_NEAR(on.mean.y, in.mean.y, 4.5 * std::hypot(on.error, in.error)) << in.mean.y;
  EXPECT_LT(on.error, 2e-3);
}

// The same brick twice, in separate scenes, face to face: like one brick of double height.
TEST(Coincident, OneBrickInTwoPlaces) {
  const double r = 0.04, t = std::exp(-1.0);  // with all reflections between the faces
  const std::string made_of = "shader: Dielectric { ior: 1.5 }, interior: HomogeneousVolume { absorption: 1 }";
  for (const auto& [structure, brick] :
       {std::pair<std::string, std::string>{"EmbreeScene", box(-0.5, 0, made_of)},
        {"BvhScene", "Box { size: [20, 20, 0.5], transform: translate([0, 0, -0.25]), " + made_of + " }\n"}}) {
    const std::string twice = "brick = " + brick + "\n" +
                              job_text("PathTracer { max_depth: 12, samples: 1024 }", from_above, 8,
                                       structure + " { objects: [brick] }\n" + structure +
                                           " { objects: [brick], transform: translate([0, 0, -0.5]) }\n" + plate,
                                       structure);
    EXPECT_NEAR(measure(twice).mean.y, (1 - r) * (1 - r) * t / (1 - r * r * t * t), 0.003) << structure;
  }
}

// A thin pane encloses no body and lets shadow rays through: for a slab of index 1.5 and R = 0.0459 at this angle, 1 - 2 R / (1
// + R).
TEST(NullSurfaces, APaneBeforeALamp) {
  const auto render = [&](const std::string& pane) {
    return measure(
               job_text("PathTracer { max_depth: 3, samples: 16 }", from_above, 4,
                        "Rectangle { corner: [-1,-1,0], edge_u: [2,0,0], edge_v: [0,2,0], shader: Lambertian { color: 0.5 } }\n"
                        "Point { position: [2, 0.2, 1.5], emission: DiffuseEmission { radiance: 1 } }\n" +
                            pane,
                        "EmbreeScene"))
        .mean.y;
  };
  const double bare = render(""), behind = render(
                                      "Rectangle { corner: [0.5,-1,0], edge_u: [0,2,0], edge_v: [0,0,2], shader: "
                                      "ThinDielectric { ior: 1.5 } }\n");
  EXPECT_NEAR(behind / bare, 0.912, 0.01);
}

// Glass whose back absorbs reflects, and transmits nothing: 4 % at normal incidence.
TEST(OneSided, GlassLetsNothingThrough) {
  for (const char* renderer :
       {"PathTracer", "BidirectionalPathTracer", "WhittedRenderer", "DistributionRenderer", "DirectRenderer"})
    for (const char* sides : {"front", "back"}) {
      const Measured m = measure(
          job_text(std::string(renderer) + " { samples: 1024 }", from_above, 4,
                   std::string("Rectangle { corner: [-1,-1,0], edge_u: [2,0,0], edge_v: [0,2,0], shader: Dielectric { ior: 1.5 "
                               "}, sides: ") +
                       sides + " }\nEnvironment { emission: DiffuseEmission { radiance: 1, sides: both } }"));
      EXPECT_NEAR(m.mean.y, std::string(sides) == "front" ? 0.04 : 0, 0.004) << renderer << " " << sides;
    }
}

}  // namespace
}  // namespace etendue::test
