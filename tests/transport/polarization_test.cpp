// Polarized light against closed forms: Malus's law, wave plates, Fresnel's equations with Brewster's angle, metals, Rayleigh's
// scattering, two crossed mirrors; the film's layer; and what is said where polarization is not followed.

#include <fmt/format.h>

#include <complex>

#include "check/verify/collect.h"
#include "check/warnings/advice.h"
#include "components/shaders/polarized_fresnel.h"
#include "support/checkpoint_test_support.h"
#include "support/image_means.h"

namespace etendue::checkpoint_test {
namespace {

using Means = std::map<std::string, double>;
using std::numbers::pi;

double rad(double degrees) { return degrees * pi / 180; }

std::string job_text(const std::string& camera, const std::string& objects, int samples,
                     const std::string& renderer = "PolarizedPathTracer", const std::string& members = "",
                     const std::string& layers = R"("stokes")") {
  return fmt::format(R"(Job {{ renderer: {} {{ samples: {} {} }}
      camera: {}
      image: ImageBuffer {{ width: 4, height: 4, filter: BoxFilter {{}}, layers: [{}] }}
      scene: BruteForceScene {{ objects: [ {} ] }} }})",
                     renderer, samples, members, camera, layers, objects);
}

Means render(const std::string& text) {
  const auto done = rendered(load_job_text(text, "test.etd"), two_threads);
  EXPECT_EQ(done->film().bad_samples(), 0u);
  return test::means(done->picture());
}

/// Seen from above: x is to the right, y up, and rectangles show their front.
const std::string from_above = "OrthographicCamera { from: [0, 0, 5], to: [0, 0, 0], up: [0, 1, 0], width: 0.1 }";
/// Seen at this angle from the normal of the plane z = 0, with the plane's y direction away from the camera.
std::string at_angle(double degrees) {
  return fmt::format("OrthographicCamera {{ from: [0, {}, {}], to: [0, 0, 0], up: [0, 1, 0], width: 0.1 }}",
                     -5 * std::sin(rad(degrees)), 5 * std::cos(rad(degrees)));
}
std::string plate(double z, const std::string& shader) {
  return fmt::format("Rectangle {{ corner: [-1, -1, {}], edge_u: [2, 0, 0], edge_v: [0, 2, 0], shader: {} }}\n", z, shader);
}
std::string polarizer(double z, double angle, const std::string& more = "") {
  return plate(z, fmt::format("LinearPolarizer {{ angle: {} {} }}", angle, more));
}
std::string retarder(double z, double angle, double waves) {
  return plate(z, fmt::format("Retarder {{ angle: {}, retardance: {} }}", angle, waves));
}
const std::string sky = "Environment { emission: DiffuseEmission { radiance: 1 } }\n";
constexpr double noise = 4e-3;  // of S0 itself, for the wavelengths of these samples; ratios have none

constexpr double lobe_noise = 4e-2;  // where reflection or refraction is chosen at random

void expect_stokes(const Means& m, double s0, double s1, double s2, double s3, const std::string& what,
                   double s0_noise = noise) {
  const double y = m.at("Y");
  EXPECT_NEAR(y, s0, s0_noise * std::max(s0, 0.1)) << what;
  if (s0 < 1e-6) return;
  EXPECT_NEAR(m.at("S1.Y") / y, s1 / s0, 2e-5) << what;
  EXPECT_NEAR(m.at("S2.Y") / y, s2 / s0, 2e-5) << what;
  EXPECT_NEAR(m.at("S3.Y") / y, s3 / s0, 2e-5) << what;
  EXPECT_NEAR(m.at("polarization.linear"), std::hypot(s1, s2) / s0, 2e-5) << what;
  EXPECT_NEAR(m.at("polarization.circular"), s3 / s0, 2e-5) << what;
}

