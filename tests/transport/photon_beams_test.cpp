// Photon beams: rays find the beams they pass, and the estimate agrees with closed forms (see closed_form_rows.h).

#include "etendue/render/photon_beams.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "support/closed_form_rows.h"

namespace etendue::closed_form {
namespace {

struct AllAlike final : NumberSource {
  float number(SampleKey, std::uint32_t) const override { return 0.25f; }
  Point2 pair(SampleKey, std::uint32_t) const override { return {0.25f, 0.25f}; }
};

// The reference is computed in double precision for every pair of a beam and a ray: two equations give the nearest points of
// both lines, since the segment between these points is perpendicular to both.
TEST(BeamMap, finds_all_that_pass_a_ray_and_each_once) {
  const AllAlike alike;
  int passed = 0;
  for (const auto& [count, radius] : {std::pair(1, 0.1f), std::pair(9, 0.3f), std::pair(2000, 0.02f), std::pair(300, 0.4f)}) {
    std::mt19937 random(unsigned(count) + 1);
    std::uniform_real_distribution<float> u(-1, 1);
    const auto direction = [&](int n) {
      if (n % 5 == 1) return Vector3{0, n % 2 ? 1.0f : -1.0f, 0};  // along an axis
      return normalize(Vector3{u(random), u(random), u(random)});
    };
    std::vector<PhotonBeam> beams(size_t(count), PhotonBeam{});
    for (int i = 0; i < count; ++i) {
      PhotonBeam& b = beams[size_t(i)];
      b.origin = {u(random), u(random), u(random)};
      b.direction = direction(i);
      b.length = i % 3 ? 1 + u(random) : 0.05f;
      b.vertices = std::uint32_t(i);
    }
    BeamMap map;
    map.build(std::vector<PhotonBeam>(beams), radius);
    ASSERT_EQ(map.size(), size_t(count));
    for (int n = 0; n < 100; ++n) {
      Ray ray;
      ray.origin = {2 * u(random), 2 * u(random), 2 * u(random)};
      ray.direction = direction(n);
      const float reach = n % 4 ? infinity : 1;
      std::vector<int> found(size_t(count), 0), truth(size_t(count), 0);
      NumberStream numbers(alike, SampleKey(1, 0, 0, 0));
      const auto at = [](const auto& v) { return std::array{double(v.x), double(v.y), double(v.z)}; };
      const auto dot3 = [](const auto& a, const auto& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
      const auto d = at(ray.direction), c = at(ray.origin);
      map.along(ray, reach, numbers, [&](const PhotonBeam& b, float s, float t, float width) {
        ++found[b.vertices];
        const auto e = at(b.direction);
        const double sine = std::sqrt(std::max(0.0, dot3(d, d) * dot3(e, e) - dot3(d, e) * dot3(d, e)));
        if (sine > 0.01) {
          EXPECT_NEAR(double(width), 2 * double(radius) * sine, 1e-4 * double(radius));
          // These are the ends of the shortest segment between the lines.
          EXPECT_LT(length(ray(t) - (b.origin + s * b.direction)), radius + 1e-5f);
        }
      });
      for (int i = 0; i < count; ++i) {
        const auto e = at(beams[size_t(i)].direction), o = at(beams[size_t(i)].origin);
        const std::array w{o[0] - c[0], o[1] - c[1], o[2] - c[2]};
        const double de = dot3(d, e), dw = dot3(d, w), ew = dot3(e, w), det = dot3(d, d) * dot3(e, e) - de * de;
        if (det < 1e-4) {
          found[size_t(i)] = 0;  // parallel beams are tested by the closed forms below
          continue;
        }
        const double t = (dw * dot3(e, e) - de * ew) / det, s = (de * dw - dot3(d, d) * ew) / det;
        double squared = 0;
        for (size_t k = 0; k < 3; ++k) squared += std::pow(w[k] + s * e[k] - t * d[k], 2);
        const double apart = std::sqrt(squared), r = double(radius), end = double(beams[size_t(i)].length);
        // Pairs that rounding decides are left out.
        if (std::abs(apart - r) < 1e-5 || std::abs(s) < 1e-5 || std::abs(s - end) < 1e-5 || std::abs(t) < 1e-5 ||
            std::abs(t - double(reach)) < 1e-5) {
          found[size_t(i)] = 0;
          continue;
        }
        truth[size_t(i)] = apart < r && s > 0 && s < end && t > 0 && t < double(reach);
        passed += truth[size_t(i)];
      }
      ASSERT_EQ(found, truth) << count << " beams, ray " << n;
    }
  }
  EXPECT_GT(passed, 400);
}

std::vector<Row> beam_rows() {
  const auto fog = [](double half, double depth, const std::string& medium) {
    return fmt::format(
        "Box {{ centre: [0, 0, {}], size: [{}, {}, {}], shader: PassThrough {{}}, interior: HomogeneousVolume {{ {} }} }}\n",
        -depth / 2, 2 * half, 2 * half, depth, medium);
  };
  const auto sun = [](const char* direction) {
    return fmt::format("Distant {{ direction: {}, emission: DiffuseEmission {{ radiance: 1 }} }}\n", direction);
  };
  const auto by_beams = [](int depth, double radius, int walks, const char* more = "") {
    return fmt::format("max_depth: {}, radius: {}, media: beams, beam_walks: {}, photon_walks: 1{}", depth, radius, walks,
                       more);
  };
  const std::string above = square("[0, 0, 2]", "[0, 0, 0]", 1.6), below = square("[0, 0, -3]", "[0, 0, 0]", 1.6);
  std::vector<Row> rows;
  // Single scattering in a slab of optical thickness 1. All beams are parallel to all camera rays, in or against their
  // direction.
  const std::string thin = fog(1, 1, "scattering: 1");
  rows.push_back({"ScatteredBack",
                  above,
                  thin + sun("[0, 0, -1]"),
                  (1 - std::exp(-2.0)) / (8 * exact_pi),
                  {{"ProgressivePhotonMapper", by_beams(2, 2, 4000), 4}}});
  rows.push_back({"ScatteredOn",
                  below,
                  thin + sun("[0, 0, -1]"),
                  std::exp(-1.0) / (4 * exact_pi),
                  {{"ProgressivePhotonMapper", by_beams(2, 2, 4000), 4}}});
  // Oblique beams, with cosine m = 0.8: int_0^1 exp(-z / m) exp(-z) dz / (4 pi).
  rows.push_back({"ScatteredUp",
                  square("[0, 0, 2]", "[0, 0, 0]", 1.2),
                  fog(1.5, 1, "scattering: 1") + sun("[0.6, 0, -0.8]"),
                  (1 - std::exp(-2.25)) / (2.25 * 4 * exact_pi),
                  {{"ProgressivePhotonMapper", by_beams(2, 2, 8000), 4}}});
  // A slab of optical thickness 4, which few beams cross.
  rows.push_back({"ScatteredOnInThickFog",
                  square("[0, 0, -6]", "[0, 0, 0]", 1),
                  fog(2, 4, "scattering: 1") + sun("[0, 0, -1]"),
                  std::exp(-4.0) / exact_pi,
                  {{"ProgressivePhotonMapper", by_beams(2, 2, 4000), 4}}});
  // Fog in a furnace whose wall reflects nothing.
  rows.push_back({"FurnaceWithFog",
                  "PerspectiveCamera { from: [-0.5, 0, 0], to: [1, 0, 0], fov: 90 }",
                  "Sphere { radius: 1, emission: DiffuseEmission { radiance: 1, sides: back } }\nSphere { centre: [0.4, 0, 0], "
                  "radius: 0.5, shader: PassThrough {}, interior: HomogeneousVolume { scattering: 2 } }",
                  1,
                  {{"ProgressivePhotonMapper", by_beams(1000, 0.1, 400), 8},
                   {"ProgressivePhotonMapper", by_beams(1000, 0.1, 800, ", most_beams: 500"), 8}}});
  return rows;
}

// Beams are used in homogeneous media. In heterogeneous media photons are gathered along rays, as with media: along_rays.
TEST(PhotonBeams, leave_uneven_media_to_photons) {
  const auto picture = [](const char* media, const char* volume) {
    return test::rendered(
               load_job_text(
                   job_text(fmt::format("ProgressivePhotonMapper {{ samples: 2, max_depth: 4, photon_walks: 4000, beam_walks: "
                                        "4000, media: {} }}",
                                        media),
                            "PerspectiveCamera { from: [0.5, 0.5, 3], to: [0.5, 0.5, 0.5], fov: 30 }", 8,
                            fmt::format("Box {{ centre: [0.5, 0.5, 0.5] m, size: [1, 1, 1] m, shader: PassThrough {{}}, "
                                        "interior: {} }}\nPoint {{ position: [0.5, 3, 0.5] m, emission: "
                                        "DiffuseEmission {{ radiance: 1 }} }}",
                                        volume)),
                   "fog.etd"))
        ->film()
        .develop()
        .values;
  };
  const char *const uneven = "GridVolume { resolution: [2, 1, 1], density: [1, 2], extinction: 1, albedo: 0.8 }",
                    *const even = "HomogeneousVolume { scattering: 1 }";
  const auto gathered = picture("along_rays", uneven);
  EXPECT_GT(*std::ranges::max_element(gathered), 0);
  EXPECT_EQ(picture("beams", uneven), gathered);
  EXPECT_NE(picture("beams", even), picture("along_rays", even));
}

class BeamRows : public testing::TestWithParam<Case> {};
TEST_P(BeamRows, HaveTheirClosedForm) { expect_row(GetParam()); }
INSTANTIATE_TEST_SUITE_P(Rows, BeamRows, testing::ValuesIn(cases(beam_rows())), case_name);

}  // namespace
}  // namespace etendue::closed_form
