// Dielectric: Fresnel's formulas, dispersion and surrounding media.

#include "etendue/describe/color.h"
#include "etendue/object_map.h"
#include "etendue/shader.h"
#include "etendue/transport/medium_stack.h"
#include "support/component_test_support.h"
#include "support/shader_test_support.h"

namespace etendue::test {
namespace {

double reflectance(const Scatter& scatter, double angle) {
  return double(scatter.albedo(at_angle(scatter.frame(), angle), reflection_lobes)[0]);
}

TEST(Dielectric, FresnelOfGlass) {
  Arena arena;
  const Scatter& scatter = *create<Shader>("Dielectric")->bind(test::surface_point(), test::wavelengths(), arena);
  EXPECT_NEAR(reflectance(scatter, 0), 0.040000, 1e-6);
  EXPECT_NEAR(reflectance(scatter, 45), 0.050240, 1e-6);
  EXPECT_NEAR(reflectance(scatter, 60), 0.089187, 1e-6);
  // At Brewster's angle only rs remains: F = ((n^2 - 1) / (n^2 + 1))^2 / 2.
  const double brewster = 56.309932;
  EXPECT_NEAR(reflectance(scatter, brewster), 0.5 * std::pow(1.25 / 3.25, 2), 1e-6);
  // From inside, total reflection begins at 41.810 degrees.
  EXPECT_LT(reflectance(scatter, 180 - 41.80), 1);
  EXPECT_EQ(reflectance(scatter, 180 - 41.82), 1);
  // The mean over diffuse illumination, integral of 2 F cos sin dtheta, from outside and inside.
  double outside = 0, inside = 0;
  constexpr int steps = 20000;
  for (int i = 0; i < steps; ++i) {
    const double c = std::sqrt((i + 0.5) / steps), angle = std::acos(c) * 180 / M_PI;
    outside += reflectance(scatter, angle) / steps;
    inside += reflectance(scatter, 180 - angle) / steps;
  }
  EXPECT_NEAR(outside, 0.091778, 1e-5);
  EXPECT_NEAR(inside, 0.596346, 1e-5);
}

TEST(Dielectric, SamplesReflectAndRefract) {
  Arena arena;
  const Scatter& scatter = *create<Shader>("Dielectric")->bind(test::surface_point(), test::wavelengths(), arena);
  const Vector3 n(scatter.frame().n);
  for (const double angle : {0.0, 30.0, 70.0, 150.0, 170.0}) {
    const Vector3 out = at_angle(scatter.frame(), angle);
    const float f = float(reflectance(scatter, angle)), eta = angle < 90 ? 1.5f : 1 / 1.5f;
    const auto mirrored = scatter.sample(out, f * 0.99f, {}), through = scatter.sample(out, f * 1.01f, {});
    ASSERT_TRUE(mirrored && through);
    EXPECT_EQ(mirrored->lobe, specular_reflection);
    EXPECT_NEAR(mirrored->pdf, f, 1e-6f);
    EXPECT_NEAR(mirrored->weight[0], 1, 1e-6f);
    EXPECT_EQ(mirrored->eta, 1);
    EXPECT_EQ(through->lobe, specular_transmission);
    EXPECT_NEAR(through->pdf, 1 - f, 1e-6f);
    EXPECT_FLOAT_EQ(through->eta, eta);
    EXPECT_FALSE(through->dispersive);
    // Snell: the tangential component of index times direction is continuous.
    const Vector3 tangent_out = out - dot(n, out) * n, tangent_in = through->direction - dot(n, through->direction) * n;
    EXPECT_LT(length(tangent_out + eta * tangent_in), 1e-5f);
    EXPECT_LT(dot(n, out) * dot(n, through->direction), 0);
    EXPECT_NEAR(length(through->direction), 1, 1e-6f);
    // Radiance scales by the square of the index, power does not.
    EXPECT_NEAR(through->weight[0], 1 / (eta * eta), 1e-5f);
    EXPECT_NEAR(scatter.sample(out, f * 1.01f, {}, {.transport = Transport::importance})->weight[0], 1, 1e-5f);
    // Reflection and refraction together have the albedo 1.
    EXPECT_NEAR(scatter.albedo(out, reflection_lobes)[0] + scatter.albedo(out, transmission_lobes)[0], 1, 1e-6f);
    EXPECT_EQ(scatter.albedo(out)[0], 1);
    // With a single lobe the weight is that lobe's fraction.
    EXPECT_NEAR(scatter.sample(out, 0.99f, {}, {Transport::importance, specular_reflection})->weight[0], f, 1e-6f);
    EXPECT_NEAR(scatter.sample(out, 0, {}, {Transport::importance, specular_transmission})->weight[0], 1 - f, 1e-6f);
  }
  // Under total reflection nothing is refracted.
  const Vector3 out = at_angle(scatter.frame(), 120);
  EXPECT_EQ(scatter.sample(out, one_minus_epsilon, {})->lobe, specular_reflection);
  EXPECT_FALSE(scatter.sample(out, 0.5f, {}, {.lobes = specular_transmission}));
}

TEST(Dielectric, Disperses) {
  Arena arena;
  const Color index = table_spectrum({360, 830}, {1.6f, 1.4f});
  const Ref<Shader> shader = create<Shader>("Dielectric", {{"ior", index}});
  Wavelengths w = test::wavelengths(500);
  const SurfacePoint p = test::surface_point();
  const Scatter& scatter = *shader->bind(p, w, arena);
  const double n_hero = 1.6 - 0.2 * (500.0 - 360) / 470;
  const double critical = std::asin(1 / n_hero) * 180 / M_PI;
  // From inside, just below the hero's critical angle; shorter wavelengths have a higher index and undergo total internal
  // reflection.
  const double angle = 180 - (critical - 0.05);
  const Vector3 out = at_angle(scatter.frame(), angle);
  const Spectrum reflected = scatter.albedo(out, reflection_lobes);
  ASSERT_LT(reflected[0], 1);
  const auto mirrored = scatter.sample(out, 0, {});
  EXPECT_FALSE(mirrored->dispersive);
  int total = 0;
  for (int i = 0; i < spectrum_size; ++i) {
    if (w[i] < 500) {
      ++total;
      EXPECT_EQ(reflected[i], 1);
    }
    EXPECT_NEAR(mirrored->weight[i], reflected[i] / reflected[0], 1e-5f);
  }
  EXPECT_GT(total, 0);
  const auto through = scatter.sample(out, one_minus_epsilon, {});
  EXPECT_EQ(through->lobe, specular_transmission);
  EXPECT_TRUE(through->dispersive);
  EXPECT_NEAR(through->eta, 1 / n_hero, 1e-5);
  EXPECT_TRUE(through->weight.finite());
  EXPECT_NEAR(through->weight[0], n_hero * n_hero, 1e-4);
  // A path with a single wavelength has no secondary wavelengths to drop.
  w.drop_secondary();
  EXPECT_FALSE(shader->bind(p, w, arena)->sample(out, one_minus_epsilon, {})->dispersive);
}

TEST(Dielectric, TakesTheIndexOutsideFromTheMedia) {
  test::TestSquare glass, water;
  const Ref<Shader> glass_shader = create<Shader>("Dielectric", {{"ior", 1.5}}),
                    water_shader = create<Shader>("Dielectric", {{"ior", 1.33}});
  glass.reference();  // on the stack: must not be deleted through a Ref
  water.reference();
  glass.shader = glass_shader;
  water.shader = water_shader;
  MediumStack media;
  media.enter(water);
  SurfacePoint p = test::surface_point();
  p.object = &glass;
  p.media = &media;
  Arena arena;
  const double normal = std::pow((1.5 - 1.33) / (1.5 + 1.33), 2);
  EXPECT_NEAR(reflectance(*glass_shader->bind(p, test::wavelengths(), arena), 0), normal, 1e-6);
  // Seen from inside the glass, the medium stack contains the glass as well.
  media.enter(glass);
  const Scatter& scatter = *glass_shader->bind(p, test::wavelengths(), arena);
  EXPECT_NEAR(reflectance(scatter, 180), normal, 1e-6);
  EXPECT_NEAR(scatter.sample(at_angle(scatter.frame(), 180), 0.9f, {})->eta, 1.33 / 1.5, 1e-6);
}

TEST(Dielectric, AnExteriorIndexStandsWhateverIsAround) {
  test::TestSquare glass, water;
  const Ref<Shader> shader = create<Shader>("Dielectric", {{"ior", 1.5}, {"exterior", flat_spectrum(1.33f)}}),
                    water_shader = create<Shader>("Dielectric", {{"ior", 2.0}});
  glass.reference();
  water.reference();
  glass.shader = shader;
  water.shader = water_shader;
  MediumStack media;
  media.enter(water);
  SurfacePoint p = test::surface_point();
  Arena arena;
  const double normal = std::pow((1.5 - 1.33) / (1.5 + 1.33), 2);
  EXPECT_NEAR(reflectance(*shader->bind(p, test::wavelengths(), arena), 0), normal, 1e-6);
  p.object = &glass;
  p.media = &media;
  const Scatter& scatter = *shader->bind(p, test::wavelengths(), arena);
  EXPECT_NEAR(reflectance(scatter, 0), normal, 1e-6);
  EXPECT_NEAR(reflectance(scatter, 180), normal, 1e-6);
  EXPECT_NEAR(scatter.sample(at_angle(scatter.frame(), 180), 0.9f, {})->eta, 1.33 / 1.5, 1e-6);
  EXPECT_THROW(create<Shader>("Dielectric", {{"exterior", flat_spectrum(0)}}), Error);
}

TEST(Dielectric, TintsMultiplyEachPart) {
  const Color half = table_spectrum({360, 830}, {0.9f, 0.3f}), most = table_spectrum({360, 830}, {0.5f, 0.8f});
  const Wavelengths w = test::wavelengths();
  Arena arena;
  for (const char* name : {"Dielectric", "ThinDielectric"})
    for (const double angle : {20.0, 70.0, 160.0}) {
      const Scatter &plain = *create<Shader>(name)->bind(test::surface_point(), w, arena),
                    &tinted = *create<Shader>(name, {{"reflection_tint", half}, {"transmission_tint", most}})
                                   ->bind(test::surface_point(), w, arena);
      const Vector3 out = at_angle(plain.frame(), angle);
      Spectrum means[2][2];  // plain and tinted, reflected and transmitted, over all samples
      constexpr int n = 4000;
      for (int i = 0; i < n; ++i)
        for (const bool colour : {false, true})
          if (const auto s = (colour ? tinted : plain).sample(out, (float(i) + 0.5f) / n, {}))
            means[colour][s->transmitted()] += s->weight / float(n);
      for (const bool through : {false, true}) {
        const Lobes lobes = through ? transmission_lobes : reflection_lobes;
        for (int i = 0; i < spectrum_size; ++i) {
          const float factor = (through ? most : half)->at(w[i], ColorUse::reflectance), whole = means[0][through][i];
          EXPECT_NEAR(means[1][through][i], factor * whole, 2e-3f * whole + 1e-5f) << name << angle;
          EXPECT_NEAR(tinted.albedo(out, lobes)[i], factor * plain.albedo(out, lobes)[i], 1e-5f) << name << angle;
        }
      }
    }
  // For a rough boundary, the value of each pair of directions is multiplied.
  const Scatter &plain = *create<Shader>("Dielectric", {{"roughness", 0.4}})->bind(test::surface_point(), w, arena),
                &tinted =
                    *create<Shader>("Dielectric", {{"roughness", 0.4}, {"reflection_tint", half}, {"transmission_tint", most}})
                         ->bind(test::surface_point(), w, arena);
  const Vector3 out = at_angle(plain.frame(), 40);
  for (const double angle : {10.0, 60.0, 120.0, 170.0}) {
    const Vector3 in = at_angle(plain.frame(), angle, 3);
    const Spectrum a = plain.evaluate(out, in), b = tinted.evaluate(out, in);
    for (int i = 0; i < spectrum_size; ++i)
      EXPECT_NEAR(b[i], a[i] * (angle > 90 ? most : half)->at(w[i], ColorUse::reflectance), 1e-5f * a[i]);
    EXPECT_EQ(plain.pdf(out, in), tinted.pdf(out, in));
  }
}

TEST(Dielectric, RefusesWhatIsNoIndex) {
  EXPECT_THROW(create<Shader>("Dielectric", {{"ior", 0.0}}), Error);
  EXPECT_THROW(create<Shader>("Dielectric", {{"ior", complex_index(flat_spectrum(1), flat_spectrum(2))}}), Error);
}

}  // namespace
}  // namespace etendue::test