// Malus 1809: of light polarized at the angle b a polarizer at a lets cos^2 (a - b) pass.
TEST(Polarization, MalussLaw) {
  for (const double a : {0.0, 30.0, 135.0})
    for (const double b : {0.0, 10.0, 90.0, 150.0}) {
      const double left = 0.5 * std::pow(std::cos(rad(a - b)), 2);
      const Means m = render(job_text(from_above, polarizer(2, a) + polarizer(1, b) + sky, 64));
      expect_stokes(m, left, left * std::cos(rad(2 * a)), left * std::sin(rad(2 * a)), 0, fmt::format("{} {}", a, b));
      if (left > 0.01) EXPECT_NEAR(std::remainder(m.at("polarization.angle") - a, 180), 0, 1e-3) << b;
    }
  // Three polarizers at 0, 45 and 90 degrees let an eighth pass, where the outer two alone let nothing pass.
  expect_stokes(render(job_text(from_above, polarizer(3, 90) + polarizer(2, 45) + polarizer(1, 0) + sky, 64)), 0.125, -0.125, 0,
                0, "three");
  // Sheets that are not ideal.
  const std::string real = ", transmitted: 0.8, leaked: 0.1";
  expect_stokes(render(job_text(from_above, polarizer(2, 0, real) + polarizer(1, 90, real) + sky, 64)), 0.08, 0, 0, 0, "real");
}

// Light at 45 degrees to the fast axis of a quarter-wave plate leaves left circular, at -45 degrees right circular; a half-wave
// plate mirrors the polarization at its axis; the light of a delta lamp passes plates too.
TEST(Polarization, WavePlates) {
  expect_stokes(render(job_text(from_above, retarder(2, 0, 0.25) + polarizer(1, 45) + sky, 64)), 0.5, 0, 0, -0.5, "left");
  expect_stokes(render(job_text(from_above, retarder(2, 0, 0.25) + polarizer(1, -45) + sky, 64)), 0.5, 0, 0, 0.5, "right");
  expect_stokes(render(job_text(from_above, retarder(2, 30, 0.5) + polarizer(1, 0) + sky, 64)), 0.5, 0.5 * std::cos(rad(120)),
                0.5 * std::sin(rad(120)), 0, "half a wave");
  // Between crossed polarizers sin^2 (phi / 2) passes.
  for (const double waves : {0.1, 0.25, 0.4})
    expect_stokes(render(job_text(from_above, polarizer(3, 0) + retarder(2, 45, waves) + polarizer(1, 90) + sky, 64)),
                  0.5 * std::pow(std::sin(pi * waves), 2), 0.5 * std::pow(std::sin(pi * waves), 2), 0, 0, "between");
  // A quarter-wave plate, a mirror, and back through both: nothing, as the circular light has changed its hand. Without the
  // plate all comes back.
  const std::string mirror = plate(0, "PerfectSpecular {}"), lamp = plate(4, "PassThrough {}");
  expect_stokes(render(job_text(from_above, polarizer(2, 45) + retarder(1, 0, 0.25) + mirror + sky, 64)), 0, 0, 0, 0,
                "isolator");
  expect_stokes(render(job_text(from_above, polarizer(2, 45) + mirror + sky, 64)), 0.5, 0, 0.5, 0, "mirror");
}

TEST(Polarization, OfShadowRays) {
  const std::string floor = plate(0, "Lambertian { color: 0.5 }"),
                    sun = "Distant { direction: [1, 0, -1], emission: DiffuseEmission { radiance: 3 } }\n";
  const std::string sheets =
      R"(Rectangle { corner: [-4, -1, 1.5], edge_u: [3, 0, 0], edge_v: [0, 2, 0], shader: LinearPolarizer { angle: 0 } }
      Rectangle { corner: [-4, -1, 1], edge_u: [3.5, 0, 0], edge_v: [0, 2, 0], shader: LinearPolarizer { angle: 90 } }
      )";
  const double open = render(job_text(from_above, floor + sun, 64)).at("Y");
  EXPECT_GT(open, 0.1);
  // The sheets lie at a slant, but their axes are in the plane of the ray and across it.
  EXPECT_NEAR(render(job_text(from_above, floor + sun + sheets, 64)).at("Y"), 0, 1e-6);
  EXPECT_NEAR(render(job_text(from_above, floor + sun + sheets, 64, "PathTracer", "", "")).at("Y"), open / 4, 1e-5);
}

