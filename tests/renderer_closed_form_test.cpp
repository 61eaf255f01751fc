// Configurations with a known answer, by every renderer that can find all of their light: the same number must come out
// whichever way paths are built. Each value is held to 0.5 % and to 4.5 standard errors of its own estimate, with fixed
// seeds. The error is taken from the differences of 32 renders with different seeds, which counts whatever correlation
// there is between splats of one path and between low-discrepancy samples (two-sided 9e-5 for each value: Student's
// distribution with 31 degrees of freedom).
//
// Left out, each because it cannot find the light: DirectRenderer where paths are longer than two segments;
// WhittedRenderer where luminaires have an extent or matt surfaces light each other; LightTracer where the camera looks at
// glass, at a surface too small to be met (a point: there the mean over a square is compared instead), or at media that
// emit; PathTracer and DistributionRenderer where a luminaire without extent shines through glass; media for all but
// PathTracer, BidirectionalPathTracer and LightTracer.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numeric>

#include "render_support.h"

namespace etendue::test {
namespace {

constexpr double exact_pi = 3.141592653589793;

struct Way {
  std::string renderer, members;  ///< its class, and further members
  int samples;                    ///< per pixel and render
};

struct Row {
  std::string name, camera, objects;
  double expected;
  std::vector<Way> ways;
  int size = 16;  ///< of the picture, in pixels
};

struct Case {
  Row row;
  Way way;
};

std::vector<Case> cases(const std::vector<Row>& rows) {
  std::vector<Case> list;
  for (const Row& row : rows)
    for (const Way& way : row.ways) list.push_back({row, way});
  return list;
}

void PrintTo(const Case& c, std::ostream* out) { *out << c.way.renderer << " { " << c.way.members << " }"; }

/// Mean Y of the picture over renders with different seeds, and its standard error.
void expect_row(const Case& c) {
  constexpr int renders = 32;
  const Ref<Job> job = load_job_text(job_text(fmt::format("{} {{ samples: {}{}{} }}", c.way.renderer, c.way.samples,
                                                          c.way.members.empty() ? "" : ", ", c.way.members),
                                              c.row.camera, c.row.size, c.row.objects, "EmbreeScene"),
                                     "row.etd");
  std::vector<double> means;
  std::uint64_t bad = 0;
  for (int i = 0; i < renders; ++i) {
    job->seed = std::uint64_t(i + 1);
    job->render();
    const Image image = job->image->develop();
    double sum = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) sum += image.at(x, y, 1);
    means.push_back(sum / (double(image.width) * image.height));
    bad += job->image->bad_samples();
  }
  const double mean = std::accumulate(means.begin(), means.end(), 0.0) / renders;
  double squares = 0;
  for (const double m : means) squares += (m - mean) * (m - mean);
  const double error = std::sqrt(squares / (renders * (renders - 1.0))), expected = c.row.expected;
  EXPECT_EQ(bad, 0u);
  EXPECT_NEAR(mean, expected, 0.005 * expected) << "standard error " << error;
  // What float arithmetic and six digits leave, 1e-4, is all that counts where the error is smaller still.
  EXPECT_NEAR(mean, expected, 4.5 * error + 1e-4 * expected) << "standard error " << error;
}

std::string case_name(const testing::TestParamInfo<Case>& info) {
  return fmt::format("{}_{}_{}", info.param.row.name, info.param.way.renderer, info.index);
}

class Surfaces : public testing::TestWithParam<Case> {};
TEST_P(Surfaces, HaveTheirClosedForm) { expect_row(GetParam()); }

class MediaAndGlass : public testing::TestWithParam<Case> {};
TEST_P(MediaAndGlass, HaveTheirClosedForm) { expect_row(GetParam()); }

const std::string glow = "DiffuseEmission { radiance: 1, sides: both }";
const std::string matt = "shader: Lambertian { color: 1 }";

std::string pinhole(const std::string& from, const std::string& to) {
  return "PerspectiveCamera { from: " + from + ", to: " + to + ", up: [0, 1, 0], fov: 0.01 deg }";
}
/// Sees the square of so many metres around `to`.
std::string square(const std::string& from, const std::string& to, double width) {
  return fmt::format("OrthographicCamera {{ from: {}, to: {}, up: [0, 1, 0], width: {} }}", from, to, width);
}
/// Horizontal, at height z.
std::string plate(double half, double z, const std::string& more = "") {
  return fmt::format("Rectangle {{ corner: [{0}, {0}, {1}], edge_u: [{2}, 0, 0], edge_v: [0, {2}, 0]{3}{4} }}\n", -half, z,
                     2 * half, more.empty() ? "" : ", ", more);
}

/// Mean of f over the square of half a side h around the origin.
template <class F>
double mean_over_square(double h, const F& f) {
  constexpr int steps = 200;
  double sum = 0;
  for (int i = 0; i < steps; ++i)
    for (int k = 0; k < steps; ++k) sum += f(h * ((2 * i + 1.0) / steps - 1), h * ((2 * k + 1.0) / steps - 1));
  return sum / (steps * steps);
}

/// Irradiance by a rectangle a x b of radiance 1 that faces the point under one of its corners from height 1.
double irradiance_at_corner(double a, double b) {
  const double p = std::sqrt(1 + a * a), q = std::sqrt(1 + b * b);
  return 0.5 * (a / p * std::atan(b / p) + b / q * std::atan(a / q));
}

/// Irradiance of the plane through the middle of a sphere of radius 1 and radiance 1, at the distance r: row 9.
double irradiance_beside_sphere(double r) { return std::atan(1 / std::sqrt(r * r - 1)) - std::sqrt(r * r - 1) / (r * r); }

/// Its mean over the square of half a side 3, the sphere itself (which a camera above sees with radiance 1) included,
/// divided by pi. With u = sqrt(r^2 - 1), r dr = u du.
double sphere_on_a_floor() {
  constexpr int steps = 400;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double phi = (i + 0.5) / steps * exact_pi / 4, end = std::sqrt(std::pow(3 / std::cos(phi), 2) - 1);
    for (int k = 0; k < steps; ++k) {
      const double u = (k + 0.5) / steps * end;
      sum += irradiance_beside_sphere(std::sqrt(1 + u * u)) * u * end;
    }
  }
  return (8 * sum * exact_pi / 4 / (steps * steps) / exact_pi + exact_pi) / 36;
}

