// Media and glass with a known answer, by every renderer that can find all of their light.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/closed_form_rows.h"

namespace etendue::closed_form {
namespace {

/// A slab from z = 0 down to -depth, `half` wide to each side.
std::string slab(double half, double depth, const std::string& shader) {
  std::string points;
  for (const double z : {-depth, 0.0})
    for (const auto& [x, y] : {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)})
      points += fmt::format("{}[{}, {}, {}]", points.empty() ? "" : ", ", x * half, y * half, z);
  return "TriangleMesh { positions: [" + points +
         "], triangles: [[0,2,1],[0,3,2],[4,5,6],[4,6,7],[0,5,4],[0,1,5],[1,6,5],[1,2,6],[2,7,6],[2,3,7],[3,4,7],[3,0,4]], " +
         shader + " }\n";
}
std::string medium(double half, double depth, const std::string& volume) {
  return slab(half, depth, "shader: PassThrough {}, interior: HomogeneousVolume { " + volume + " }");
}

// Fluxes of a beam perpendicular to a slab, by reciprocity: the reflected fraction R is the radiance straight up under uniform
// light of radiance 1 from above, and the transmitted fraction T is that on the other side. The light is a wide plate; the
// camera is between the plate and the slab, where it is not visible.
std::vector<Row> media_and_glass_rows() {
  const std::string endless = "max_depth: 100000";
  const auto three = [&](int path, int bidirectional, int light) {
    std::vector<Way> ways = {
        {"PathTracer", endless, path}, {"BidirectionalPathTracer", endless, bidirectional}, {"LightTracer", endless, light}};
    std::erase_if(ways, [](const Way& w) { return w.samples == 0; });
    return ways;
  };
  // The width of the view, upwards and downwards: the outer 10 m of the slab are not seen.
  const double half = 80, seen = 140;
  const std::string from_above = square("[0, 0, 0.05]", "[0, 0, 0]", seen),
                    from_below = square("[0, 0, -1.05]", "[0, 0, 0]", seen);
  const std::string above = plate(half, 0.1, "emission: DiffuseEmission { radiance: 1, sides: back }");
  // With this sun, the radiance of a plate of reflectance 1e-5 is its irradiance relative to that perpendicular to the sun's
  // rays.
  const std::string strong_sun = "Distant { direction: [0, 0, -1], emission: DiffuseEmission { radiance: 314159.265 } }";
  std::vector<Row> rows;
  const struct {
    const char *name, *volume;
    double reflected, transmitted;
  } slabs[] = {{"R20_Albedo1", "scattering: 1", 0.34133, 0.65867},
               {"R22_Albedo09", "scattering: 0.9, absorption: 0.1", 0.26741, 0.59163}};
  for (const auto& s : slabs) {
    const std::string m = medium(half, 1, s.volume);
    rows.push_back({fmt::format("{}_Reflected", s.name), from_above, m + above, s.reflected, three(80, 64, 128)});
    rows.push_back({fmt::format("{}_Transmitted", s.name), from_below, m + above, s.transmitted, three(32, 48, 48)});
  }
  // Light from both sides: R + T, which is 1 as nothing is absorbed.
  rows.push_back({"R20_Both", from_above, medium(half, 1, "scattering: 1") + above + plate(half, -1.1, "emission: " + glow), 1,
                  three(16, 64, 96)});
  rows.push_back({"R20_BothForwards", from_above,
                  medium(half, 1, "scattering: 1, anisotropy: 0.7") + above + plate(half, -1.1, "emission: " + glow), 1,
                  three(16, 32, 112)});
  // The beam itself, on a plate of low reflectance (Russian roulette must not end paths there for their low throughput).
  rows.push_back({"R22_BeamTransmitted",
                  square("[0, 0, -1.05]", "[0, 0, -2]", seen),
                  medium(half, 1, "scattering: 0.9, absorption: 0.1") +
                      plate(half, -1.1, "shader: Lambertian { color: 1e-5 }") + strong_sun,
                  0.59163,
                  {{"PathTracer", endless + ", roulette_depth: 1000", 24},
                   {"BidirectionalPathTracer", endless + ", roulette_depth: 1000", 16},
                   {"LightTracer", endless, 160}}});
  // A medium at the temperature of its surroundings emits as much as it absorbs: 1 - R - T.
  rows.push_back({"R22_Absorbed", from_above, medium(half, 1, "scattering: 0.9, absorption: 0.1, emission: 0.1"), 0.14096,
                  three(48, 48, 0)});
  rows.push_back({"R19_HalfSpaceFlux", from_above, medium(half, 30, "scattering: 0.9, absorption: 0.1") + above, 0.414948,
                  three(48, 32, 64)});
  // The radiance in a furnace is independent of non-absorbing media in it.
  rows.push_back({"R01_FurnaceWithFog", "PerspectiveCamera { from: [-0.5, 0, 0], to: [1, 0, 0], fov: 90 }",
                  "Sphere { radius: 1, shader: Lambertian { color: 0.5 }, emission: DiffuseEmission { radiance: 1, sides: "
                  "back } }\nSphere { centre: [0.4, 0, 0], radius: 0.5, shader: PassThrough {}, interior: HomogeneousVolume { "
                  "scattering: 2 } }",
                  2, three(24, 12, 96)});

  // Glass of index 1.5 with all internal reflections: a plate seen through it, and the light through it on a plate.
  const std::string glass = slab(40, 1, "shader: Dielectric { ior: 1.5 }");
  rows.push_back({"R32_SeenThroughGlass",
                  square("[0, 0, 3]", "[0, 0, 0]", 1),
                  glass + plate(3, -3, "emission: " + glow),
                  0.923077,
                  {{"PathTracer", endless, 8},
                   {"BidirectionalPathTracer", endless, 8},
                   {"DistributionRenderer", endless, 4},
                   {"WhittedRenderer", "max_depth: 16", 1}}});
  rows.push_back({"R32_LitThroughGlass",
                  square("[0, 0, -1.5]", "[0, 0, -2]", 79),
                  glass + plate(40, -2, "shader: Lambertian { color: 1e-5 }") + strong_sun,
                  0.923077,
                  {{"BidirectionalPathTracer", endless, 64}, {"LightTracer", endless, 40}}});
  // Inside glass: the radiance of a lamp leaves as (1 - R) / n^2 of it; light from outside arrives with 1 - R of its
  // irradiance.
  rows.push_back({"R28_LampInGlass",
                  square("[0, 0, 3]", "[0, 0, 0]", 1),
                  glass + plate(3, -0.5, "emission: " + glow),
                  0.96 / 2.25,
                  {{"PathTracer", endless, 16},
                   {"BidirectionalPathTracer", endless, 16},
                   {"DistributionRenderer", endless, 8},
                   {"WhittedRenderer", "", 1}}});
  rows.push_back({"R28_PlateInGlass",
                  square("[0, 0, -0.3]", "[0, 0, -1]", 78),
                  glass + plate(39.5, -0.5, "shader: Lambertian { color: 1e-5 }") + strong_sun,
                  0.96,
                  {{"BidirectionalPathTracer", endless, 64}, {"LightTracer", endless, 40}}});
  return rows;
}

class MediaAndGlass : public testing::TestWithParam<Case> {};
TEST_P(MediaAndGlass, HaveTheirClosedForm) { expect_row(GetParam()); }
INSTANTIATE_TEST_SUITE_P(Rows, MediaAndGlass, testing::ValuesIn(cases(media_and_glass_rows())), case_name);

}  // namespace
}  // namespace etendue::closed_form