struct Fresnel {
  double s, p;
};
/// Fresnel's reflectances for real indices (Born & Wolf 1999, section 1.5.2, eq. 21a).
Fresnel fresnel(double degrees, double n) {
  const double i = rad(degrees), t = std::asin(std::sin(i) / n);
  if (degrees == 0) return {std::pow((n - 1) / (n + 1), 2), std::pow((n - 1) / (n + 1), 2)};
  return {std::pow(std::sin(i - t) / std::sin(i + t), 2), std::pow(std::tan(i - t) / std::tan(i + t), 2)};
}

// The light that glass and plastic reflect; at Brewster's angle it is polarized completely. The horizontal direction of the
// picture is that of s.
TEST(Polarization, ReflectionOfDielectrics) {
  const double brewster = std::atan(1.5) * 180 / pi;
  for (const double angle : {0.0, 20.0, 45.0, brewster, 75.0}) {
    const Fresnel r = fresnel(angle, 1.5);
    for (const std::string shader :
         {"Plastic { color: 0, ior: 1.5, roughness: 0 }", "Dielectric { ior: 1.5 }",
          "MixShader { first: Dielectric { ior: 1.5 }, second: Dielectric { ior: 1.5 }, amount: 0.3 }",
          "TwoSidedShader { front: Plastic { color: 0, ior: 1.5, roughness: 0 }, back: Lambertian {} }"})
      expect_stokes(render(job_text(at_angle(angle), plate(0, shader) + plate(-0.1, "Lambertian { color: 0 }") + sky, 256)),
                    (r.s + r.p) / 2, (r.s - r.p) / 2, 0, 0, fmt::format("{} {}", shader, angle), lobe_noise);
  }
  const Means m = render(job_text(at_angle(brewster), plate(0, "Plastic { color: 0, ior: 1.5, roughness: 0 }") + sky, 64));
  EXPECT_NEAR(m.at("polarization.linear"), 1, 1e-5);
}

// Through a pane, T_s = (1 - R_s) / (1 + R_s) and the same for p (Stokes 1862), and what it reflects is the rest.
TEST(Polarization, OfPanes) {
  const std::string pane = plate(0, "ThinDielectric { ior: 1.5 }"), black = plate(-0.1, "Lambertian { color: 0 }");
  for (const double angle : {0.0, 45.0, 70.0}) {
    const Fresnel r = fresnel(angle, 1.5);
    const double s = 2 * r.s / (1 + r.s), p = 2 * r.p / (1 + r.p);
    expect_stokes(render(job_text(at_angle(angle), pane + black + sky, 256)), (s + p) / 2, (s - p) / 2, 0, 0,
                  fmt::format("reflected {}", angle), lobe_noise);
    // What passes the pane is polarized the other way, so that all light together is not: in the mean over both.
    const Means all = render(job_text(at_angle(angle), pane + sky, 4096));
    EXPECT_NEAR(all.at("Y"), 1, noise);
    EXPECT_NEAR(all.at("S1.Y"), 0, 1e-3) << angle;
  }
}

