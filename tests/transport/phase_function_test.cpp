// Phase functions: closed forms, Mie's theory, and numbers of Mitsuba 3.9.1 (its `eval_pdf` at given cosines).

#include "etendue/phase_function.h"

#include <gtest/gtest.h>

#include "etendue/volume_shader.h"
#include "support/luminaire_test_support.h"

namespace etendue::test {
namespace {

Ref<PhaseFunction> phase(const std::string& text) { return prepared_as<PhaseFunction>(text); }

/// 2 pi int f(1 - h) value(h) dh, with h = 1 - cos and steps that are fine at the forward peak.
template <class F>
double integral(const PhaseFunction& p, const F& f) {
  double sum = 0;
  constexpr int steps = 400000;
  for (int i = 0; i < steps; ++i) {
    const auto place = [](double x) { return 2 * x * x * x; };
    const double a = place(double(i) / steps), b = place((i + 1.0) / steps), h = (a + b) / 2;
    sum += 2 * M_PI * (b - a) * f(1 - h) * double(p.value(float(h)));
  }
  return sum;
}
double whole(const PhaseFunction& p) {
  return integral(p, [](double) { return 1.0; });
}
double mean_cosine(const PhaseFunction& p) {
  return integral(p, [](double c) { return c; });
}

TEST(PhaseFunction, RayleighsSecondMomentIsTwoFifths) {
  const Ref<PhaseFunction> p = phase("RayleighPhase {}");
  EXPECT_NEAR(whole(*p), 1, 1e-5);
  EXPECT_NEAR(mean_cosine(*p), 0, 1e-5);
  EXPECT_NEAR(integral(*p, [](double c) { return c * c; }), 0.4, 1e-5);
  // A depolarization of 6/7 is the most that natural light allows: gamma = 3/4, p = (3.25 + 0.25 c^2) 3 / (40 pi).
  const Ref<PhaseFunction> most = phase("RayleighPhase { depolarization: 0.857142 }");
  EXPECT_NEAR(whole(*most), 1, 1e-5);
  EXPECT_NEAR(double(most->value(0)), 3.5 * 3 / (40 * M_PI), 1e-5);
  EXPECT_NEAR(double(most->value(1)), 3.25 * 3 / (40 * M_PI), 1e-5);
  // At a scattering angle of 90 degrees the weaker polarization is rho times the stronger, so p(90) / p(0) = (1 + rho) / 2.
  const Ref<PhaseFunction> air = phase("RayleighPhase { depolarization: 0.0279 }");
  EXPECT_NEAR(double(air->value(1) / air->value(0)), (1 + 0.0279) / 2, 1e-5);
}

// Water droplets in visible light: Mie's theory gives asymmetries of 0.85 to 0.87 for diameters of 10 to 40 micrometres (Hu &
// Stamnes 1993, An accurate parameterization of the radiative properties of water clouds, figure 3). The mean cosine of
// Draine's function is his eq. 9.
TEST(PhaseFunction, FogTurnsLightAsMiesTheorySays) {
  for (const double micrometres : {8.0, 10.0, 20.0, 40.0}) {
    const Ref<PhaseFunction> p = phase("FogPhase { droplet_diameter: " + std::to_string(micrometres * 1e-6) + " }");
    EXPECT_NEAR(whole(*p), 1, 1e-4) << micrometres;
    const double mean = mean_cosine(*p);
    EXPECT_GT(mean, 0.82) << micrometres;
    EXPECT_LT(mean, 0.89) << micrometres;
    // A forward peak, and more backward than sideward scattering.
    EXPECT_GT(p->value(0), 100 * p->value(0.5f));
    EXPECT_GT(p->value(2), 1.5f * p->value(1.2f));
    double drawn = 0;
    constexpr int n = 200000;
    for (int i = 0; i < n; ++i) drawn += 1 - double(p->sample((float(i) + 0.5f) / n));
    EXPECT_NEAR(drawn / n, mean, 1e-4) << micrometres;
  }
}

TEST(PhaseFunction, ValuesAreThoseOfMitsuba) {
  constexpr double cosines[] = {-1, -0.5, 0, 0.3, 0.8, 0.99, 1};
  const struct {
    const char* text;
    double values[7];
  } rows[] = {
      {"RayleighPhase {}", {0.119366, 0.074604, 0.059683, 0.065055, 0.09788, 0.118179, 0.119366}},
      {"HenyeyGreensteinPhase { anisotropy: 0.6 }", {0.012434, 0.01856, 0.032112, 0.05093, 0.201317, 0.713966, 0.795775}},
      {"TabulatedPhase { values: [0.5, 1, 0.25, 2] }", {0.047746, 0.083556, 0.059683, 0.027454, 0.140852, 0.188479, 0.190986}},
      {"BlendPhase { first: HenyeyGreensteinPhase { anisotropy: 0.6 }, second: RayleighPhase {}, amount: 0.3 }",
       {0.044514, 0.035373, 0.040383, 0.055167, 0.170286, 0.53523, 0.592852}},
  };
  for (const auto& row : rows) {
    const Ref<PhaseFunction> p = phase(row.text);
    for (int i = 0; i < 7; ++i)
      EXPECT_NEAR(double(p->value(float(1 - cosines[i]))), row.values[i], 2e-6 + 1e-5 * row.values[i])
          << row.text << cosines[i];
  }
}

// A table of the values of a lobe is the lobe, as far as it is fine enough; also with given cosines.
TEST(PhaseFunction, ATableOfAFunctionIsTheFunction) {
  const Ref<PhaseFunction> lobe = phase("HenyeyGreensteinPhase { anisotropy: -0.5 }");
  std::string values, cosines;
  for (int i = 0; i <= 200; ++i) {
    const double c = std::sin((i / 200.0 - 0.5) * M_PI);
    values += (i ? ", " : "") + std::to_string(7 * double(lobe->value(float(1 - c))));
    cosines += (i ? ", " : "") + std::to_string(c);
  }
  const Ref<PhaseFunction> table = phase("TabulatedPhase { values: [" + values + "], cosines: [" + cosines + "] }");
  for (const float h : {0.0f, 0.3f, 1.0f, 1.7f, 2.0f})
    EXPECT_NEAR(table->value(h), lobe->value(h), 2e-3f * lobe->value(h)) << h;
  for (const float u : {0.0f, 0.2f, 0.5f, 0.9f, 0.999f})
    EXPECT_NEAR(table->sample(1 - u), 2 - phase("HenyeyGreensteinPhase { anisotropy: 0.5 }")->sample(u), 5e-3f) << u;
}

TEST(PhaseFunction, AMediumTurnsLightByIt) {
  const Vector3 out = normalize(Vector3{0.3f, -0.5f, 0.8f}), in = normalize(Vector3{-0.1f, 0.9f, 0.2f});
  const Ref<VolumeShader> named = prepared_as<VolumeShader>(
                              "HomogeneousVolume { phase: HenyeyGreensteinPhase { anisotropy: 0.7 } }"),
                          stated = prepared_as<VolumeShader>("HomogeneousVolume { anisotropy: 0.7 }");
  EXPECT_NEAR(named->phase({}, out, in), stated->phase({}, out, in), 1e-5f);
  float a = 0, b = 0;
  const Vector3 one = named->sample_phase({}, out, {0.3f, 0.6f}, a), other = stated->sample_phase({}, out, {0.3f, 0.6f}, b);
  EXPECT_NEAR(length(one - other), 0, 1e-6f);
  EXPECT_NEAR(a, b, 1e-5f * b);
}

TEST(PhaseFunction, WhatIsNoneIsRefused) {
  const auto refused = [](const char* text, const char* with) {
    try {
      prepared_as<PhaseFunction>(text);
      ADD_FAILURE() << text;
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find(with), std::string::npos) << e.what();
    }
  };
  refused("TabulatedPhase { values: [1] }", "at least two");
  refused("TabulatedPhase { values: [0, 0] }", "must not all be 0");
  refused("TabulatedPhase { values: [1, -1] }", "neither positive");
  refused("TabulatedPhase { values: [1, 1, 1], cosines: [-1, 1] }", "there are 2, but 3");
  refused("TabulatedPhase { values: [1, 1, 1], cosines: [-1, 0.5, 0.5] }", "must rise");
  refused("TabulatedPhase { values: [1, 1], cosines: [-1, 0.5] }", "from -1 to 1");
  EXPECT_THROW(prepared_as<VolumeShader>("HomogeneousVolume { anisotropy: 0.2, phase: RayleighPhase {} }"), Error);
}

}  // namespace
}  // namespace etendue::test
