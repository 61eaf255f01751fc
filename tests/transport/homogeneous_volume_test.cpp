// The homogeneous medium and the null-scattering boundary. Statistical tests have fixed seeds and a significance of 1e-3 over
// all their cases together.

#include <gtest/gtest.h>

#include "etendue/describe/color.h"
#include "etendue/object_map.h"
#include "etendue/transport/medium.h"
#include "support/luminaire_test_support.h"

namespace etendue::test {
namespace {

// ---- HomogeneousVolume ----------------------------------------------------------------------------------------------

constexpr double anisotropies[] = {0, 1e-4, 0.3, -0.3, 0.9, -0.9, 0.99};

Ref<VolumeShader> medium(double g) { return create<VolumeShader>("HomogeneousVolume", {{"anisotropy", g}}); }

TEST(HomogeneousVolume, PhaseFunctionIsNormalisedWithItsMeanCosine) {
  const Vector3 out = normalize(Vector3{0.3f, -0.5f, 0.8f});
  for (const double g : anisotropies) {
    const Ref<VolumeShader> m = medium(g);
    const auto phase = [&](const Vector3& in) { return double(m->phase({}, out, in)); };
    const Vector3 peak = g < 0 ? out : -out;
    const std::vector<double> borders{0, 1e-4, 1e-3, 1e-2, 0.1, 2};
    EXPECT_NEAR(integrate_around(peak, borders, phase, 1000, 2), 1, 1e-4) << g;
    const double mean =
        integrate_around(peak, borders, [&](const Vector3& in) { return phase(in) * -double(dot(in, out)); }, 1000, 2);
    EXPECT_NEAR(mean, g, 1e-4);
    // Henyey & Greenstein's formula, in the forward direction and at right angles.
    EXPECT_NEAR(phase(-out), (1 - g * g) / (4 * M_PI * std::pow(1 - g, 3)), 1e-4 * phase(-out));
    const Vector3 across = Frame(Normal3(out)).s;
    EXPECT_NEAR(phase(across), (1 - g * g) / (4 * M_PI * std::pow(1 + g * g, 1.5)), 1e-4 * phase(across));
    EXPECT_NEAR(double(m->phase({}, across, out)), phase(across), 1e-4 * phase(across));
  }
}

// A ray that has slipped through an edge of the surface would stay in the medium for ever. The medium ends with its object:
// from the middle it is half a metre long, from outside there is none.
TEST(HomogeneousVolume, EndsWithItsObjectWhereNothingElseEndsARay) {
  const Ref<VolumeShader> v = prepared_as<VolumeShader>("HomogeneousVolume { scattering: 1, absorption: 2, emission: 6 }");
  const Ref<SceneObject> box = prepared_as<SceneObject>("Box { centre: [0.5, 0.5, 0.5] m, size: [1, 1, 1] m }");
  const Medium medium{v.get(), box.get()};
  const Ref<Sampler> sampler = create<Sampler>("IndependentSampler");
  const Wavelengths w = wavelengths();
  NumberStream stream(*sampler, SampleKey(7, 0, 0, 1));
  Ray ray;
  ray.origin = {0.5f, 0.3f, 0.3f};
  ray.direction = {1, 0, 0};
  EXPECT_NEAR(within_object(medium, ray), 0.5f, 1e-6f);
  for (const float far : {infinity, 0.5f}) {
    EXPECT_NEAR(transmittance(medium, ray, far, w, stream)[0], std::exp(-1.5f), 1e-5f);
    EXPECT_NEAR(weighting_transmittance(medium, ray, far, w)[0], std::exp(-1.5f), 1e-5f);
    EXPECT_NEAR(sample_free_flight(medium, ray, far, Spectrum(1.0f), w, stream).emitted[0], 2 * (1 - std::exp(-1.5f)), 1e-5f);
  }
  int scattered = 0;
  constexpr int n = 10000;
  for (int i = 0; i < n; ++i) {
    NumberStream own(*sampler, SampleKey(7, 0, 0, std::uint32_t(i)));
    const FreeFlight flight = sample_free_flight(medium, ray, infinity, Spectrum(1.0f), w, own);
    EXPECT_LE(flight.distance, 0.5f + 1e-6f);
    scattered += flight.scattered;
  }
  const double p = 1 - std::exp(-1.5);
  EXPECT_NEAR(double(scattered) / n, p, 4 * std::sqrt(p * (1 - p) / n));
  ray.origin = {1.5f, 0.3f, 0.3f};
  EXPECT_EQ(transmittance(medium, ray, infinity, w, stream)[0], 1.0f);
  EXPECT_FALSE(sample_free_flight(medium, ray, infinity, Spectrum(1.0f), w, stream).scattered);
}

TEST(HomogeneousVolume, SamplesFollowThePhaseFunction) {
  constexpr int rows = 40, columns = 12, count = 100000;
  std::uint32_t seed = 70;
  for (const double g : anisotropies) {
    const Ref<VolumeShader> m = medium(g);
    const Vector3 out = normalize(Vector3{-0.2f, 0.9f, 0.1f}), peak = g < 0 ? out : -out;
    // Rows of equal probability, by Henyey and Greenstein's distribution of 1 - cos to the peak.
    const double a = std::abs(g);
    const auto below = [&](double h) {
      return a < 1e-3 ? h / 2 : (1 - a * a) / (2 * a) * (1 / (1 - a) - 1 / std::sqrt((1 - a) * (1 - a) + 2 * a * h));
    };
    const std::vector<double> expected(size_t(rows * columns), double(count) / (rows * columns));
    std::vector<double> counts(expected.size());
    const Frame frame{Normal3(peak)};
    Random random(seed++);
    double cosines = 0, squares = 0;
    for (int i = 0; i < count; ++i) {
      float pdf = 0;
      const Vector3 in = m->sample_phase({}, out, random.pair(), pdf);
      ASSERT_NEAR(length(in), 1, 1e-5f);
      EXPECT_NEAR(pdf, m->phase({}, out, in), 1e-3f * pdf);
      const Vector3 v = frame.to_local(in);
      const double h = double(length_squared(in - peak)) / 2, cosine = -double(dot(in, out));
      const int row = std::min(int(below(h) * rows), rows - 1);
      const int column = std::min(int((std::atan2(double(v.y), double(v.x)) / (2 * M_PI) + 0.5) * columns), columns - 1);
      ++counts[size_t(row * columns + column)];
      cosines += cosine / count;
      squares += cosine * cosine / count;
    }
    EXPECT_GT(chi_square(counts, expected), each_of(int(std::size(anisotropies)))) << g;
    // 3.8 standard errors: significance 1e-3 over all cases together.
    EXPECT_NEAR(cosines, g, 3.8 * std::sqrt((squares - cosines * cosines) / count)) << g;
  }
}

TEST(HomogeneousVolume, AVeryNarrowPeakStaysExact) {
  const Ref<VolumeShader> m = medium(0.9999);
  Random random(4);
  int near = 0;
  for (int i = 0; i < 1000; ++i) {
    float pdf = 0;
    const Vector3 out = random.direction(), in = m->sample_phase({}, out, random.pair(), pdf);
    EXPECT_NEAR(pdf, m->phase({}, out, in), 2e-2f * pdf);
    near += length(in + out) < 3e-4f;
  }
  EXPECT_GT(near, 500);  // P = 0.68 for sin(theta) up to 3 (1 - g)
}

TEST(HomogeneousVolume, CoefficientsPerWavelength) {
  const Ref<VolumeShader> m = prepared_as<VolumeShader>(
      "HomogeneousVolume { absorption: 2.5, scattering: blackbody(3000 K), emission: blackbody(2856 K) }");
  const Wavelengths w = wavelengths();
  const VolumeCoefficients c = m->coefficients({1, 2, 3}, 0.5f, w);
  const Color scattering = blackbody_spectrum(3000), emission = blackbody_spectrum(2856);
  for (int i = 0; i < spectrum_size; ++i) {
    EXPECT_EQ(c.absorption[i], 2.5f);
    EXPECT_FLOAT_EQ(c.scattering[i], scattering->evaluate(w, ColorUse::coefficient)[i]);
    EXPECT_FLOAT_EQ(c.emission[i], emission->evaluate(w, ColorUse::radiance)[i]);
    EXPECT_FLOAT_EQ(m->majorant(w)[i], c.extinction()[i]);
  }
  EXPECT_TRUE(m->homogeneous());
  EXPECT_TRUE(m->emits());
  EXPECT_FALSE(medium(0)->emits());
  EXPECT_TRUE(medium(0)->coefficients({}, 0, w).emission.black());
}

TEST(HomogeneousVolume, RefusesWhatCannotBe) {
  expect_refused("HomogeneousVolume { absorption: -1 }", "absorption", "negative");
  expect_refused("HomogeneousVolume { scattering: -0.5 }", "scattering", "negative");
  expect_refused("HomogeneousVolume { emission: -1 }", "emission", "negative");
  expect_refused("HomogeneousVolume { absorption: metal(\"Au\") }", "absorption", "complex");
  expect_refused("HomogeneousVolume { anisotropy: 1 }", "anisotropy", "both excluded");
  expect_refused("HomogeneousVolume { anisotropy: -1 }", "anisotropy", "both excluded");
  EXPECT_THROW(parse_component("HomogeneousVolume { anisotropy: 1.5 }"), Errors);
}

// ---- PassThrough ----------------------------------------------------------------------------------------------------

TEST(PassThrough, EverythingGoesStraightOn) {
  const Ref<Shader> shader = create<Shader>("PassThrough");
  EXPECT_TRUE(shader->transmits());
  EXPECT_EQ(shader->possible_lobes(), Lobes(null_scattering));
  EXPECT_EQ(shader->interior_index(wavelengths())[0], 1);
  // From many of these directions, shading and geometric normal are on different sides: no light may be lost there.
  const SurfacePoint p = surface_point({0.1f, 0.2f, 1}, {0.9f, 0.1f, 0.3f});
  Random random(6);
  for (int i = 0; i < 1000; ++i) {
    Arena arena;
    const Scatter* scatter = shader->bind(p, wavelengths(), arena);
    ASSERT_NE(scatter, nullptr);
    const Vector3 out = random.direction();
    for (const Transport transport : {Transport::radiance, Transport::importance}) {
      const auto s = scatter->sample(out, random(), random.pair(), {.transport = transport});
      ASSERT_TRUE(s.has_value());
      EXPECT_LT(length(s->direction + out), 1e-6f);
      EXPECT_EQ(s->lobe, null_scattering);
      EXPECT_TRUE(s->specular());
      EXPECT_TRUE(s->transmitted());
      EXPECT_EQ(s->pdf, 1);
      EXPECT_EQ(s->eta, 1);
      EXPECT_FALSE(s->dispersive);
      for (int k = 0; k < spectrum_size; ++k) EXPECT_NEAR(s->weight[k], 1, 1e-6f / std::abs(dot(p.normal, out)));
      EXPECT_TRUE(scatter->evaluate(out, -out, {.transport = transport}).black());
      EXPECT_EQ(scatter->pdf(out, -out, {.transport = transport}), 0);
    }
    EXPECT_EQ(scatter->albedo(out)[0], 1);
    EXPECT_TRUE(scatter->albedo(out, smooth_lobes).black());
    EXPECT_FALSE(scatter->sample(out, 0.5f, random.pair(), {.lobes = smooth_lobes}).has_value());
  }
}

}  // namespace
}  // namespace etendue::test
