// Which segments count for `max_depth`, by every renderer that has it: scattering begins a new segment, null scattering does
// not. Each row is a scene whose light comes by paths of one length: with that max_depth all of it is found, with less nothing.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/closed_form_rows.h"
#include "support/render_support.h"

namespace etendue::test {
namespace {

struct LengthCase {
  const char* name;
  int segments;                    ///< length of the paths with the light
  closed_form::Expected expected;  ///< radiance
  std::string camera, objects;
  std::vector<std::string> renderers;
};

void PrintTo(const LengthCase& c, std::ostream* out) { *out << c.name; }

const std::vector<std::string> eyes = {"PathTracer { samples: 256", "BidirectionalPathTracer { samples: 256",
                                       "DistributionRenderer { samples: 64", "WhittedRenderer { samples: 64"};
const std::vector<std::string> with_matt = {"PathTracer { samples: 64", "BidirectionalPathTracer { samples: 256",
                                            "DistributionRenderer { samples: 16", "WhittedRenderer { samples: 16",
                                            "LightTracer { samples: 65536"};
const std::vector<std::string> with_media = {"PathTracer { samples: 4096", "BidirectionalPathTracer { samples: 4096",
                                             "LightTracer { samples: 65536"};

const std::string down = "OrthographicCamera { from: [0, 0, 5], to: [0, 0, 0], up: [0, 1, 0], width: 0.1 }";
const std::string under = "OrthographicCamera { from: [0, 0, 0.5], to: [0, 0, 0], up: [0, 1, 0], width: 3.9 }";
const std::string lamp =
    "Rectangle { corner: [-9, -9, -1], edge_u: [18, 0, 0], edge_v: [0, 18, 0], emission: DiffuseEmission { radiance: 1 } }\n";
const std::string sun = "Distant { direction: [0, 0, -1], emission: DiffuseEmission { radiance: 3.14159265 } }\n";
const std::string plate =
    "Rectangle { corner: [-2, -2, 0], edge_u: [4, 0, 0], edge_v: [0, 4, 0], shader: Lambertian { color: 0.5 } }\n";

std::string sheet(const std::string& shader, double z = 1) {
  return fmt::format("Rectangle {{ corner: [-4, -4, {}], edge_u: [8, 0, 0], edge_v: [0, 8, 0], shader: {} }}\n", z, shader);
}

// A diffuse floor in the sun and a wall at its edge, parallel to the sunlight: the wall is lit by the floor alone.
const std::string along = "OrthographicCamera { from: [1, 0, 2], to: [0, 0, 2], up: [0, 0, 1], width: 3.9 }";
const std::string floor_and_wall =
    "Rectangle { corner: [0, -2, 0], edge_u: [4, 0, 0], edge_v: [0, 4, 0], shader: Lambertian { color: 0.5 } }\n"
    "Rectangle { corner: [0, -2, 0], edge_u: [0, 4, 0], edge_v: [0, 0, 4], shader: Lambertian { color: 0.5 } }\n";

/// The form factor of the floor seen from a point on the wall, averaged over what the camera sees of the wall. For a rectangle
/// of depth a and width b, perpendicular to the receiver, with the point at the height h above its corner, the form factor is
/// (atan(b / h) - h / c atan(b / c)) / 2 pi with c^2 = h^2 + a^2 (Lambert's contour integral).
double floor_seen_from_wall() {
  constexpr int steps = 400;
  const auto part = [](double b, double h) {
    const double c = std::hypot(h, 4.0);
    return (std::atan(b / h) - h / c * std::atan(b / c)) / (2 * M_PI);
  };
  double sum = 0;
  for (int i = 0; i < steps; ++i)
    for (int k = 0; k < steps; ++k) {
      const double y = 3.9 * ((i + 0.5) / steps - 0.5), h = 2 + 3.9 * ((k + 0.5) / steps - 0.5);
      sum += part(2 - y, h) + part(2 + y, h);
    }
  return sum / (steps * steps);
}

double wall_lit_by_the_floor() { return 0.5 * 0.5 * floor_seen_from_wall(); }

const double r = 0.04, through_pane = (1 - r) / (1 + r);

std::vector<LengthCase> length_cases() {
  return {
      {"SeenDirectly", 1, 1, down, lamp, eyes},
      {"ThroughAHole", 1, 0.5, down, lamp + sheet("MaskShader { shader: Lambertian { color: 0 }, opacity: 0.5 }"), eyes},
      {"ThroughThinPanes",
       1,
       through_pane * through_pane,
       down,
       "Rectangle { corner: [-9, -9, -1], edge_u: [18, 0, 0], edge_v: [0, 18, 0], emission: DiffuseEmission { radiance: 1 } "
       "}\n" +
           sheet("ThinDielectric { ior: 1.5, color: 1 }", 1) + sheet("ThinDielectric { ior: 1.5, color: 1 }", 2),
       {"PathTracer { samples: 1024", "BidirectionalPathTracer { samples: 1024", "DistributionRenderer { samples: 256",
        "WhittedRenderer { samples: 64"}},
      {"ThroughTheBoundsOfAMedium",
       1,
       std::exp(-1.0),
       down,
       lamp + "Box { centre: [0, 0, 1], size: [4, 4, 1], shader: PassThrough {}, interior: HomogeneousVolume { absorption: 1 } "
              "}\n",
       {"PathTracer { samples: 64", "BidirectionalPathTracer { samples: 64"}},
      // The boundary of the inner body has no effect inside a body of higher priority.
      {"HiddenByPriority", 3, (1 - r) * (1 - r), down,
       lamp + "Box { centre: [0, 0, 1], size: [6, 6, 1], priority: 1, shader: Dielectric { ior: 1.5 } }\n"
              "Box { centre: [0, 0, 1], size: [2, 2, 0.5], shader: Dielectric { ior: 2 } }\n",
       eyes},
      {"InAMirror", 2, 1, "OrthographicCamera { from: [0, 0, -0.5], to: [0, 0, 5], up: [0, 1, 0], width: 0.1 }",
       lamp + sheet("PerfectSpecular {}", 1), eyes},
      {"ThroughGlass", 3, (1 - r) * (1 - r), down,
       lamp + "Box { centre: [0, 0, 1], size: [6, 6, 1], shader: Dielectric { ior: 1.5 } }\n", eyes},
      {"DirectLight", 2, 0.5, under, plate + sun, with_matt},
      {"DirectLightThroughAHole", 2, 0.25, under,
       plate + sun + sheet("MaskShader { shader: Lambertian { color: 0 }, opacity: 0.5 }"), with_matt},
      {"DirectLightThroughAPane", 2, 0.5 * 0.8, under, plate + sun + sheet("ThinDielectric { ior: 1, color: 0.8 }"), with_matt},
      {"DirectLightThroughAMedium",
       2,
       0.5 * std::exp(-1.0),
       under,
       plate + sun +
           "Box { centre: [0, 0, 2], size: [9, 9, 1], shader: PassThrough {}, interior: HomogeneousVolume { absorption: 1 } "
           "}\n",
       {"PathTracer { samples: 16", "BidirectionalPathTracer { samples: 64", "LightTracer { samples: 65536"}},
      {"LitByTheFloor", 3, wall_lit_by_the_floor, along, floor_and_wall + sun, with_media},
      // Single scattering by a thin layer of albedo 1 and optical depth t: (1 - exp(-2 t)) / (8 pi) of the sun's irradiance pi.
      {"ScatteredInAMedium", 2, (1 - std::exp(-0.2)) / 8,
       "OrthographicCamera { from: [0, 0, 5], to: [0, 0, 0], up: [0, 1, 0], width: 2 }",
       sun + "Box { size: [2.02, 2.02, 0.1], shader: PassThrough {}, interior: HomogeneousVolume { scattering: 1 } }\n",
       with_media},
  };
}

class PathLength : public testing::TestWithParam<LengthCase> {};

TEST_P(PathLength, IsCountedInScatterings) {
  const LengthCase& c = GetParam();
  const double expected = c.expected.value();
  for (const std::string& renderer : c.renderers)
    for (const bool enough : {true, false}) {
      const int depth = enough ? c.segments : c.segments - 1;
      if (depth < 1) continue;
      const Measured m =
          measure(job_text(fmt::format("{}, max_depth: {} }}", renderer, depth), c.camera, 4, c.objects, "EmbreeScene"));
      if (enough) {
        EXPECT_NEAR(m.mean.y, expected, 4.5 * m.error + 1e-3 * expected) << renderer;
        EXPECT_LT(m.error, 0.02 * expected) << renderer;
      } else {
        EXPECT_EQ(m.mean.y, 0) << renderer << " at max_depth " << depth;
      }
    }
}

INSTANTIATE_TEST_SUITE_P(Kinds, PathLength, testing::ValuesIn(length_cases()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace etendue::test