// What a metal does to light that was polarized at 45 degrees to the plane of incidence: Fresnel's coefficients r_s, r_p in
// complex numbers (Born & Wolf 1999, section 14.2), written as tan psi e^(i delta) = r_p / r_s, and S in terms of them:
// S1 = cos 2 psi, S2 = sin 2 psi cos delta, S3 = -sin 2 psi sin delta, for x = s (Azzam & Bashara 1977, Ellipsometry).
TEST(Polarization, OfMetals) {
  using Complex = std::complex<double>;
  const Complex n(0.2, 3.5);
  for (const double angle : {30.0, 60.0, 80.0}) {
    const Complex c = std::cos(rad(angle)), t = std::sqrt(1.0 - std::pow(std::sin(rad(angle)) / n, 2));
    const Complex rs = (c - n * t) / (c + n * t), rp = (n * c - t) / (n * c + t), ratio = rp / rs;
    const double psi = std::atan(std::abs(ratio)), delta = std::arg(ratio), all = (std::norm(rs) + std::norm(rp)) / 4;
    // A polarizer before the mirror, at 45 degrees to s, that is perpendicular to the light which comes from behind it.
    const double y = std::sin(rad(angle)), z = std::cos(rad(angle));
    const std::string sheet = fmt::format(
        "Rectangle {{ corner: [-1, {}, {}], edge_u: [2, 0, 0], edge_v: [0, {}, {}], shader: LinearPolarizer {{ angle: 45 }} "
        "}}\n",
        2 * y - z, 2 * z + y, 2 * z, -2 * y);
    const Means m =
        render(job_text(at_angle(angle), plate(0, "Conductor { ior: complex(0.2, 3.5), roughness: 0 }") + sheet + sky, 64));
    // The light travels along (0, -y, -z), in which the sheet's front, of normal u x v = -(0, y, z), lies ahead: seen by the
    // receiver its angle is 45 degrees from s = x towards v, and p = d x s has the direction (0, -z, y) = -v.
    const double sign = -1;
    expect_stokes(m, all, all * std::cos(2 * psi), sign * all * std::sin(2 * psi) * std::cos(delta),
                  -sign * all * std::sin(2 * psi) * std::sin(delta), fmt::format("{}", angle));
  }
}

// Two total reflections of Fresnel's rhomb turn linear into circular light: tan(delta / 2) = cos i sqrt(sin^2 i - 1/n^2) /
// sin^2 i (Born & Wolf 1999, section 1.5.4), with 1.51 a phase of 45 degrees each at 54.62 degrees.
TEST(Polarization, FresnelsRhomb) {
  const float cosine = float(std::cos(rad(54.62)));
  const polarized::Amplitudes a = polarized::reflected(cosine, 1 / 1.51f);
  EXPECT_NEAR(std::abs(a.s), 1, 1e-6);
  EXPECT_NEAR(std::abs(a.p), 1, 1e-6);
  EXPECT_NEAR(std::abs(std::arg(a.p / a.s)) * 180 / pi, 45, 0.05);
  Mueller m;
  polarized::set_mueller(m, 0, a);
  const Mueller twice = m * m;
  EXPECT_NEAR(twice(2, 2)[0], 0, 2e-3);
  EXPECT_NEAR(std::abs(twice(3, 2)[0]), 1, 1e-5);
}

// One scattering by small particles polarizes by (1 - c^2) / (1 + c^2), across the plane of scattering; Chandrasekhar's gamma
// lessens it.
TEST(Polarization, OfRayleighScattering) {
  for (const double depolarization : {0.0, 0.1})
    for (const double angle : {20.0, 60.0, 90.0, 130.0}) {
      const double c = std::cos(rad(angle)), gamma = depolarization / (2 - depolarization);
      const std::string fog = fmt::format(
          "Sphere {{ radius: 1, shader: PassThrough {{}}, interior: HomogeneousVolume {{ scattering: 0.1, absorption: 0, "
          "phase: "
          "RayleighPhase {{ depolarization: {} }} }} }}\n",
          depolarization);
      // The camera sees light that travels along +z; the sun's travels at the angle from that, in the vertical plane.
      const std::string sun = fmt::format("Distant {{ direction: [0, {}, {}], emission: DiffuseEmission {{ radiance: 3 }} }}\n",
                                          std::sin(rad(angle)), c);
      const Means m = render(job_text(from_above, fog + sun, 64, "PolarizedPathTracer", ", max_depth: 2"));
      EXPECT_GT(m.at("Y"), 1e-4);
      const double degree = (1 - gamma) * (1 - c * c) / (1 + c * c + gamma * (3 - c * c));
      EXPECT_NEAR(m.at("S1.Y") / m.at("Y"), degree, 1e-4) << angle;
      EXPECT_NEAR(m.at("S2.Y") / m.at("Y"), 0, 1e-4) << angle;
    }
}