std::vector<Row> surface_rows() {
  const std::string inside = "PerspectiveCamera { from: [0.3, 0.1, 0.2], to: [0, 0, 1], fov: 90 }";
  const std::string box = R"(TriangleMesh {
      positions: [[-1,-1,-1],[1,-1,-1],[1,1,-1],[-1,1,-1],[-1,-1,1],[1,-1,1],[1,1,1],[-1,1,1]]
      triangles: [[0,1,2],[0,2,3],[4,6,5],[4,7,6],[0,4,5],[0,5,1],[1,5,6],[1,6,2],[2,6,7],[2,7,3],[3,7,4],[3,4,0]]
      shader: Lambertian { color: 0.8 }, emission: )" +
                          glow + " }";
  const std::string endless = "max_depth: 10000", nine = "max_depth: 9", two = "max_depth: 2";
  struct Samples {
    int path, directions, bidirectional, balance, light, distribution, direct, whitted;
  };
  const auto all = [&](const Samples& n) {
    std::vector<Way> ways = {{"PathTracer", two, n.path},
                             {"PathTracer", two + ", next_event: false", n.directions},
                             {"BidirectionalPathTracer", two, n.bidirectional},
                             {"BidirectionalPathTracer", two + ", heuristic: balance", n.balance},
                             {"LightTracer", two, n.light},
                             {"DistributionRenderer", two, n.distribution},
                             {"DirectRenderer", "", n.direct},
                             {"WhittedRenderer", "", n.whitted}};
    std::erase_if(ways, [](const Way& w) { return w.samples == 0; });
    return ways;
  };
  std::vector<Row> rows;

  rows.push_back({"R01_Furnace",
                  inside,
                  "Sphere { radius: 1, shader: Lambertian { color: 0.8 }, emission: DiffuseEmission { radiance: 1, sides: "
                  "back } }",
                  5,
                  {{"PathTracer", endless, 32},
                   {"BidirectionalPathTracer", endless, 8},
                   {"BidirectionalPathTracer", endless + ", heuristic: balance", 8},
                   {"LightTracer", endless, 96},
                   {"DistributionRenderer", endless, 16}}});
  rows.push_back({"R02_FurnaceOfNine",
                  inside,
                  box,
                  5 * (1 - std::pow(0.8, 9)),
                  {{"PathTracer", nine, 8},
                   {"BidirectionalPathTracer", nine, 8},
                   {"LightTracer", nine, 256},
                   {"DistributionRenderer", nine, 4}}});
  rows.push_back({"R02_FurnaceOfTwo", inside, box, 1.8, all({8, 8, 8, 8, 288, 4, 8, 0})});

  const std::string middle =
                        "Point { emission: DiffuseEmission { radiance: 3.14159265 } }\nSphere { radius: 1, shader: Lambertian "
                        "{ color: 0.5 } }",
                    aside = "PerspectiveCamera { from: [0, 0, -0.3], to: [0, 0, -1], fov: 80 }";
  rows.push_back({"R03_PointInSphere",
                  aside,
                  middle,
                  1,
                  {{"PathTracer", endless, 8},
                   {"BidirectionalPathTracer", endless, 4},
                   {"LightTracer", endless, 128},
                   {"DistributionRenderer", endless, 4}}});
  rows.push_back({"R03_PointInSphereDirectly", aside, middle, 0.5, all({8, 0, 8, 8, 256, 4, 8, 1})});

  const std::string receiver = "Rectangle { corner: [0,0,0], edge_u: [1,0,0], edge_v: [0,1,0], " + matt + " }\n";
  rows.push_back({"R04_ParallelSquares", square("[0.5, 0.5, 0.5]", "[0.5, 0.5, 0]", 1),
                  receiver + "Rectangle { corner: [0,0,1], edge_u: [1,0,0], edge_v: [0,1,0], emission: " + glow + " }",
                  0.199825, all({8, 80, 8, 16, 512, 4, 8, 0})});
  rows.push_back({"R05_SquaresAtRightAngles", square("[0.5, 0.5, 5]", "[0.5, 0.5, 0]", 1),
                  receiver + "Rectangle { corner: [0,0,0], edge_u: [0,1,0], edge_v: [0,0,1], emission: " + glow + " }",
                  0.200044, all({8, 64, 8, 24, 512, 4, 8, 0})});
  rows.push_back({"R06_Discs", square("[0, 0, 0.5]", "[0, 0, 0]", 2),  // the picture is the square around the disc
                  "Disc { radius: 1, " + matt + " }\nDisc { radius: 1, transform: translate(0, 0, 1), emission: " + glow + " }",
                  0.381966 * exact_pi / 4, all({16, 128, 16, 16, 160, 8, 16, 0})});

  rows.push_back({"R07_Rectangle", pinhole("[0, 0, 0.5]", "[0, 0, 0]"), plate(9, 0, matt) + plate(1, 1, "emission: " + glow),
                  1.740840 / exact_pi, all({8, 32, 8, 8, 0, 4, 8, 0})});
  rows.push_back({"R07_RectangleOverASquare", square("[0, 0, 0.5]", "[0, 0, 0]", 1),
                  plate(0.5, 0, matt) + plate(1, 1, "emission: " + glow),
                  mean_over_square(0.5,
                                   [](double x, double y) {
                                     double e = 0;
                                     for (const double sx : {-1.0, 1.0})
                                       for (const double sy : {-1.0, 1.0}) e += irradiance_at_corner(1 + sx * x, 1 + sy * y);
                                     return e / exact_pi;
                                   }),
                  all({8, 48, 8, 8, 768, 4, 8, 0})});

  rows.push_back({"R08_Sphere", pinhole("[0, 0.2, 0.5]", "[0, 0, 0]"),
                  plate(1, 0, matt) + "Sphere { center: [0, 0, 3], radius: 1, emission: " + glow + " }", 0.349066 / exact_pi,
                  all({8, 0, 8, 8, 0, 4, 8, 0})});
  // A shell around the sphere has the row's irradiance everywhere.
  rows.push_back({"R08_SphereInAShell", "PerspectiveCamera { from: [0, 0, 1.2], to: [0, 0, 3], fov: 120 }",
                  "Sphere { radius: 3, " + matt + " }\nSphere { radius: 1, emission: DiffuseEmission { radiance: 1 } }",
                  1.0 / 9, all({8, 256, 8, 12, 512, 4, 8, 0})});
  rows.push_back({"R09_HalfASphere", pinhole("[0, 0.2, 0.5]", "[0, 0, 0]"),
                  "Disc { radius: 0.1, " + matt + " }\nSphere { center: [3, 0, 0], radius: 1, emission: " + glow + " }",
                  irradiance_beside_sphere(3) / exact_pi, all({32, 0, 32, 32, 0, 24, 32, 0})});
  rows.push_back({"R09_HalfASphereOverASquare", square("[0, 0, 5]", "[0, 0, 0]", 6),
                  plate(3, 0, matt) + "Sphere { radius: 1, emission: DiffuseEmission { radiance: 1 } }", sphere_on_a_floor(),
                  all({24, 128, 32, 32, 64, 16, 24, 0})});

  // Inclined by 60 degrees, so that an irradiance of 2 across the light is 1 on the plane.
  rows.push_back({"R10_Sun", square("[0, 0, 5]", "[0, 0, 0]", 1.4),
                  plate(0.75, 0, "shader: Lambertian { color: 0.5 }") +
                      "Distant { direction: [0.8660254, 0, -0.5], emission: DiffuseEmission { radiance: 2 } }",
                  0.5 / exact_pi, all({8, 0, 8, 12, 192, 4, 8, 1})});
  const std::pair<int, Samples> phases[] = {{0, {8, 0, 8, 12, 40, 4, 8, 2}},
                                            {45, {8, 0, 8, 16, 64, 4, 8, 4}},
                                            {90, {8, 0, 24, 28, 128, 24, 8, 28}},
                                            {135, {64, 0, 96, 96, 384, 64, 64, 64}}};
  for (const auto& [degrees, samples] : phases) {
    const double a = degrees * exact_pi / 180, intensity = 2.0 / 3 * (std::sin(a) + (exact_pi - a) * std::cos(a)) / exact_pi;
    rows.push_back({fmt::format("R11_SphereAtPhase{}", degrees), square("[0, 0, 5]", "[0, 0, 0]", 2),
                    fmt::format("Sphere {{ radius: 1, {} }}\nDistant {{ direction: [{:.9f}, 0, {:.9f}], emission: {} }}", matt,
                                -std::sin(a), -std::cos(a), glow),
                    intensity / 4, all(samples)});
  }

  // A black disc closes off the cap of 2 % of the sphere's wall; between what is left of the wall light goes as without it.
  // A point in the middle sends out 1 W, of which 1 - f falls on the wall, evenly: the white wall's radiance is
  // rho / (pi A (1 - f)) * (1 - f) * (1 + rho (1 - f) + ...) = rho / (pi A (1 - rho (1 - f))).
  const std::string port =
      "Point { emission: DiffuseEmission { radiance: 0.0795774715 } }\nSphere { radius: 1, shader: "
      "Lambertian { color: 0.98 } }\nDisc { radius: 0.3, transform: translate(0, 0, 0.96) }";
  rows.push_back({"R13_IntegratingSphere",
                  aside,
                  port,
                  0.626861,
                  {{"PathTracer", endless, 48},
                   {"LightTracer", endless, 64},
                   {"DistributionRenderer", endless + ", light_samples: 1, diffuse_samples: 1", 64}}});
  // Up to twelve segments: all of some 25 bounces, each connected to each, would take BidirectionalPathTracer a minute.
  rows.push_back({"R13_IntegratingSphereOfTwelve",
                  aside,
                  port,
                  0.626861 * (1 - std::pow(0.98 * 0.98, 11)),
                  {{"PathTracer", "max_depth: 12", 16},
                   {"BidirectionalPathTracer", "max_depth: 12", 8},
                   {"LightTracer", "max_depth: 12", 96},
                   {"DistributionRenderer", "max_depth: 12", 4}}});
  return rows;
}

