// Principled and SheenShader: furnaces, closed forms of single layers, the effect of each member, sampling, reciprocity.

#include "components/shaders/fresnel.h"
#include "components/shaders/microfacet/film_interference.h"
#include "etendue/describe/color.h"
#include "etendue/object_map.h"
#include "support/component_test_support.h"
#include "support/shader_test_support.h"

namespace etendue {
namespace {

using test::at_angle;
using test::create;
using test::Setting;
using Settings = std::vector<Setting>;

Setting thin_walled() {
  Setting s("thin_walled", 1.0);
  s.value = Value(true);
  return s;
}

/// A shader bound to a point, at wavelengths from 450 nm on.
struct Bound {
  explicit Bound(const Settings& settings, const char* shader_class = "Principled")
      : shader(create<Shader>(shader_class, settings)),
        scatter(shader->bind(test::surface_point(), test::wavelengths(), arena)) {}
  Vector3 at(double angle, double azimuth = 0.7) const { return at_angle(scatter->frame(), angle, azimuth); }
  /// The fraction of light at wavelength i, arriving from a direction, that is scattered.
  double albedo(double angle, int i = 0, Lobes lobes = all_lobes) const {
    const Vector3 out = at(angle);
    double sum = 0;
    const auto flux = [&](const Vector3& in) { return double(scatter->evaluate(out, in, {Transport::importance, lobes})[i]); };
    for (const double cell : test::integrate_cells(scatter->frame(), 48, 40, flux)) sum += cell;
    for (const Lobe lobe : {specular_reflection, specular_transmission, null_scattering})
      if (scatter->has(Lobes(lobe & lobes)))
        if (const auto s = scatter->sample(out, 0.5f, {0.5f, 0.5f}, {Transport::importance, lobe}))
          sum += double(s->weight[i] * s->pdf);
    return sum;
  }
  Arena arena;
  Ref<Shader> shader;
  const Scatter* scatter;
};

const Settings glass{{"transmission_weight", 1.0}, {"specular_roughness", 0.6}};
const Settings everything{{"base_metalness", 0.3},
                          {"transmission_weight", 0.4},
                          {"specular_roughness", 0.6},
                          {"specular_roughness_anisotropy", 0.5},
                          {"base_diffuse_roughness", 0.7},
                          {"coat_weight", 0.8},
                          {"coat_roughness", 0.5},
                          {"coat_color", 0.6},
                          {"fuzz_weight", 0.6},
                          {"thin_film_weight", 0.5},
                          {"geometry_opacity", 0.9}};
Settings with(Settings settings, const Settings& more) {
  settings.insert(settings.end(), more.begin(), more.end());
  return settings;
}

TEST(Principled, DefaultsMakeNoLight) {
  const Bound plastic({});
  EXPECT_EQ(plastic.scatter->lobes(), diffuse_reflection | glossy_reflection);
  for (const double angle : {0.0, 45.0, 80.0, 140.0}) {
    EXPECT_LT(plastic.albedo(angle), 0.9) << angle;
    EXPECT_GT(plastic.albedo(angle), 0.8) << angle;
    EXPECT_NEAR(plastic.albedo(angle), double(plastic.scatter->albedo(plastic.at(angle))[0]), 0.02);
  }
}

TEST(Principled, WhiteFurnaces) {
  const Settings white{{"base_color", 1.0}, {"specular_roughness", 0.6}};
  const std::vector<Settings> cases{white,
                                    with(white, {{"coat_weight", 1.0}}),
                                    with(white, {{"coat_weight", 1.0}, {"coat_roughness", 0.6}}),
                                    with(white, {{"coat_weight", 0.5}, {"coat_roughness", 0.6}}),
                                    with(white, {{"base_metalness", 1.0}}),
                                    with(white, {{"base_metalness", 1.0}, {"specular_roughness_anisotropy", 0.7}}),
                                    with(white, {{"fuzz_weight", 1.0}}),
                                    glass,
                                    with(white, {{"transmission_weight", 0.5}, {"base_metalness", 0.3}})};
  for (size_t k = 0; k < cases.size(); ++k) {
    const Bound bound(cases[k]);
    for (const double angle : {0.0, 60.0, 150.0}) EXPECT_NEAR(bound.albedo(angle), 1, 8e-3) << "case " << k << " at " << angle;
  }
}

TEST(Principled, MatteUnderGlossGetsWhatGlossLeaves) {
  // The definition of base_color (OpenPBR, "Glossy-diffuse"): E = E_specular + (1 - E_specular) C.
  const Bound bound({{"base_color", 0.35}, {"specular_roughness", 0.5}});
  for (const double angle : {0.0, 50.0, 75.0}) {
    const double gloss = bound.albedo(angle, 0, glossy_lobes), matte = bound.albedo(angle, 0, diffuse_lobes);
    EXPECT_NEAR(matte, 0.35 * (1 - gloss), 1e-3) << angle;
  }
}

TEST(Principled, MetalHasItsColorStraightOnAndItsTintAtTheEdge) {
  const Bound metal({{"base_metalness", 1.0},
                     {"base_color", 0.6},
                     {"base_weight", 0.5},
                     {"specular_color", 0.4},
                     {"specular_roughness", 0.0}});
  const auto reflected = [&](double cosine) {
    const auto s = metal.scatter->sample(metal.at(std::acos(cosine) * 180 / M_PI), 0.5f, {0.5f, 0.5f});
    return s ? double(s->weight[0]) : -1;
  };
  EXPECT_EQ(metal.scatter->lobes(), specular_reflection);
  EXPECT_NEAR(reflected(1), 0.3, 1e-5);
  const double schlick = 0.3 + 0.7 * std::pow(6.0 / 7, 5);
  EXPECT_NEAR(reflected(1.0 / 7), 0.4 * schlick, 1e-5);
}

TEST(Principled, SmoothSurfacesFollowFresnel) {
  // Glass; a coat over black; a pane with two reflecting faces, (2 R) / (1 + R); a pane with absorption.
  const double cosine = std::cos(50 * M_PI / 180), r = double(fresnel_dielectric(float(cosine), 1.5f));
  const auto specular = [](const Bound& b, Lobe lobe) {
    const auto s = b.scatter->sample(b.at(50), 0.5f, {0.5f, 0.5f}, {Transport::importance, lobe});
    return s ? double(s->weight[0] * s->pdf) : -1;
  };
  const Settings smooth{{"specular_roughness", 0.0}, {"transmission_weight", 1.0}};
  const Bound body(smooth);
  EXPECT_NEAR(specular(body, specular_reflection), r, 1e-5);
  EXPECT_NEAR(specular(body, specular_transmission), 1 - r, 1e-5);
  EXPECT_EQ(body.shader->interior_index(test::wavelengths())[0], 1.5f);

  const Bound pane(with(smooth, {thin_walled()}));
  EXPECT_NEAR(specular(pane, specular_reflection), 2 * r / (1 + r), 1e-5);
  EXPECT_NEAR(specular(pane, specular_transmission), (1 - r) / (1 + r), 1e-5);
  EXPECT_FALSE(pane.shader->transmits());
  const Bound dark(with(smooth, {thin_walled(), {"transmission_color", 0.5}}));
  const double within = std::sqrt(1 - (1 - cosine * cosine) / 2.25), a = std::pow(0.5, 1 / within);
  EXPECT_NEAR(specular(dark, specular_transmission), (1 - r) * (1 - r) * a / (1 - r * r * a * a), 1e-5);

  const Bound coat({{"coat_weight", 1.0}, {"coat_ior", 1.5}, {"base_weight", 0.0}, {"specular_weight", 0.0}});
  EXPECT_NEAR(specular(coat, specular_reflection), r, 1e-5);
}

TEST(Principled, SpecularWeightScalesTheReflectanceAndTheIndex) {
  for (const double weight : {0.25, 2.0}) {
    const Bound b({{"specular_weight", weight}, {"specular_roughness", 0.0}, {"transmission_weight", 1.0}});
    const auto s = b.scatter->sample(b.at(0), 0, {0.5f, 0.5f}, {Transport::importance, specular_reflection});
    ASSERT_TRUE(s);
    EXPECT_NEAR(s->weight[0] * s->pdf, 0.04 * weight, 1e-5);
    const float n = b.shader->interior_index(test::wavelengths())[0];
    EXPECT_NEAR(square((n - 1) / (n + 1)), 0.04 * weight, 1e-5);
  }
}

TEST(Principled, DispersionIsThatOfTheAbbeNumber) {
  const Bound b(
      {{"transmission_weight", 1.0}, {"transmission_dispersion_scale", 0.5}, {"transmission_dispersion_abbe_number", 20.0}});
  Wavelengths w;
  const float lines[] = {587.6f, 486.1f, 656.3f, 550};
  for (int i = 0; i < spectrum_size; ++i) w.place(i, lines[i % 4], 1);
  const Spectrum n = b.shader->interior_index(w);
  EXPECT_NEAR(n[0], 1.5f, 1e-5f);
  EXPECT_NEAR((n[0] - 1) / (n[1] - n[2]), 40, 0.01);
}

TEST(Principled, RotationTurnsTheRoughnessCounterClockwise) {
  const Settings brushed{{"base_metalness", 1.0}, {"specular_roughness_anisotropy", 0.8}, {"specular_roughness", 0.5}};
  const Bound along(brushed), turned(with(brushed, {{"geometry_tangent_rotation", 0.1}}));
  const Frame& frame = along.scatter->frame();
  const double tenth = 0.2 * M_PI;
  for (const double azimuth : {0.0, 1.0, 2.0}) {
    const auto value = [&](const Bound& b, double more) {
      return double(b.scatter->evaluate(at_angle(frame, 20, azimuth + more), at_angle(frame, 40, azimuth + 2.5 + more))[0]);
    };
    EXPECT_NEAR(value(turned, tenth) / value(along, 0), 1, 1e-3) << azimuth;
    EXPECT_GT(std::abs(value(turned, -tenth) / value(along, 0) - 1), 0.05) << azimuth;
  }
}

TEST(Principled, EveryMemberHasAnEffect) {
  const std::vector<std::pair<Setting, Settings>> cases{
      {{"base_weight", 0.5}, {}},
      {{"base_color", 0.2}, {}},
      {{"base_diffuse_roughness", 1.0}, {}},
      {{"base_metalness", 1.0}, {}},
      {{"specular_weight", 0.2}, {}},
      {{"specular_color", 0.2}, {}},
      {{"specular_roughness", 0.6}, {}},
      {{"specular_roughness_anisotropy", 0.9}, {}},
      {{"specular_ior", 2.0}, {}},
      {{"transmission_weight", 0.7}, {}},
      {{"transmission_color", 0.3}, glass},
      {{"transmission_dispersion_scale", 1.0}, glass},
      {{"transmission_dispersion_abbe_number", 60.0}, with(glass, {{"transmission_dispersion_scale", 1.0}})},
      {{"subsurface_weight", 1.0}, {{"subsurface_color", 0.3}}},
      {{"subsurface_color", 0.3}, {{"subsurface_weight", 1.0}}},
      {{"subsurface_scatter_anisotropy", 0.5}, {{"subsurface_weight", 1.0}, thin_walled()}},
      {{"coat_weight", 1.0}, {{"coat_roughness", 0.4}}},
      {{"coat_color", 0.3}, {{"coat_weight", 1.0}}},
      {{"coat_roughness", 0.5}, {{"coat_weight", 1.0}}},
      {{"coat_roughness_anisotropy", 0.9}, {{"coat_weight", 1.0}, {"coat_roughness", 0.5}}},
      {{"coat_ior", 2.0}, {{"coat_weight", 1.0}}},
      {{"coat_darkening", 0.0}, {{"coat_weight", 1.0}}},
      {{"fuzz_weight", 1.0}, {}},
      {{"fuzz_color", 0.2}, {{"fuzz_weight", 1.0}}},
      {{"fuzz_roughness", 1.0}, {{"fuzz_weight", 1.0}}},
      {{"thin_film_weight", 1.0}, {}},
      {{"thin_film_thickness", 300.0}, {{"thin_film_weight", 1.0}}},
      {{"thin_film_ior", 2.0}, {{"thin_film_weight", 1.0}}},
      {{"geometry_opacity", 0.5}, {}},
      {{"geometry_tangent_rotation", 0.1}, {{"specular_roughness_anisotropy", 0.9}}},
      {thin_walled(), glass}};
  size_t members = 0;
  for (const Member& m : Registry::instance().create("Principled")->class_info().members) {
    ++members;
    EXPECT_TRUE(std::any_of(cases.begin(), cases.end(), [&](const auto& c) { return c.first.member == m.name; })) << m.name;
  }
  EXPECT_EQ(members, cases.size());
  for (const auto& [setting, others] : cases) {
    const Bound before(others), after(with(others, {setting}));
    double most = 0;
    for (const double in : {-30.0, 20.0, 50.0, 70.0, 165.0, 200.0}) {
      const Spectrum a = before.scatter->evaluate(before.at(30), before.at(in)),
                     b = after.scatter->evaluate(before.at(30), before.at(in));
      for (int i = 0; i < spectrum_size; ++i)
        most = std::max(most, std::abs(double(a[i] - b[i])) / std::max({double(a[i]), double(b[i]), 1e-3}));
    }
    EXPECT_GT(most, 0.02) << setting.member;
  }
}

TEST(Principled, SamplesFollowDensity) {
  constexpr int rows = 20, columns = 24, count = 30000;
  const std::vector<Settings> cases{{}, everything, glass, with(everything, {thin_walled(), {"subsurface_weight", 0.6}})};
  const double significance = test::each_of(int(2 * cases.size()));
  for (size_t k = 0; k < cases.size(); ++k)
    for (const double angle : {50.0, 140.0}) {
      const Bound bound(cases[k]);
      const Frame& frame = bound.scatter->frame();
      const Vector3 out = bound.at(angle);
      std::vector<double> expected =
          test::integrate_cells(frame, rows, columns, [&](const Vector3& in) { return double(bound.scatter->pdf(out, in)); });
      double total = 0;
      for (double& e : expected) {
        total += e;
        e *= count;
      }
      EXPECT_LE(total, 1.001) << "case " << k << " at " << angle;
      expected.push_back(std::max(0.0, (1 - total) * count));
      std::vector<double> counts(expected.size());
      test::Random random(std::uint32_t(100 * k + 7));
      for (int i = 0; i < count; ++i) {
        const float choice = random();
        const auto s = bound.scatter->sample(out, choice, random.pair());
        ++counts[s && !s->specular() ? test::cell_of(frame, rows, columns, s->direction) : counts.size() - 1];
      }
      EXPECT_GT(test::chi_square(counts, expected), significance) << "case " << k << " at " << angle;
    }
}

TEST(Principled, IsReciprocal) {
  test::Random random(3);
  for (const Settings& settings : {Settings{}, everything, glass}) {
    const Bound bound(settings);
    const float inside = square(bound.shader->interior_index(test::wavelengths())[0]);
    const auto index2 = [&](const Vector3& v) { return dot(bound.scatter->frame().n, v) > 0 ? 1 : inside; };
    int seen = 0;
    for (int i = 0; i < 500; ++i) {
      const Vector3 a = random.direction(), b = random.direction();
      const float ab =
          bound.scatter->evaluate(a, b, {.transport = Transport::importance})[0] * bound.scatter->cosine(a) / index2(b);
      const float ba =
          bound.scatter->evaluate(b, a, {.transport = Transport::importance})[0] * bound.scatter->cosine(b) / index2(a);
      EXPECT_NEAR(ab, ba, 2e-3f * ab + 1e-6f);
      seen += ab > 0;
    }
    EXPECT_GT(seen, 200);
  }
}

TEST(Principled, RefusesWhatIsNoFraction) {
  for (const Settings& wrong :
       {Settings{{"coat_roughness", 1.5}}, Settings{{"base_color", -0.5}}, Settings{{"specular_weight", -1.0}}})
    EXPECT_THROW(create<Shader>("Principled", wrong), std::exception);
}

TEST(SheenShader, WhatFibresDoNotReflectComesToTheBase) {
  // Over a mirror all light is returned, over white no more than that.
  for (const double angle : {0.0, 50.0, 80.0}) {
    const Bound alone({{"color", 1.0}}, "SheenShader");
    const double fibres = alone.albedo(angle);
    EXPECT_NEAR(fibres, double(alone.scatter->albedo(alone.at(angle))[0]), 3e-3);
    const Bound mirror({{"color", 1.0}, {"base", create<Shader>("PerfectSpecular")}}, "SheenShader");
    EXPECT_NEAR(mirror.albedo(angle), 1, 4e-3);
    const Bound white({{"color", 1.0}, {"base", create<Shader>("Lambertian", {{"color", 1.0}})}}, "SheenShader");
    EXPECT_LT(white.albedo(angle), 1.001);
    EXPECT_GT(white.albedo(angle), 0.85);
  }
}

TEST(SheenShader, BrightAtTheEdge) {
  const Bound sharp({{"roughness", 0.2}}, "SheenShader"), blunt({{"roughness", 0.9}}, "SheenShader");
  EXPECT_LT(sharp.albedo(0), 0.02);
  EXPECT_GT(sharp.albedo(80), 0.25);
  EXPECT_GT(blunt.albedo(0), 4 * sharp.albedo(0));
}

// r01 = -r12 = 1 at this angle: 0 / 0 for the whole film, with a finite limit beside it.
TEST(FilmInterference, IsFiniteWhereLightCreepsAlongTheFilm) {
  float cosine = std::sqrt(0.75f) - 40 * 0x1p-24f;
  const float beside = film_fractions(cosine - 1e-3f, 1, 0.5f, 0.6f, 0.2f).reflected;
  for (int i = 0; i < 80; ++i, cosine = std::nextafter(cosine, 1.0f)) {
    const FilmFractions f = film_fractions(cosine, 1, 0.5f, 0.6f, 0.2f);
    EXPECT_NEAR(f.reflected, beside, 0.02f) << cosine;
    EXPECT_NEAR(f.reflected + f.transmitted, 1, 2e-3f) << cosine;
  }
}

}  // namespace
}  // namespace etendue