/// Two black mirrors at Brewster's angle, one after the other, the planes of incidence of which are perpendicular.
const std::string crossed_mirrors = [] {
  // The camera looks along -z; the first mirror turns its rays by 180 - 2 * 56.31 degrees in the plane x = 0.
  const double b = std::atan(1.5), turn = pi - 2 * b;
  const double y = std::sin(turn), z = -std::cos(turn);  // the direction after the first mirror
  // Its normal halves the angle between the ray backwards and the ray onwards.
  const auto mirror = [](double px, double py, double pz, double nx, double ny, double nz) {
    // Two vectors that span the plane.
    const double length = std::sqrt(nx * nx + ny * ny + nz * nz);
    nx /= length, ny /= length, nz /= length;
    const bool flat = std::abs(nx) < 0.9;
    double ux = flat ? 0 : -nz, uy = flat ? nz : 0, uz = flat ? -ny : nx;
    const double u = std::sqrt(ux * ux + uy * uy + uz * uz);
    ux /= u, uy /= u, uz /= u;
    const double vx = ny * uz - nz * uy, vy = nz * ux - nx * uz, vz = nx * uy - ny * ux;
    return fmt::format(
        "Rectangle {{ corner: [{}, {}, {}], edge_u: [{}, {}, {}], edge_v: [{}, {}, {}], shader: Plastic {{ color: 0, ior: 1.5, "
        "roughness: 0 }} }}\n",
        px - ux - vx, py - uy - vy, pz - uz - vz, 2 * ux, 2 * uy, 2 * uz, 2 * vx, 2 * vy, 2 * vz);
  };
  // The second mirror, 3 m on, turns the rays about the axis that lies in the first plane and is perpendicular to them: into x.
  const double ex = std::sin(turn), ey = std::cos(turn) * y, ez = std::cos(turn) * z;
  return mirror(0, 0, 0, 0, y, z + 1) + mirror(0, 3 * y, 3 * z, ex, ey - y, ez - z);
}();

// Each mirror reflects R_s / 2 of unpolarized light, polarized across its plane of incidence, of which the other reflects
// nothing. A renderer of unpolarized light shows R^2.
TEST(Polarization, CrossedMirrorsAreBlack) {
  const double half = fresnel(std::atan(1.5) * 180 / pi, 1.5).s / 2;
  EXPECT_NEAR(render(job_text(from_above, crossed_mirrors + sky, 64)).at("Y"), 0, 1e-7);
  EXPECT_NEAR(render(job_text(from_above, crossed_mirrors + sky, 64, "PathTracer", "", "")).at("Y"), half * half,
              noise * half * half);
}

/// A room with all that polarizes and diffuse walls.
const std::string room = R"(
  Rectangle { corner: [-2, -2, -1], edge_u: [4, 0, 0], edge_v: [0, 4, 0], shader: Plastic { color: 0.5, roughness: 0.2 } }
  Rectangle { corner: [-2, 2, -1], edge_u: [4, 0, 0], edge_v: [0, 0, 3], shader: Lambertian { color: 0.7 } }
  Sphere { centre: [-0.4, 0, 0], radius: 0.3, shader: Conductor { roughness: 0.2 } }
  Sphere { centre: [0.4, 0, 0], radius: 0.3, shader: Dielectric { ior: 1.5, roughness: 0.1 } }
  Rectangle { corner: [-0.5, -1.5, 2], edge_u: [1, 0, 0], edge_v: [0, 1, 0], emission: DiffuseEmission { radiance: 5, sides: both } }
  Rectangle { corner: [-0.6, -1.6, 1.9], edge_u: [0.6, 0, 0], edge_v: [0, 1.2, 0], shader: LinearPolarizer { angle: 30 } }
)";
const std::string into_room = "PerspectiveCamera { from: [0.2, -3, 1], to: [0, 0, 0], up: [0, 0, 1], fov: 40 }";

// Luminaires are found by sampling them and by hitting them: both give the same Stokes vector. Standard errors are a third of
// the tolerance or less.
TEST(Polarization, StrategiesAgree) {
  const Means both = render(job_text(into_room, room, 2048)),
              hits = render(job_text(into_room, room, 8192, "PolarizedPathTracer", ", next_event: false"));
  for (const char* channel : {"Y", "S1.Y", "S2.Y", "S3.Y"})
    EXPECT_NEAR(both.at(channel), hits.at(channel), 0.03 * both.at("Y")) << channel;
  EXPECT_GT(std::abs(both.at("S1.Y")), 0.02 * both.at("Y"));
}