/// A slab from z = 0 down to -depth, `half` wide to each side, with a boundary that does nothing.
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

// Fluxes of a beam that falls straight onto a slab, by reciprocity: the share R of it that comes back is the radiance
// straight up under even light of radiance 1 from above, and the share T that gets through that on the other side. The
// light is a wide plate; the camera stands between it and the slab, where nothing sees it.
std::vector<Row> media_and_glass_rows() {
  const std::string endless = "max_depth: 100000";
  const auto three = [&](int path, int bidirectional, int light) {
    std::vector<Way> ways = {
        {"PathTracer", endless, path}, {"BidirectionalPathTracer", endless, bidirectional}, {"LightTracer", endless, light}};
    std::erase_if(ways, [](const Way& w) { return w.samples == 0; });
    return ways;
  };
  // Upwards and downwards: what is within 10 m of the edge is not looked at.
  const double half = 80, seen = 140;
  const std::string from_above = square("[0, 0, 0.05]", "[0, 0, 0]", seen),
                    from_below = square("[0, 0, -1.05]", "[0, 0, 0]", seen);
  const std::string above = plate(half, 0.1, "emission: DiffuseEmission { radiance: 1, sides: back }");
  // Makes a plate of reflectance 1e-5 as bright as its irradiance is, in units of what arrives across the light.
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
  // The beam itself, on a plate that sends next to nothing back (and that roulette must not take for unimportant).
  rows.push_back({"R22_BeamTransmitted",
                  square("[0, 0, -1.05]", "[0, 0, -2]", seen),
                  medium(half, 1, "scattering: 0.9, absorption: 0.1") +
                      plate(half, -1.1, "shader: Lambertian { color: 1e-5 }") + strong_sun,
                  0.59163,
                  {{"PathTracer", endless + ", roulette_depth: 1000", 24},
                   {"BidirectionalPathTracer", endless + ", roulette_depth: 1000", 16},
                   {"LightTracer", endless, 160}}});
  // A medium at the temperature of its surroundings sends out as much as it absorbs: 1 - R - T.
  rows.push_back({"R22_Absorbed", from_above, medium(half, 1, "scattering: 0.9, absorption: 0.1, emission: 0.1"), 0.14096,
                  three(48, 48, 0)});
  rows.push_back({"R19_HalfSpaceFlux", from_above, medium(half, 30, "scattering: 0.9, absorption: 0.1") + above, 0.414948,
                  three(48, 32, 64)});
  // A furnace is one whatever floats in it.
  rows.push_back({"R01_FurnaceWithFog", "PerspectiveCamera { from: [-0.5, 0, 0], to: [1, 0, 0], fov: 90 }",
                  "Sphere { radius: 1, shader: Lambertian { color: 0.5 }, emission: DiffuseEmission { radiance: 1, sides: "
                  "back } }\nSphere { center: [0.4, 0, 0], radius: 0.5, shader: PassThrough {}, interior: HomogeneousVolume { "
                  "scattering: 2 } }",
                  2, three(24, 12, 96)});

  // Glass 1.5 with all internal reflections: seen through it, and as what falls through it on a plate.
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
  // Inside glass: a lamp's radiance leaves as (1 - R) / n^2 of it; light that falls in brings 1 - R of its irradiance.
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

// Where light goes that is bent by glass, in walks from the camera and from luminaires. Each sample is replayed; those that
// met the surfaces in the wanted way tell the direction in which they left the last of them.
struct Walk {
  const char* renderer;
  bool from_camera;
};
void PrintTo(const Walk& w, std::ostream* out) { *out << w.renderer << (w.from_camera ? " from the camera" : " from light"); }

class Refraction : public testing::TestWithParam<Walk> {
 protected:
  /// Directions of the walks that begin at `begin` towards `heading` (a unit vector in the plane z = 0, or along z) and are
  /// then transmitted (t) and reflected (r) as `turns` says, one after the other.
  static std::vector<Vector3> leaving(const std::string& turns, const std::string& objects, const std::array<double, 3>& begin,
                                      const std::array<double, 3>& heading, double width, int samples,
                                      const std::string& wavelengths = "") {
    const auto& [x, y, z] = begin;
    const auto& [dx, dy, dz] = heading;
    const Walk& walk = GetParam();
    const bool along_z = dz != 0;
    // A lamp whose front faces the heading: the cross product of its edges.
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
    const Ref<Job> job = load_job_text(text, "bent.etd");
    std::vector<Vector3> found;
    for (int n = 0; n < samples; ++n) {
      PathRecord record;
      job->replay(n % 2, n / 2 % 2, std::uint32_t(n / 4), record);
      const auto& path = walk.from_camera ? record.vertices : record.light_vertices;
      if (path.size() < turns.size() + 2) continue;
      std::string met;
      Vector3 direction = path[1].position - path[0].position;
      for (size_t i = 1; i <= turns.size(); ++i) {
        const Vector3 next = normalize(path[i + 1].position - path[i].position);
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

// Light that was reflected once inside a drop comes back at all angles up to 42.078 degrees, and most of it close to that.
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
INSTANTIATE_TEST_SUITE_P(Rows, Surfaces, testing::ValuesIn(cases(surface_rows())), case_name);
INSTANTIATE_TEST_SUITE_P(Rows, MediaAndGlass, testing::ValuesIn(cases(media_and_glass_rows())), case_name);

}  // namespace
}  // namespace etendue::test
