// Renders in three bands: closed forms component by component, and scenes that need wavelengths.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "etendue/core/error.h"
#include "etendue/describe/bands.h"
#include "support/render_support.h"

namespace etendue::test {
namespace {

const Wavelengths& bands() {
  static const Wavelengths of_srgb = bands_of(rgb_space("srgb"));
  return of_srgb;
}

Ref<Job> job_of(const std::string& objects, const std::string& more = "", const std::string& renderer = "PathTracer {}") {
  return load_job_text(fmt::format(R"(Job {{ renderer: {}
    wavelengths: RgbWavelengths {{}} {}
    camera: PerspectiveCamera {{ from: [0.3, 0.1, 0.2] m, to: [0, 0, 1] m, fov: 90 }}
    image: ImageBuffer {{ width: 4, height: 4, filter: BoxFilter {{}} }}
    scene: BruteForceScene {{ objects: [ {} ] }} }})",
                                   renderer, more, objects),
                       "test.etd");
}

// The inside of a sphere emits E and reflects rho: the radiance is E / (1 - rho), in each band by itself. As spectra such
// saturated colours would multiply otherwise: of red 0.95 and 0.02 the radiance in green would be a third higher.
class SphereInBands : public ::testing::TestWithParam<const char*> {};

TEST_P(SphereInBands, ComponentsOfSaturatedColorsMultiply) {
  const Ref<Job> job = job_of(R"(Sphere { shader: Lambertian { color: rgb(0.8, 0.3, 0.02) },
                                        emission: DiffuseEmission { radiance: rgb(0.1, 0.5, 2), sides: back } })",
                              "", GetParam());
  const Measured m = measure(job);
  EXPECT_EQ(m.bad, 0u);
  const Xyz exact = to_xyz(band_spectrum(0.1f / 0.2f, 0.5f / 0.7f, 2 / 0.98f), bands());
  EXPECT_NEAR(m.mean.x, exact.x, 0.01 * exact.x);
  EXPECT_NEAR(m.mean.y, exact.y, 0.01 * exact.y);
  EXPECT_NEAR(m.mean.z, exact.z, 0.01 * exact.z);
}

INSTANTIATE_TEST_SUITE_P(Renderers, SphereInBands,
                         ::testing::Values("PathTracer { samples: 256, max_depth: 100 }",
                                           "BidirectionalPathTracer { samples: 256, max_depth: 60 }",
                                           "VertexConnectionMerging { samples: 256, max_depth: 60 }"),
                         [](const auto& each) {
                           const std::string name = each.param;
                           return name.substr(0, name.find(' '));
                         });

// Light of radiance E behind 1 m of a medium that only absorbs: E exp(-a) in each band.
TEST(RgbWavelengths, CoefficientsAreThoseOfEachBand) {
  const Measured m = measure(job_of(R"(Sphere { radius: 1 m, shader: PassThrough {},
                                               interior: HomogeneousVolume { absorption: rgb(0.1, 0.9, 3), scattering: 0 } }
                                     Environment { emission: DiffuseEmission { radiance: rgb(1, 2, 3) } })",
                                    "", "PathTracer { samples: 64 }"));
  // From (0.3, 0.1, 0.2) the sphere is left after 0.64 to 1.36 m; instead of one length, all three bands give the same mean
  // one.
  const auto& s = rgb_space("srgb").from_xyz;
  const double x[3] = {m.mean.x, m.mean.y, m.mean.z};
  const auto length = [&](size_t i, double light, double absorption) {
    const double seen = s[3 * i] * x[0] + s[3 * i + 1] * x[1] + s[3 * i + 2] * x[2];
    return -std::log(seen / light) / absorption;
  };
  EXPECT_NEAR(length(0, 1, 0.1), length(1, 2, 0.9), 0.02);
  EXPECT_GT(length(2, 3, 3), 0.6);
  EXPECT_LT(length(2, 3, 3), length(0, 1, 0.1));  // Jensen: the mean of an exponential
}

TEST(RgbWavelengths, WhatNeedsWavelengthsIsRefusedWhereItIsWritten) {
  const std::pair<const char*, const char*> cases[] = {
      {R"(Sphere { shader: Dielectric { ior: glass("N-BK7") } })", "Dielectric.ior: this index of refraction disperses"},
      {R"(Sphere { shader: Subsurface { ior: spectrum([300, 900], [1.5, 1.4]) } })", "Subsurface.ior: this index"},
      {R"(Sphere { shader: ThinFilm {} })", "ThinFilm.thickness: a thin film interferes"},
      {R"(Sphere { shader: DiffractionGrating {} })", "DiffractionGrating.lines: a grating"},
      {R"(Sphere { shader: Principled { thin_film_weight: 0.5 } })", "Principled.thin_film_weight: a thin film"},
      {R"(Sphere { shader: Principled { transmission_weight: 1, transmission_dispersion_scale: 1 } })",
       "Principled.transmission_dispersion_scale: dispersion"},
      {R"(Sphere { shader: MixShader { first: Lambertian {}, second: ThinFilm {} } })", "ThinFilm.thickness: a thin film"}};
  for (const auto& [object, said] : cases) {
    try {
      Render render(job_of(object), {});
      render.run();
      ADD_FAILURE() << object << " was rendered";
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find(said), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find("RgbWavelengths"), std::string::npos) << e.what();
      EXPECT_EQ(e.location.line, 5) << e.what();
    }
  }
}

TEST(RgbWavelengths, SpectralFilmsAreRefused) {
  const Ref<Job> job = load_job_text(R"(Job { wavelengths: RgbWavelengths {}, camera: PerspectiveCamera {}
    image: SpectralFilm { width: 4, height: 4 }
    scene: BruteForceScene { objects: [ Sphere {} ] } })",
                                     "test.etd");
  EXPECT_THROW(Render(job, {}), Error);
}

// What looks like dispersion and is none.
TEST(RgbWavelengths, MetalsAndIndicesThatAreTheSameEverywhereAreNot) {
  for (const char* object :
       {R"(Sphere { transform: translate(0, 0, 3), shader: Conductor { ior: metal("Au") } })",
        R"(Sphere { transform: translate(0, 0, 3), shader: Dielectric { ior: spectrum([300, 900], [1.5, 1.5]) } })",
        R"(Sphere { transform: translate(0, 0, 3), shader: Principled { transmission_dispersion_scale: 1 } })"}) {
    const Measured m = measure(job_of(fmt::format("{}, Environment {{ emission: DiffuseEmission {{ radiance: 1 }} }}", object),
                                      "", "PathTracer { samples: 4 }"));
    EXPECT_EQ(m.bad, 0u) << object;
    EXPECT_GT(m.mean.y, 0) << object;
  }
}

}  // namespace
}  // namespace etendue::test
