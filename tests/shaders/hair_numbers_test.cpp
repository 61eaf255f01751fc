// Hair against the papers: the absorption in a fibre, the widths of its lobes, and the pigments of hair.

#include <gtest/gtest.h>

#include <cmath>

#include "components/shaders/fresnel.h"
#include "components/shaders/hair/hair.h"
#include "etendue/describe/color.h"
#include "support/component_test_support.h"

namespace etendue {
namespace {

// Absorption in a fibre: rays traced through a cylinder of radius 1 in three dimensions, by the vector form of Snell's law.
TEST(HairNumbers, AttenuationIsThatOfRaysThroughACylinder) {
  constexpr float eta = 1.55f;
  const HairFibre fibre(0.3f, 0.3f, 0, eta);
  for (const double theta : {0.0, 0.5, 1.1, -0.9})
    for (const double h : {-0.8, 0.0, 0.35, 0.95}) {
      const float sigma = 0.4f;
      const auto s = fibre.section(float(std::sin(theta)), float(std::cos(theta)), float(h), Spectrum(sigma));
      // The ray travels along d and hits the cylinder about x at the offset h.
      const double n[3] = {0, h, std::sqrt(1 - h * h)}, d[3] = {-std::sin(theta), 0, -std::cos(theta)};
      const double c = -(d[1] * n[1] + d[2] * n[2]), b = std::sqrt(1 - (1 - c * c) / double(eta * eta));
      double t[3];
      for (int i = 0; i < 3; ++i) t[i] = d[i] / double(eta) + (c / double(eta) - b) * n[i];
      // Until the ray hits the cylinder again: |n + l t| = 1 perpendicular to the axis.
      const double a = t[1] * t[1] + t[2] * t[2], length = -2 * (n[1] * t[1] + n[2] * t[2]) / a;
      const double T = std::exp(-double(sigma) * length), F = double(fresnel_dielectric(float(c), eta));
      EXPECT_NEAR(double(s.attenuation[0][0]), F, 1e-5);
      EXPECT_NEAR(double(s.attenuation[1][0]), (1 - F) * (1 - F) * T, 2e-5) << theta << " " << h;
      EXPECT_NEAR(double(s.attenuation[2][0]), (1 - F) * (1 - F) * T * F * T, 2e-5) << theta << " " << h;
      double rest = 0;
      for (int k = 3; k < 60; ++k) rest += (1 - F) * (1 - F) * T * std::pow(F * T, k - 1);
      EXPECT_NEAR(double(s.attenuation[3][0]), rest, 2e-5) << theta << " " << h;
    }
}

// Chiang et al. 2016, equations 7 and 8: the variances of the longitudinal lobes, whose M broadens sin(theta), and the scale of
// the azimuthal lobes. M: d'Eon et al. 2011, here without logarithms and with the integral form of I0.
TEST(HairNumbers, LobesHaveTheWidthsOfThePaper) {
  for (const double beta : {0.3, 0.6, 0.9})
    for (const double tilt : {0.0, 0.05}) {
      const HairFibre fibre(float(beta), float(beta), float(tilt), 1.55f);
      const double v0 = std::pow(0.726 * beta + 0.812 * beta * beta + 3.7 * std::pow(beta, 20), 2);
      const double v[] = {v0, v0 / 4, 4 * v0, 4 * v0}, angle[] = {-2 * tilt, tilt, 4 * tilt, 0};
      for (int p = 0; p < 4; ++p)
        for (const double out : {-0.4, 0.1, 0.9})
          for (const double in : {-0.8, 0.0, 0.45}) {
            const double moved = out + angle[p], k = 1 / v[p], x = k * std::cos(in) * std::cos(moved);
            double bessel = 0;  // of e^-x I0(x)
            for (int i = 0; i < 400; ++i) bessel += std::exp(x * (std::cos(M_PI * (i + 0.5) / 400) - 1)) / 400;
            const double M = bessel * std::exp(x - k * std::sin(in) * std::sin(moved) - k) * k / (1 - std::exp(-2 * k));
            EXPECT_NEAR(double(fibre.longitudinal(p, float(std::sin(out)), float(std::cos(out)), float(std::sin(in)),
                                                  float(std::cos(in)))),
                        M, 1e-3 * M + 1e-6)
                << beta << " " << p << " " << out << " " << in;
          }
      // N falls off like a logistic distribution of scale s; at its middle it is 1 / (4 s) over its mass within half a turn.
      const double s = std::sqrt(M_PI / 8) * (0.265 * beta + 1.194 * beta * beta + 5.372 * std::pow(beta, 22));
      const auto section = fibre.section(0, 1, 0, Spectrum());
      const double mass = std::tanh(M_PI / (2 * s));
      EXPECT_NEAR(double(fibre.azimuthal(0, section, 0)), 1 / (4 * s * mass), 1e-4 / s) << beta;
      EXPECT_NEAR(double(fibre.azimuthal(1, section, float(M_PI))), 1 / (4 * s * mass), 1e-4 / s) << beta;
      const double e = std::exp(-0.3 / s);
      EXPECT_NEAR(double(fibre.azimuthal(0, section, 0.3f)), e / (s * (1 + e) * (1 + e) * mass), 1e-4 / s) << beta;
    }
}

// Chiang et al. 2016, equation 9: sigma_a = (ln C / (5.969 - 0.215 b + 2.532 b^2 - 10.73 b^3 + 5.574 b^4 + 0.245 b^5))^2.
TEST(HairNumbers, AbsorptionOfAColor) {
  for (const double b : {0.2, 0.5, 0.8, 1.0}) {
    const HairFibre fibre(0.3f, float(b), 0, 1.55f);
    const double fit = 5.969 - 0.215 * b + 2.532 * b * b - 10.73 * b * b * b + 5.574 * std::pow(b, 4) + 0.245 * std::pow(b, 5);
    for (const double c : {0.02, 0.3, 0.85}) {
      const double expected = std::pow(std::log(c) / fit, 2);
      EXPECT_NEAR(double(fibre.absorption_of(Spectrum(float(c)))[0]), expected, 1e-4 * expected) << b << " " << c;
    }
  }
}

// d'Eon et al. 2011 (as used in pbrt): eumelanin absorbs (0.419, 0.697, 1.37) and pheomelanin (0.187, 0.4, 1.05) of red, green
// and blue. The spectra are power laws that match green exactly and the others within 3 %. The absorption is computed back from
// the light transmitted straight through the middle of a fibre with narrow lobes: A1 / A1 without pigment is exp(-2 sigma).
TEST(HairNumbers, Melanin) {
  const auto absorbed = [](double black, double red, float wavelength) {
    const auto through = [&](double e, double p) {
      const Ref<Shader> shader = test::create<Shader>("HairShader", {{"eumelanin", e},
                                                                     {"pheomelanin", p},
                                                                     {"tilt", 0.0},
                                                                     {"longitudinal_roughness", 0.05},
                                                                     {"azimuthal_roughness", 0.05}});
      SurfacePoint point = test::surface_point({0, 0, 1});
      point.dpdu = {1, 0, 0};
      point.uv = {0.3f, 0.5f};
      Wavelengths w;
      for (int i = 0; i < spectrum_size; ++i) w.place(i, wavelength, 1);
      Arena arena;
      return double(shader->bind(point, w, arena)->evaluate({0, 0, 1}, {0, 0, -1})[0]);
    };
    return -0.5 * std::log(through(black, red) / through(0, 0));
  };
  EXPECT_NEAR(absorbed(1, 0, 550), 0.697, 2e-3);
  EXPECT_NEAR(absorbed(0, 1, 550), 0.4, 2e-3);
  EXPECT_NEAR(absorbed(1, 0, 645), 0.419, 0.03 * 0.419);
  EXPECT_NEAR(absorbed(1, 0, 450), 1.37, 0.03 * 1.37);
  EXPECT_NEAR(absorbed(0, 1, 645), 0.187, 0.03 * 0.187);
  EXPECT_NEAR(absorbed(0, 1, 450), 1.05, 0.03 * 1.05);
  // Donner & Jensen 2006: the laws' exponents.
  EXPECT_NEAR(std::log(absorbed(1, 0, 420) / absorbed(1, 0, 680)) / std::log(680 / 420.0), 3.33, 0.01);
  EXPECT_NEAR(std::log(absorbed(0, 1, 420) / absorbed(0, 1, 680)) / std::log(680 / 420.0), 4.75, 0.01);
  EXPECT_NEAR(absorbed(0.5, 0.25, 550), 0.5 * 0.697 + 0.25 * 0.4, 2e-3);
}

}  // namespace
}  // namespace etendue