// Where all surfaces depolarize, the picture is that of PathTracer: the same paths, and so the same noise.
TEST(Polarization, OfDiffuseSurfacesIsNone) {
  const std::string walls = R"(Sphere { radius: 3, shader: Lambertian { color: 0.6 } }
      Sphere { centre: [0, 0, 0.5], radius: 0.5, shader: OrenNayar {}, interior: HomogeneousVolume { scattering: 1 } }
      Sphere { centre: [0, 1, 1], radius: 0.2, emission: DiffuseEmission { radiance: 5 } })";
  const Means polarized = render(job_text(into_room, walls, 64)),
              plain = render(job_text(into_room, walls, 64, "PathTracer", "", ""));
  EXPECT_NEAR(polarized.at("Y"), plain.at("Y"), 1e-5 * plain.at("Y"));
  for (const char* channel : {"S1.Y", "S2.Y", "S3.Y"}) EXPECT_EQ(polarized.at(channel), 0) << channel;
}

// The layer is a sum like the picture: parts rendered apart and merged, in any order, have the same bytes.
TEST_F(CheckpointTest, StokesVectorsAreMergedExactly) {
  const int samples = step + 8;
  const auto job = [&] {
    const std::string scene = plate(0, "Conductor { roughness: 0.3 }") + polarizer(1, 30) + sky;
    const Ref<Job> whole = job_of(job_text(into_room, scene, samples), samples);
    whole->image->width = whole->image->height = 2;
    return whole;
  };
  const auto whole = rendered(job(), two_threads);
  std::vector<std::string> parts;
  for (const unsigned i : {1u, 0u}) parts.push_back(part(job(), fmt::format("p{}.etck", i), IndexRange{i, i + 1}));
  expect_same(merge_checkpoints(parts), *whole);
}

TEST(Polarization, IsRefusedOrToldWhereItIsNotFollowed) {
  const std::string refusal = complaint([] { render(job_text(from_above, sky, 1, "PathTracer")); });
  EXPECT_TRUE(has(refusal, "PathTracer does not tell the polarization") && has(refusal, "PolarizedPathTracer")) << refusal;
  EXPECT_EQ(complaint([] { render(job_text(from_above, sky, 1, "AdaptiveSampling", ", inner: PolarizedPathTracer {}")); }), "");

  const auto lines = [](const std::string& renderer, const std::string& objects) {
    const Ref<Job> job = load_job_text(job_text(from_above, objects, 1, renderer, "", ""), "test.etd");
    prepare_tree(*job);
    std::string all;
    for (const std::string& line : advice_lines(*job)) all += line + "\n";
    return all;
  };
  const std::string sheet = polarizer(1, 0), masked = plate(2, "MaskShader { shader: Retarder {} }");
  for (const char* renderer : {"PathTracer", "BidirectionalPathTracer", "PhotonMapper"}) {
    EXPECT_TRUE(has(lines(renderer, sheet + masked + sky), "takes all light for unpolarized")) << renderer;
    EXPECT_FALSE(has(lines(renderer, plate(0, "Dielectric {}") + sky), "polarized")) << renderer;
  }
  EXPECT_FALSE(has(lines("PolarizedPathTracer", sheet + sky), "polarized"));

  const auto candidates = [](const std::string& renderer, const std::string& objects) {
    const Ref<Job> job = load_job_text(job_text(from_above, objects, 1, renderer, "", ""), "test.etd");
    prepare_tree(*job);
    std::string all;
    for (const verify::Candidate& c : verify::choose_renderers(*job, std::string(), false).candidates) all += c.name + " ";
    return all;
  };
  EXPECT_FALSE(has(candidates("PathTracer", plate(0, "Dielectric {}") + sky), "PolarizedPathTracer"));
  EXPECT_EQ(candidates("PolarizedPathTracer", sheet + sky), "PolarizedPathTracer ");
}

}  // namespace
}  // namespace etendue::checkpoint_test
