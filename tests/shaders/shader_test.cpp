// Shaders: samples against their pdf, energy, reciprocity, and the corrections in Scatter's public functions.

#include "etendue/shader.h"

#include "etendue/describe/color.h"
#include "etendue/object_map.h"
#include "etendue/transport/medium_stack.h"
#include "support/component_test_support.h"
#include "support/shader_test_support.h"

namespace etendue::test {
namespace {

struct Case {
  std::string name;
  Ref<Shader> shader;
};

std::vector<Case> smooth_shaders() {
  return {{"Lambertian", create<Shader>("Lambertian", {{"color", 0.8}})},
          {"Phong 0", create<Shader>("PhongShader", {{"exponent", 0.0}})},
          {"Phong 2.5", create<Shader>("PhongShader", {{"exponent", 2.5}})},
          {"Phong 40", create<Shader>("PhongShader", {{"exponent", 40.0}, {"color", 0.2}, {"specular", 0.8}})},
          {"Phong, lobe only", create<Shader>("PhongShader", {{"exponent", 10.0}, {"color", 0.0}, {"specular", 1.0}})}};
}

constexpr double angles[] = {0, 30, 60, 85, 130};  // the last from behind

TEST(Shader, SamplesFollowDensity) {
  constexpr int rows = 20, columns = 24, count = 40000;
  const auto cases = smooth_shaders();
  const double significance = test::each_of(int(cases.size() * std::size(angles)));
  std::uint32_t seed = 1;
  for (const Case& c : cases)
    for (const double angle : angles) {
      Arena arena;
      const SurfacePoint p = test::surface_point();
      const Scatter* scatter = c.shader->bind(p, test::wavelengths(), arena);
      ASSERT_NE(scatter, nullptr);
      const Vector3 out = at_angle(scatter->frame(), angle);
      std::vector<double> expected = test::integrate_cells(scatter->frame(), rows, columns,
                                                           [&](const Vector3& in) { return double(scatter->pdf(out, in)); });
      double total = 0;
      for (double& e : expected) {
        total += e;
        e *= count;
      }
      EXPECT_LE(total, 1.0005) << c.name << " at " << angle;
      expected.push_back(std::max(0.0, (1 - total) * count));
      std::vector<double> counts(expected.size());
      test::Random random(seed++);
      for (int i = 0; i < count; ++i) {
        const float choice = random();
        const auto s = scatter->sample(out, choice, random.pair());
        ++counts[s ? test::cell_of(scatter->frame(), rows, columns, s->direction) : counts.size() - 1];
      }
      EXPECT_GT(test::chi_square(counts, expected), significance) << c.name << " at " << angle;
    }
}

TEST(Shader, WeightIsValueTimesCosineOverDensity) {
  test::Random random(7);
  int seen = 0;
  for (const Case& c : smooth_shaders())
    for (const double angle : angles)
      for (const Transport transport : {Transport::radiance, Transport::importance})
        for (const Lobes lobes : {Lobes(all_lobes), Lobes(diffuse_lobes), Lobes(glossy_lobes)}) {
          Arena arena;
          const SurfacePoint p = test::surface_point({0.1f, 0.2f, 1}, {0.3f, 0.1f, 0.9f});
          const Scatter* scatter = c.shader->bind(p, test::wavelengths(), arena);
          const Vector3 out = at_angle(scatter->frame(), angle);
          for (int i = 0; i < 50; ++i) {
            const float choice = random();
            const auto s = scatter->sample(out, choice, random.pair(), {transport, lobes});
            if (!s) continue;
            ++seen;
            const ScatterValue both = scatter->value_and_pdf(out, s->direction, {transport, lobes});
            EXPECT_NEAR(both.pdf, s->pdf, 2e-3f * s->pdf) << c.name;
            EXPECT_FLOAT_EQ(both.pdf, scatter->pdf(out, s->direction, {transport, lobes}));
            const Spectrum value = scatter->evaluate(out, s->direction, {transport, lobes});
            const Spectrum weight = value / both.pdf;
            for (int k = 0; k < spectrum_size; ++k) {
              EXPECT_FLOAT_EQ(value[k], both.value[k]);
              EXPECT_NEAR(weight[k], s->weight[k], 2e-3f * s->weight[k]) << c.name;
            }
          }
        }
  EXPECT_GT(seen, 2000);
}

TEST(Shader, AlbedoAtMostOneAndEstimated) {
  for (const Case& c : smooth_shaders())
    for (const double angle : {0.0, 20.0, 40.0, 60.0, 75.0, 85.0, 110.0}) {
      Arena arena;
      const Scatter* scatter = c.shader->bind(test::surface_point(), test::wavelengths(), arena);
      const Vector3 out = at_angle(scatter->frame(), angle);
      double albedo = 0;
      for (const double cell : test::integrate_cells(scatter->frame(), 40, 40,
                                                     [&](const Vector3& in) { return double(scatter->evaluate(out, in)[0]); }))
        albedo += cell;
      EXPECT_LE(albedo, 1.001) << c.name << " at " << angle;
      const double estimate = double(scatter->albedo(out)[0]);
      EXPECT_GE(estimate, albedo - 2e-3) << c.name << " at " << angle;
      EXPECT_LE(estimate, albedo + 0.08) << c.name << " at " << angle;
      if (angle == 0 || c.name == "Lambertian") {
        EXPECT_NEAR(estimate, albedo, 2e-3) << c.name;
      }
    }
}

TEST(Shader, PhongScalesDownWhatWouldCreateEnergy) {
  const Ref<Shader> shader = create<Shader>("PhongShader", {{"color", 0.9}, {"specular", 0.9}, {"exponent", 20.0}});
  Arena arena;
  const Scatter* scatter = shader->bind(test::surface_point(), test::wavelengths(), arena);
  const Vector3 out = at_angle(scatter->frame(), 0);
  EXPECT_NEAR(scatter->albedo(out, diffuse_lobes)[0], 0.5f, 1e-6f);
  EXPECT_NEAR(scatter->albedo(out)[0], 1, 1e-6f);
}

TEST(Shader, Reciprocity) {
  test::Random random(3);
  int seen = 0;
  for (const Case& c : smooth_shaders()) {
    Arena arena;
    const Scatter* scatter = c.shader->bind(test::surface_point(), test::wavelengths(), arena);
    for (int i = 0; i < 200; ++i) {
      const Vector3 a = random.direction(), b = random.direction();
      const Spectrum ab = scatter->evaluate(a, b) * scatter->cosine(a), ba = scatter->evaluate(b, a) * scatter->cosine(b);
      for (int k = 0; k < spectrum_size; ++k) EXPECT_NEAR(ab[k], ba[k], 1e-4f * std::abs(ab[k]) + 1e-9f) << c.name;
      seen += !ab.black();
    }
  }
  EXPECT_GT(seen, 300);
}

// Veach 1997, eq. 5.17 and 5.18: with measures by the geometric normal, the adjoint is the same function with exchanged
// arguments.
TEST(Shader, ImportanceIsTheAdjointUnderShadingNormals) {
  test::Random random(5);
  const SurfacePoint p = test::surface_point({0, 0, 1}, {0.4f, -0.2f, 0.9f});
  int seen = 0;
  for (const Case& c : smooth_shaders()) {
    Arena arena;
    const Scatter* scatter = c.shader->bind(p, test::wavelengths(), arena);
    for (int i = 0; i < 300; ++i) {
      const Vector3 a = random.direction(), b = random.direction();
      const Spectrum from_light = scatter->evaluate(a, b, {.transport = Transport::importance}) / std::abs(dot(p.normal, b));
      const Spectrum from_camera = scatter->evaluate(b, a) / std::abs(dot(p.normal, a));
      for (int k = 0; k < spectrum_size; ++k)
        EXPECT_NEAR(from_light[k], from_camera[k], 1e-3f * from_camera[k] + 1e-9f) << c.name;
      seen += !from_light.black();
    }
  }
  EXPECT_GT(seen, 300);
}

TEST(Shader, NoLightLeaksThroughShadingNormals) {
  test::Random random(6);
  const SurfacePoint p = test::surface_point({0, 0, 1}, {0.9f, 0, 0.3f});
  int opposite = 0;
  for (const Case& c : smooth_shaders()) {
    Arena arena;
    const Scatter* scatter = c.shader->bind(p, test::wavelengths(), arena);
    for (int i = 0; i < 300; ++i) {
      const Vector3 a = random.direction(), b = random.direction();
      if (dot(p.normal, a) * dot(p.normal, b) < 0) {
        ++opposite;
        EXPECT_TRUE(scatter->evaluate(a, b).black());
        EXPECT_EQ(scatter->pdf(a, b), 0);
      }
      const float choice = random();
      const auto s = scatter->sample(a, choice, random.pair());
      if (s) {
        EXPECT_GT(dot(p.normal, a) * dot(p.normal, s->direction), 0);
      }
    }
  }
  EXPECT_GT(opposite, 300);
}

TEST(Shader, LobesAreMasked) {
  Arena arena;
  const Ref<Shader> phong = create<Shader>("PhongShader");
  const Scatter* scatter = phong->bind(test::surface_point(), test::wavelengths(), arena);
  const Vector3 a = at_angle(scatter->frame(), 30, 0), b = at_angle(scatter->frame(), 35, M_PI);
  const float both = scatter->evaluate(a, b)[0], diffuse = scatter->evaluate(a, b, {.lobes = diffuse_lobes})[0];
  const float glossy = scatter->evaluate(a, b, {.lobes = glossy_lobes})[0];
  EXPECT_NEAR(diffuse, 0.5f * inverse_pi * scatter->cosine(b), 1e-6f);
  EXPECT_GT(glossy, diffuse);
  EXPECT_NEAR(both, diffuse + glossy, 1e-5f);
  EXPECT_TRUE(scatter->evaluate(a, b, {.lobes = transmission_lobes}).black());
  EXPECT_EQ(scatter->pdf(a, b, {.lobes = specular_lobes}), 0);
  EXPECT_FALSE(scatter->sample(a, 0.5f, {0.5f, 0.5f}, {.lobes = specular_lobes}));
  // A black lobe does not exist.
  EXPECT_EQ(create<Shader>("PhongShader", {{"color", 0.0}})->bind(test::surface_point(), test::wavelengths(), arena)->lobes(),
            glossy_reflection);
  EXPECT_EQ(create<Shader>("Lambertian", {{"color", 0.0}})->bind(test::surface_point(), test::wavelengths(), arena), nullptr);
}

TEST(Shader, ReflectanceAboveOneIsRefused) {
  EXPECT_THROW(create<Shader>("Lambertian", {{"color", 1.5}}), Error);
  EXPECT_THROW(create<Shader>("PerfectSpecular", {{"color", -0.5}}), Error);
}

TEST(PerfectSpecular, Mirrors) {
  Arena arena;
  const Scatter* scatter =
      create<Shader>("PerfectSpecular", {{"color", 0.9}})->bind(test::surface_point(), test::wavelengths(), arena);
  for (const double angle : angles) {
    const Vector3 out = at_angle(scatter->frame(), angle);
    const auto s = scatter->sample(out, 0.3f, {0.1f, 0.2f});
    ASSERT_TRUE(s);
    EXPECT_EQ(s->lobe, specular_reflection);
    EXPECT_NEAR(s->weight[0], 0.9f, 1e-6f);
    const Vector3 n(scatter->frame().n), mirrored = 2 * dot(n, out) * n - out;
    EXPECT_LT(length(mirrored - s->direction), 1e-6f);
    EXPECT_TRUE(scatter->evaluate(out, s->direction).black());
    EXPECT_EQ(scatter->pdf(out, s->direction), 0);
  }
}

}  // namespace
}  // namespace etendue::test
