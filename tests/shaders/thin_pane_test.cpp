// Delta scattering at all angles: thin panes that absorb, films by another derivation, glass, gratings, and the null scattering
// of masks and mixtures.

#include <complex>

#include "components/shaders/microfacet/film_interference.h"
#include "etendue/describe/color.h"
#include "etendue/object_map.h"
#include "support/component_test_support.h"

namespace etendue {
namespace {

using test::create;
using Complex = std::complex<double>;

SurfacePoint flat_point(const Vector3& dpdu = {1, 0, 0}) {
  SurfacePoint p = test::surface_point({0, 0, 1});
  p.dpdu = dpdu;
  return p;
}
Vector3 direction(double angle, double azimuth = 0.4) {
  const double t = angle * M_PI / 180;
  return {float(std::sin(t) * std::cos(azimuth)), float(std::sin(t) * std::sin(azimuth)), float(std::cos(t))};
}

// pbrt and Mitsuba average R over both polarizations before they sum up the passages: 2 R / (1 + R).
TEST(ThinPane, AveragedPolarizations) {
  const Ref<Shader> shader = create<Shader>("ThinDielectric", {{"ior", 1.5}, {"polarizations", std::string("averaged")}});
  Arena arena;
  const Scatter& s = *shader->bind(flat_point(), Wavelengths(), arena);
  for (const double angle : {0.0, 60.0, 80.0}) {
    const Vector3 out = direction(angle);
    const auto back = s.sample(out, 0, {}, {.lobes = specular_reflection});
    ASSERT_TRUE(back);
    const double n = 1.5, c = double(out.z), inside = std::sqrt(1 - (1 - c * c) / (n * n));
    const double R = (std::pow((c - n * inside) / (c + n * inside), 2) + std::pow((n * c - inside) / (n * c + inside), 2)) / 2;
    EXPECT_NEAR(double(back->weight[0]), 2 * R / (1 + R), 2e-5) << angle;
    EXPECT_NEAR(double(s.albedo(out)[0]), 1, 1e-5);
  }
}

// A pane's passages, one by one: light meets the faces in turn, with the transmittance color^(1 / cos inside) on each passage.
TEST(ThinPane, AbsorbsAlongEachPassageAtAllAngles) {
  const Color ior = table_spectrum({360, 830}, {1.7f, 1.4f}), tint = table_spectrum({360, 830}, {0.9f, 0.4f});
  const Ref<Shader> shader = create<Shader>("ThinDielectric", {{"ior", ior}, {"color", tint}});
  const Wavelengths w = test::wavelengths(420);
  Arena arena;
  const Scatter& s = *shader->bind(flat_point(), w, arena);
  for (const double angle : {0.0, 35.0, 60.0, 80.0, 100.0, 150.0, 180.0}) {
    const Vector3 out = direction(angle);
    const auto through = s.sample(out, 0, {}, {.lobes = null_scattering}),
               back = s.sample(out, 0, {}, {.lobes = specular_reflection});
    ASSERT_TRUE(through && back);
    EXPECT_LT(length(through->direction + out), 1e-6f);
    EXPECT_LT(length(back->direction - Vector3{-out.x, -out.y, out.z}), 1e-6f);
    for (int i = 0; i < spectrum_size; ++i) {
      const double n = double(ior->at(w[i], ColorUse::coefficient)), c = std::abs(double(out.z));
      const double inside = std::sqrt(1 - (1 - c * c) / (n * n));
      const double a = std::pow(double(tint->at(w[i], ColorUse::reflectance)), 1 / inside);
      const double rs = std::pow((c - n * inside) / (c + n * inside), 2), rp = std::pow((n * c - inside) / (n * c + inside), 2);
      double reflected = 0, transmitted = 0;
      for (const double R : {rs, rp}) {
        reflected += R / 2;
        double carried = (1 - R) / 2;
        for (int k = 0; k < 200; ++k) {
          carried *= a;
          (k % 2 ? reflected : transmitted) += carried * (1 - R);
          carried *= R;
        }
      }
      EXPECT_NEAR(double(through->weight[i]), transmitted, 2e-5) << angle << " at " << w[i] << " nm";
      EXPECT_NEAR(double(back->weight[i]), reflected, 2e-5) << angle << " at " << w[i] << " nm";
      EXPECT_NEAR(double(s.albedo(out)[i]), reflected + transmitted, 3e-5);
      // With both lobes requested, the sample means give both parts.
      double mean[2] = {};
      for (int k = 0; k < 1000; ++k)
        if (const auto sample = s.sample(out, (float(k) + 0.5f) / 1000, {}))
          mean[sample->lobe == null_scattering] += double(sample->weight[i]) / 1000;
      EXPECT_NEAR(mean[0], reflected, 3e-3);
      EXPECT_NEAR(mean[1], transmitted, 3e-3);
    }
  }
}

// ---- films ------------------------------------------------------------------------------------------------------------------

/// Characteristic matrices (Abeles 1950; Born & Wolf 1999, section 1.6.2), which contain no Fresnel amplitudes: M of the film
/// relates the tangential fields at both its faces, and the boundary conditions with the waves outside give R.
double film_reflectance(double c0, double n0, double n1, Complex n2, double d) {
  const double s2 = n0 * n0 * (1 - c0 * c0);
  const auto normal = [&](Complex n) {
    Complex q = std::sqrt(n * n - s2);
    return q.imag() < 0 ? -q : q;
  };
  const Complex q0 = normal(n0), q1 = normal(n1), q2 = normal(n2), i{0, 1};
  const Complex beta = 2 * M_PI * d * q1;
  double sum = 0;
  for (const bool s : {true, false}) {
    const auto admittance = [&](Complex q, Complex n) { return s ? q : q / (n * n); };
    const Complex y0 = admittance(q0, n0), y1 = admittance(q1, n1), y2 = admittance(q2, n2);
    const Complex m11 = std::cos(beta), m12 = -i / y1 * std::sin(beta), m21 = -i * y1 * std::sin(beta), m22 = m11;
    const Complex a = (m11 + m12 * y2) * y0, b = m21 + m22 * y2;
    sum += std::norm((a - b) / (a + b)) / 2;
  }
  return sum;
}

TEST(ThinFilmSlabs, AgreeWithCharacteristicMatrices) {
  const struct {
    double film, thickness;
    Complex base;
  } films[] = {{1.33, 250, 1.5},      {1.38, 700, 1.6},        {2.3, 120, 1.5},     {1.4, 400, {0.9, 6}},
               {1.9, 90, {0.2, 3.4}}, {1.2, 300, {2.9, 0.05}}, {1.33, 500, 1.0001}, {1.6, 2000, 1.2}};
  const Wavelengths w = test::wavelengths(400);
  for (const auto& f : films) {
    const Color base = f.base.imag() > 0
                           ? complex_index(flat_spectrum(float(f.base.real())), flat_spectrum(float(f.base.imag())))
                           : flat_spectrum(float(f.base.real()));
    const Ref<Shader> shader = create<Shader>(
        "ThinFilm", {{"film_ior", flat_spectrum(float(f.film))}, {"base_ior", base}, {"thickness", f.thickness}});
    Arena arena;
    const Scatter& s = *shader->bind(flat_point(), w, arena);
    // From inside (beyond 90 degrees) light may tunnel through a film in which it cannot propagate.
    for (const double angle : {0.0, 30.0, 60.0, 80.0, 88.0, 180.0, 150.0, 141.0, 120.0}) {
      if (angle > 90 && f.base.imag() > 0) continue;
      const Vector3 out = direction(angle);
      const auto back = s.sample(out, 0, {}, {.lobes = specular_reflection});
      ASSERT_TRUE(back);
      for (int i = 0; i < spectrum_size; ++i) {
        const double c = std::abs(double(out.z));
        const double expected = angle < 90 ? film_reflectance(c, 1, f.film, f.base, f.thickness / double(w[i]))
                                           : film_reflectance(c, f.base.real(), f.film, 1, f.thickness / double(w[i]));
        EXPECT_NEAR(double(back->weight[i]), expected, 3e-4) << f.film << " " << f.thickness << " " << angle << " " << w[i];
      }
    }
  }
}

// Between two glasses light tunnels through a gap in which it cannot propagate: all of it through a gap of zero width, hardly
// any through one of a wavelength.
TEST(ThinFilmSlabs, LightTunnelsThroughGaps) {
  for (const double angle : {10.0, 41.0, 45.0, 60.0, 80.0})
    for (const double gap : {0.0, 0.02, 0.1, 0.3, 1.0})
      for (const double behind : {1.5, 1.7}) {
        const double c = std::cos(angle * M_PI / 180), expected = film_reflectance(c, 1.5, 1, behind, gap);
        const FilmFractions f = film_fractions(float(c), 1.5f, 1, float(behind), float(gap));
        EXPECT_NEAR(double(f.reflected), expected, 1e-4) << angle << " " << gap << " " << behind;
        EXPECT_NEAR(double(f.transmitted), 1 - expected, 1e-4) << angle << " " << gap << " " << behind;
      }
}

// ---- glass ------------------------------------------------------------------------------------------------------------------

TEST(ThinPane, GlassSplitsPowerByFresnelOnBothSidesAndWavelengths) {
  const Color ior = table_spectrum({360, 830}, {1.7f, 1.5f});
  for (const bool varies : {false, true}) {
    const Color index = varies ? ior : flat_spectrum(1.6f);
    const Ref<Shader> shader = create<Shader>("Dielectric", {{"ior", index}});
    const Wavelengths w = test::wavelengths(500);
    Arena arena;
    const Scatter& s = *shader->bind(flat_point(), w, arena);
    for (const double angle : {0.0, 40.0, 75.0, 105.0, 143.0, 150.0, 180.0}) {
      const Vector3 out = direction(angle);
      const double c = std::abs(double(out.z));
      const auto fresnel = [&](double n) {
        const double eta = angle < 90 ? n : 1 / n, behind2 = 1 - (1 - c * c) / (eta * eta);
        if (behind2 <= 0) return 1.0;
        const double b = std::sqrt(behind2);
        return (std::pow((c - eta * b) / (c + eta * b), 2) + std::pow((eta * c - b) / (eta * c + b), 2)) / 2;
      };
      const auto back = s.sample(out, 0, {}, {.lobes = specular_reflection});
      for (int i = 0; i < spectrum_size; ++i)
        EXPECT_NEAR(double(back->weight[i]), fresnel(double(index->at(w[i], ColorUse::coefficient))), 2e-5);
      const double n = double(index->at(w[0], ColorUse::coefficient)), hero = fresnel(n);
      const auto power = s.sample(out, 0.999f, {}, {Transport::importance, specular_transmission}),
                 radiance = s.sample(out, 0.999f, {}, {.lobes = specular_transmission});
      EXPECT_EQ(bool(power), hero < 1);
      if (!power) continue;
      const double eta = angle < 90 ? n : 1 / n;
      EXPECT_NEAR(double(power->weight[0]), 1 - hero, 2e-5);
      EXPECT_NEAR(double(radiance->weight[0]), (1 - hero) / (eta * eta), 3e-5);
      EXPECT_NEAR(double(power->eta), eta, 1e-5);
      EXPECT_EQ(power->dispersive, varies);
      // Snell's law in vector form: the tangential component shrinks by the index.
      EXPECT_NEAR(double(power->direction.x), -double(out.x) / eta, 1e-5);
      EXPECT_NEAR(double(power->direction.y), -double(out.y) / eta, 1e-5);
      EXPECT_LT(power->direction.z * out.z, 0);
      if (!varies)
        for (int i = 0; i < spectrum_size; ++i) EXPECT_NEAR(double(power->weight[i]), 1 - hero, 2e-5);
      // With both lobes requested: the hero's weight is 1, whichever is sampled.
      for (const float choice : {0.0f, 0.9999f}) {
        const auto any = s.sample(out, choice, {}, {.transport = Transport::importance});
        ASSERT_TRUE(any);
        EXPECT_NEAR(any->weight[0], 1, 1e-5f);
      }
    }
  }
}

// ---- gratings ---------------------------------------------------------------------------------------------------------------

// Orders leave according to the grating equation: the component across the grooves changes by m lambda / d, the one along them
// does not change.
TEST(GratingNumbers, OrdersLeaveAcrossTheGroovesAndEfficienciesAddUp) {
  const Ref<Shader> shader = create<Shader>("DiffractionGrating", {{"lines", 400.0},
                                                                   {"efficiency", std::vector<double>{0.4, 0.2, 0.05}},
                                                                   {"rotation", 0.125},
                                                                   {"color", table_spectrum({360, 830}, {0.5f, 1.0f})}});
  const Wavelengths w = test::wavelengths(560);
  Arena arena;
  const Scatter& s = *shader->bind(flat_point(), w, arena);
  const double step = 560e-6 * 400, color = 0.5 + 0.5 * 200 / 470;
  // Grooves along u rotated by 45 degrees: the direction across them is (-1, 1) / sqrt 2.
  const double along[2] = {M_SQRT1_2, M_SQRT1_2}, across[2] = {-M_SQRT1_2, M_SQRT1_2};
  const Vector3 out = direction(25, 1.1);
  double probability[5] = {}, weight[5] = {};
  constexpr int count = 4000;
  for (int i = 0; i < count; ++i) {
    const auto sample = s.sample(out, (float(i) + 0.5f) / count, {});
    ASSERT_TRUE(sample);
    const double dx = double(sample->direction.x + out.x), dy = double(sample->direction.y + out.y);
    EXPECT_NEAR(dx * along[0] + dy * along[1], 0, 1e-5);
    const double order = (dx * across[0] + dy * across[1]) / step;
    const int m = int(std::lround(order));
    EXPECT_NEAR(order, m, 1e-4);
    ASSERT_LE(std::abs(m), 2);
    EXPECT_EQ(sample->dispersive, m != 0);
    probability[m + 2] += 1.0 / count;
    weight[m + 2] += double(sample->weight[0]) / count;
  }
  const double e[] = {0.05, 0.2, 0.4, 0.2, 0.05};
  for (int m = 0; m < 5; ++m) {
    EXPECT_NEAR(weight[m], e[m] * color, 2e-3) << m - 2;
    EXPECT_NEAR(probability[m], e[m] / 0.9, 2e-3) << m - 2;
  }
  EXPECT_NEAR(double(s.albedo(out)[0]), 0.9 * color, 1e-5);
}

// ---- straight on ------------------------------------------------------------------------------------------------------------

TEST(ThinPane, MasksAndMixturesLetOnWhatTheirPartsDo) {
  const Ref<Shader> pane = create<Shader>("ThinDielectric", {{"color", 0.6}}),
                    diffuse = create<Shader>("Lambertian", {{"color", 0.5}});
  Arena arena;
  const auto straight = [&](const Ref<Shader>& shader, const Vector3& out) {
    const auto s = shader->bind(flat_point(), test::wavelengths(), arena)->sample(out, 0, {}, {.lobes = null_scattering});
    return s ? double(s->weight[0]) : 0.0;
  };
  for (const double angle : {0.0, 50.0, 130.0}) {
    const Vector3 out = direction(angle);
    const double t = straight(pane, out);
    EXPECT_GT(t, 0.2);
    EXPECT_NEAR(straight(create<Shader>("MaskShader", {{"shader", pane}, {"opacity", 0.3}}), out), 0.7 + 0.3 * t, 1e-5);
    EXPECT_NEAR(straight(create<Shader>("MaskShader", {{"shader", diffuse}, {"opacity", 0.3}}), out), 0.7, 1e-6);
    EXPECT_NEAR(straight(create<Shader>("MixShader", {{"first", pane}, {"second", diffuse}, {"amount", 0.25}}), out), 0.75 * t,
                1e-5);
    const Ref<Shader> both =
        create<Shader>("MixShader", {{"first", pane}, {"second", create<Shader>("PassThrough")}, {"amount", 0.25}});
    EXPECT_NEAR(straight(both, out), 0.75 * t + 0.25, 1e-5);
  }
}

}  // namespace
}  // namespace etendue
