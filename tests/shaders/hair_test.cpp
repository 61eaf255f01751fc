// HairShader: normalization, energy, sampling, absorption of its lobes, and values of another implementation.

#include "components/shaders/hair/hair.h"
#include "etendue/describe/color.h"
#include "etendue/object_map.h"
#include "support/component_test_support.h"

namespace etendue {
namespace {

using test::create;
using test::Setting;

/// A point on a ribbon whose fibre runs along x, at the position v across the fibre.
SurfacePoint on_ribbon(float v) {
  SurfacePoint p = test::surface_point({0, 0, 1});
  p.dpdu = {1, 0, 0};
  p.uv = {0.3f, v};
  return p;
}

struct Fibre {
  float along, around, tilt, eta;
};
constexpr Fibre fibres[] = {
    {0.3f, 0.3f, 0.035f, 1.55f}, {0.1f, 0.15f, -0.05f, 1.3f}, {0.6f, 0.8f, 0.1f, 1.7f}, {1, 1, 0, 1.55f}};

TEST(Hair, LongitudinalLobesAreDensities) {
  for (const Fibre& f : fibres) {
    const HairFibre fibre(f.along, f.around, f.tilt, f.eta);
    for (int p = 0; p < HairFibre::lobes; ++p)
      for (const float sine : {-0.95f, -0.3f, 0.0f, 0.7f}) {
        double sum = 0;
        constexpr int steps = 4000;
        for (int i = 0; i < steps; ++i) {
          const float s = -1 + 2 * (float(i) + 0.5f) / steps;
          sum += double(fibre.longitudinal(p, sine, std::sqrt(1 - sine * sine), s, std::sqrt(1 - s * s))) * 2 / steps;
        }
        EXPECT_NEAR(sum, 1, 3e-3) << "roughness " << f.along << ", lobe " << p << ", sine " << sine;
      }
  }
}

TEST(Hair, AzimuthalLobesAreDensities) {
  for (const Fibre& f : fibres) {
    const HairFibre fibre(f.along, f.around, f.tilt, f.eta);
    for (const float h : {-0.9f, 0.0f, 0.4f}) {
      const HairFibre::Section s = fibre.section(0.2f, std::sqrt(0.96f), h, Spectrum(0.3f));
      for (int p = 0; p < HairFibre::lobes; ++p) {
        constexpr int steps = 4000;
        double whole = 0, half = 0;
        for (int i = 0; i < steps; ++i) {
          const float phi = 2 * pi * (float(i) + 0.5f) / steps;
          const double part = double(fibre.azimuthal(p, s, phi)) * 2 * M_PI / steps;
          whole += part;
          if (i < steps / 2) half += part;
        }
        EXPECT_NEAR(whole, 1, 1e-3) << "lobe " << p;
        EXPECT_NEAR(half, double(fibre.azimuthal_share(p, s, 0)), 2e-3) << "lobe " << p;
      }
    }
  }
}

TEST(Hair, WithoutAbsorptionNothingIsLost) {
  // Both for the exact sum of the lobes' fractions and for the integral of f cos over the sphere.
  for (const Fibre& f : fibres)
    for (const float h : {-1.0f, -0.7f, 0.0f, 0.3f, 0.99f}) {
      const HairFibre fibre(f.along, f.around, f.tilt, f.eta);
      Spectrum sum;
      for (const Spectrum& a : fibre.section(0.4f, std::sqrt(0.84f), h, Spectrum()).attenuation) sum += a;
      EXPECT_NEAR(sum[0], 1, 1e-5f) << h;
    }
  const auto hair =
      create<Shader>("HairShader", {{"pigment", "absorption"}, {"absorption", 0.0}, {"longitudinal_roughness", 0.5}});
  Arena arena;
  const Scatter* scatter = hair->bind(on_ribbon(0.6f), test::wavelengths(), arena);
  for (const Vector3& out : {Vector3{0.1f, 0.2f, 0.97f}, Vector3{-0.7f, 0.5f, 0.5f}, Vector3{0.3f, 0.5f, -0.8f}}) {
    const Vector3 v = normalize(out);
    double albedo = 0;
    for (const double cell : test::integrate_cells(scatter->frame(), 60, 60,
                                                   [&](const Vector3& in) { return double(scatter->evaluate(v, in)[0]); }))
      albedo += cell;
    EXPECT_NEAR(albedo, 1, 3e-3);
    EXPECT_NEAR(scatter->albedo(v)[0], 1, 1e-5f);
  }
}

TEST(Hair, AlbedoTellsTheSides) {
  const auto hair = create<Shader>("HairShader", {{"longitudinal_roughness", 0.5}, {"azimuthal_roughness", 0.4}});
  Arena arena;
  const Scatter* scatter = hair->bind(on_ribbon(0.2f), test::wavelengths(), arena);
  const Vector3 out = normalize(Vector3{0.3f, -0.4f, 0.8f});
  double back = 0, through = 0;
  const auto cells =
      test::integrate_cells(scatter->frame(), 60, 60, [&](const Vector3& in) { return double(scatter->evaluate(out, in)[0]); });
  for (size_t i = 0; i < cells.size(); ++i) (i < cells.size() / 2 ? through : back) += cells[i];
  EXPECT_NEAR(scatter->albedo(out, reflection_lobes)[0], back, 3e-3);
  EXPECT_NEAR(scatter->albedo(out, transmission_lobes)[0], through, 3e-3);
  EXPECT_EQ(hair->albedo_error(), 0);  // the albedo is a closed form
}

TEST(Hair, SamplesFollowDensity) {
  constexpr int rows = 24, columns = 32, count = 60000;
  const std::vector<std::vector<Setting>> cases{{},
                                                {{"longitudinal_roughness", 0.6}, {"azimuthal_roughness", 0.7}, {"tilt", -5.0}},
                                                {{"eumelanin", 8.0}, {"longitudinal_roughness", 0.25}}};
  const double significance = test::each_of(6);
  std::uint32_t seed = 11;
  for (const auto& settings : cases)
    for (const float v : {0.1f, 0.55f}) {
      const auto hair = create<Shader>("HairShader", settings);
      Arena arena;
      const Scatter* scatter = hair->bind(on_ribbon(v), test::wavelengths(), arena);
      const Vector3 out = normalize(Vector3{0.4f, v - 0.3f, 0.8f});
      auto expected = test::integrate_cells(scatter->frame(), rows, columns,
                                            [&](const Vector3& in) { return double(scatter->pdf(out, in)); });
      double total = 0;
      for (double& e : expected) {
        total += e;
        e *= count;
      }
      EXPECT_NEAR(total, 1, 2e-3);
      std::vector<double> counts(expected.size());
      test::Random random(seed++);
      for (int i = 0; i < count; ++i) {
        const float choice = random();
        const auto s = scatter->sample(out, choice, random.pair());
        ASSERT_TRUE(s);
        EXPECT_LE(s->weight.maximum(), 4.01f);
        ++counts[test::cell_of(scatter->frame(), rows, columns, s->direction)];
      }
      EXPECT_GT(test::chi_square(counts, expected), significance) << "seed " << seed - 1;
    }
}

TEST(Hair, PigmentAbsorbs) {
  const auto albedo = [](const std::vector<Setting>& settings) {
    const auto hair = create<Shader>("HairShader", settings);
    Arena arena;
    return hair->bind(on_ribbon(0.6f), test::wavelengths(), arena)->albedo(normalize(Vector3{0.2f, 0.1f, 1}));
  };
  const Spectrum blond = albedo({{"eumelanin", 0.3}}), brown = albedo({{"eumelanin", 1.3}}),
                 black = albedo({{"eumelanin", 8.0}});
  const Spectrum red = albedo({{"eumelanin", 0.3}, {"pheomelanin", 2.0}});
  for (int i = 0; i < spectrum_size; ++i) {
    EXPECT_GT(blond[i], brown[i]);
    EXPECT_GT(brown[i], black[i]);
    EXPECT_GT(blond[i], red[i]);
  }
  // Blue (450 nm, the hero) is absorbed more than red (685 nm), by red pigment even more so.
  EXPECT_GT(blond[2], blond[0]);
  EXPECT_GT(red[2] / red[0], blond[2] / blond[0]);
  EXPECT_GT(albedo({{"pigment", "color"}, {"color", 0.8}})[0], albedo({{"pigment", "color"}, {"color", 0.1}})[0]);
  EXPECT_GT(albedo({{"pigment", "absorption"}, {"absorption", 0.1}})[0],
            albedo({{"pigment", "absorption"}, {"absorption", 2.0}})[0]);
}

TEST(Hair, ColorIsThatOfTheFit) {
  // Chiang et al. 2016, eq. 9, worked out by hand for beta_n = 0.3 and a color of 0.5: (ln 0.5 / 5.93999)^2.
  EXPECT_NEAR(HairFibre(0.3f, 0.3f, 0, 1.55f).absorption_of(Spectrum(0.5f))[0], 0.0136, 5e-4);
}

TEST(Hair, MatchesAnotherImplementation) {
  // f cos and pdf of Mitsuba 3.9.1's `hair`, which is the same model with h taken from the direction.
  struct Row {
    float along, around, tilt, eta, h, absorption;
    Vector3 out, in;
    float value, pdf;
  };
  const Row rows[] = {
      {0.6188216f,
       0.8229104f,
       2.2054855f,
       1.3900829f,
       -0.1212897f,
       1.3103302f,
       {0.9378646f, 0.0420877f, 0.3444395f},
       {0.5647546f, -0.7153654f, 0.4114665f},
       0.0050594f,
       0.0302566f},
      {0.8035045f,
       0.420948f,
       0.7854725f,
       1.3237007f,
       0.9431653f,
       0.4845545f,
       {0.9596306f, -0.265278f, 0.0934706f},
       {0.8345629f, 0.3871055f, -0.3919873f},
       0.0026886f,
       0.0043489f},
      {0.6284974f,
       0.6573377f,
       -2.7936958f,
       1.4761254f,
       -0.561782f,
       0.6037474f,
       {0.5820712f, 0.4568062f, 0.672697f},
       {0.2887364f, -0.3546777f, -0.8892891f},
       0.0158072f,
       0.0500271f},
      {0.6311788f,
       0.5772707f,
       -0.9896973f,
       1.4643821f,
       0.0708593f,
       0.0570859f,
       {0.8909154f, -0.0321821f, 0.4530276f},
       {-0.0044882f, 0.8745477f, 0.4849187f},
       0.0094504f,
       0.0108872f},
      {0.5393239f,
       0.7239355f,
       3.2734345f,
       1.3604249f,
       -0.1345675f,
       0.0077683f,
       {-0.9704442f, 0.0324746f, 0.2391304f},
       {0.741592f, -0.654537f, 0.1470463f},
       0.1006298f,
       0.1028679f},
      {0.6213465f,
       0.7447677f,
       0.1040287f,
       1.5903398f,
       0.7731482f,
       0.2977817f,
       {0.2939259f, -0.7389968f, 0.6062105f},
       {-0.6143028f, 0.5498146f, 0.5659824f},
       0.034094f,
       0.056817f},
  };
  for (const Row& r : rows) {
    const HairFibre fibre(r.along, r.around, radians(r.tilt), r.eta);
    const auto cosine = [](const Vector3& v) { return std::sqrt(v.y * v.y + v.z * v.z); };
    const HairFibre::Section s = fibre.section(r.out.x, cosine(r.out), r.h, Spectrum(r.absorption));
    const float difference = std::atan2(r.in.z, r.in.y) - std::atan2(r.out.z, r.out.y);
    float value = 0, pdf = 0, sum = 0;
    for (int p = 0; p < HairFibre::lobes; ++p) {
      const float a = s.attenuation[size_t(p)][0];
      const float shape =
          fibre.longitudinal(p, r.out.x, cosine(r.out), r.in.x, cosine(r.in)) * fibre.azimuthal(p, s, difference);
      value += a * shape;
      pdf += a * shape;
      sum += a;
    }
    EXPECT_NEAR(value, r.value, 0.01f * r.value);
    EXPECT_NEAR(pdf / sum, r.pdf, 0.01f * r.pdf);
  }
}

}  // namespace
}  // namespace etendue
