// LayeredShader against closed forms, and its stochastic evaluations against its samples.

#include "components/shaders/fresnel.h"
#include "etendue/core/warp.h"
#include "etendue/describe/color.h"
#include "etendue/shader.h"
#include "etendue/volume_shader.h"
#include "support/component_test_support.h"
#include "support/shader_test_support.h"

namespace etendue {
namespace {

using test::at_angle;
using test::create;

Ref<Shader> layered(const Ref<Shader>& top, const Ref<Shader>& bottom, std::vector<test::Setting> settings = {}) {
  settings.insert(settings.begin(), {{"top", top}, {"bottom", bottom}});
  return create<Shader>("LayeredShader", settings);
}
Ref<Shader> glass(double ior = 1.5) { return create<Shader>("Dielectric", {{"ior", ior}}); }
Ref<Shader> diffuse(double color) { return create<Shader>("Lambertian", {{"color", color}}); }
Ref<VolumeShader> fog(double absorption, double scattering, double g) {
  return create<VolumeShader>("HomogeneousVolume", {{"absorption", absorption}, {"scattering", scattering}, {"anisotropy", g}});
}

/// Mean and standard error of a random variable.
class Mean {
 public:
  void add(double x) {
    ++count_;
    const double d = x - mean_;
    mean_ += d / count_;
    squares_ += d * (x - mean_);
  }
  double mean() const { return mean_; }
  double error() const { return std::sqrt(squares_ / (count_ - 1.0) / count_); }

 private:
  double count_ = 0, mean_ = 0, squares_ = 0;
};
/// Five standard errors and rounding: exceeded by chance in one of a million tests.
#define EXPECT_MEAN(m, expected) EXPECT_NEAR((m).mean(), expected, 5 * (m).error() + 2e-5)

/// Calls `ask` with a shader bound to points that differ only in the random numbers that depend on the position.
template <class F>
void at_many_points(const Shader& shader, int count, const F& ask, const Normal3& shading_normal = {0, 0, 1}) {
  SurfacePoint p = test::surface_point({0, 0, 1}, shading_normal);
  test::Random random(11);
  Arena arena;
  for (int i = 0; i < count; ++i) {
    if (i % 64 == 0) arena.reset();
    p.position = {float(i), 0, 0};
    ask(*shader.bind(p, test::wavelengths(), arena), random);
  }
}

const Frame frame(Normal3(0, 0, 1));

TEST(LayeredShader, AnInvisibleCoatChangesNothing) {
  for (const auto& coat : {glass(1), create<Shader>("PassThrough")}) {
    const Ref<Shader> shader = layered(coat, diffuse(0.6));
    for (const double angle : {0.0, 50.0, 120.0}) {
      const Vector3 out = at_angle(frame, angle), in = at_angle(frame, angle < 90 ? 65 : 140, 3);
      Mean value;
      at_many_points(*shader, 500,
                     [&](const Scatter& s, test::Random&) { value.add(double(s.evaluate(out, in)[0] / s.cosine(in))); });
      EXPECT_MEAN(value, 0.6 / M_PI) << angle;
    }
  }
}

TEST(LayeredShader, OverBlackOnlyTheCoatReflects) {
  const Ref<Shader> shader = layered(glass(), diffuse(0));
  Arena arena;
  const Scatter& s = *shader->bind(test::surface_point({0, 0, 1}), test::wavelengths(), arena);
  EXPECT_EQ(s.lobes(), specular_reflection);
  for (const double angle : {0.0, 45.0, 80.0, 110.0}) {  // the last from behind, where the coat reflects as well
    const float f = fresnel_dielectric(float(std::abs(std::cos(angle * M_PI / 180))), 1.5f);
    EXPECT_NEAR(s.albedo(at_angle(frame, angle))[0], f, 1e-5f);
    const auto sample = s.sample(at_angle(frame, angle), 0.01f, {});
    ASSERT_TRUE(sample);
    EXPECT_NEAR(sample->weight[0], f, 1e-5f);  // it is the only lobe
  }
}

TEST(LayeredShader, SmoothPlastic) {
  // f = rho / pi (1 - F(out)) (1 - F(in)) / (n^2 (1 - rho 0.596346)): light inside is always diffuse, and each time the mean
  // internal reflectance for n = 1.5 is reflected back.
  for (const double rho : {0.3, 0.9}) {
    const Ref<Shader> shader = layered(glass(), diffuse(rho));
    for (const double angle : {10.0, 60.0, 85.0}) {
      const Vector3 out = at_angle(frame, angle), in = at_angle(frame, 40, 3);
      const auto into = [](const Vector3& v) { return double(1 - fresnel_dielectric(v.z, 1.5f)); };
      const double expected = rho / M_PI * into(out) * into(in) / (2.25 * (1 - rho * 0.596346));
      for (const Transport t : {Transport::radiance, Transport::importance}) {
        Mean value;
        at_many_points(*shader, 5000, [&](const Scatter& s, test::Random&) {
          value.add(double(s.evaluate(out, in, {.transport = t})[0] / s.cosine(in)));
        });
        EXPECT_MEAN(value, expected) << rho << " at " << angle;
        EXPECT_LT(value.error(), 0.02 * expected);
      }
      Arena arena;
      const Scatter& s = *shader->bind(test::surface_point({0, 0, 1}), test::wavelengths(), arena);
      const double albedo = into(out) * rho * (1 - 0.596346) / (1 - rho * 0.596346);
      EXPECT_NEAR(s.albedo(out, diffuse_lobes)[0], albedo, 3e-5);
      EXPECT_NEAR(s.albedo(out)[0], albedo + 1 - into(out), 3e-5);
    }
  }
}

TEST(LayeredShader, SlabOfGlass) {
  // With all internal reflections: T = (1 - R) / (1 + R), the rest is reflected. Below the slab there is air again.
  const Ref<Shader> shader = layered(glass(1.5), glass(1));
  for (const double angle : {0.0, 60.0, 180.0}) {
    const double r = double(fresnel_dielectric(float(std::abs(std::cos(angle * M_PI / 180))), 1.5f)), t = (1 - r) / (1 + r);
    const Vector3 out = at_angle(frame, angle);
    Mean through, back;
    at_many_points(*shader, 20000, [&](const Scatter& s, test::Random& random) {
      const float choice = random();
      const auto sample = s.sample(out, choice, random.pair());
      ASSERT_TRUE(sample);
      const bool transmitted = sample->lobe == specular_transmission;
      if (transmitted) {
        EXPECT_LT(length(sample->direction + out), 1e-5f);
        EXPECT_NEAR(sample->eta, 1, 1e-6f);
      }
      through.add(transmitted ? double(sample->weight[0]) : 0);
      back.add(transmitted ? 0 : double(sample->weight[0]));
      EXPECT_EQ(s.lobes(), specular_reflection | specular_transmission);
      EXPECT_NEAR(s.albedo(out, transmission_lobes)[0], t, 1e-4);
    });
    EXPECT_MEAN(through, t);
    EXPECT_MEAN(back, 1 - t);
  }
}

TEST(LayeredShader, AbsorbsOnTheWay) {
  // Straight through an absorbing sheet without interfaces: Beer's law, by a medium between two null boundaries.
  const Ref<Shader> none = create<Shader>("PassThrough");
  const Ref<Shader> shader = layered(none, none, {{"medium", fog(300, 0, 0)}, {"thickness", 0.002}});
  Arena arena;
  const Scatter& s = *shader->bind(test::surface_point({0, 0, 1}), test::wavelengths(), arena);
  EXPECT_EQ(s.lobes(), null_scattering);
  for (const double angle : {0.0, 60.0, 130.0}) {
    const float expected = float(std::exp(-0.6 / std::abs(std::cos(angle * M_PI / 180))));
    EXPECT_NEAR(s.sample(at_angle(frame, angle), 0, {}, {.lobes = null_scattering})->weight[0], expected, 1e-5f);
    EXPECT_NEAR(s.sample(at_angle(frame, angle), 0.5f, {})->weight[0], expected, 1e-5f);
    EXPECT_NEAR(s.albedo(at_angle(frame, angle))[0], expected, 1e-5f);
  }
}

TEST(LayeredShader, SlabsOfFog) {
  // Isotropic scattering between two null boundaries, light along the normal: the fluxes and radiances of the slab of thickness
  // 1, and of a half space (Chandrasekhar 1950, Radiative transfer; his H function for the latter).
  const Ref<Shader> none = create<Shader>("PassThrough");
  struct Slab {
    double absorption, scattering, reflected, transmitted, back, on;
  };
  const Vector3 up{0, 0, 1};
  for (const Slab& slab : {Slab{0, 1, 0.34133, 0.65867, 0.085749, 0.078473}, Slab{0.1, 0.9, 0.26741, 0.59163, -1, -1},
                           Slab{4, 36, 0.414948, 0, 0.122572, 0}}) {
    const Ref<Shader> shader = layered(none, none, {{"medium", fog(slab.absorption, slab.scattering, 0)}, {"thickness", 1.0}});
    Mean reflected, transmitted, back, on;
    at_many_points(*shader, 20000, [&](const Scatter& s, test::Random& random) {
      const float choice = random();
      const auto sample = s.sample(up, choice, random.pair());
      const double weight = sample ? double(sample->weight[0]) : 0;
      reflected.add(sample && !sample->transmitted() ? weight : 0);
      transmitted.add(sample && sample->transmitted() ? weight : 0);
      back.add(double(s.evaluate(up, up)[0]));
      on.add(double(s.evaluate(up, -up)[0]));
    });
    EXPECT_MEAN(reflected, slab.reflected);
    EXPECT_MEAN(transmitted, slab.transmitted);
    if (slab.back < 0) continue;
    EXPECT_MEAN(back, slab.back);
    EXPECT_MEAN(on, slab.on);
  }
}

/// The error that albedo() may have, as it is an estimate: of all scattered light, and of the reflected light (the greatest
/// over all directions, found with a hundred thousand samples each). 0: the albedo is exact.
struct Estimate {
  double all, reflected;
};
struct Case {
  std::string name;
  Ref<Shader> shader;
  Estimate off;
  bool lossless = false;
};

/// Every kind of path: connected through smooth-lobe and delta interfaces, from the interface where light enters, after
/// scattering, and by way of specular chains.
std::vector<Case> cases() {
  const Ref<Shader> shiny = create<Shader>("PhongShader", {{"exponent", 30.0}, {"color", 0.1}, {"specular", 0.8}});
  const Ref<Shader> mirror = create<Shader>("PerfectSpecular", {{"color", 0.9}});
  const Ref<Shader> half = create<Shader>("MixShader", {{"first", mirror}, {"second", shiny}});
  const Ref<Shader> dull = create<Shader>("MixShader", {{"first", glass()}, {"second", diffuse(0.7)}, {"amount", 0.4}});
  const Ref<Shader> paper = create<Shader>("DiffuseTransmitter", {{"reflectance", 0.4}, {"transmittance", 0.6}});
  const Ref<Shader> waxed = create<Shader>("MixShader", {{"first", glass()}, {"second", paper}, {"amount", 0.5}});
  const Ref<Shader> plastic = layered(glass(), diffuse(0.8));
  return {{"white under glass", layered(glass(), diffuse(1)), {0, 0}, true},
          {"shiny under glass", layered(glass(), shiny), {0.135, 0.135}},
          {"shiny mirror under tinted glass", layered(glass(), half, {{"medium", fog(100, 0, 0)}}), {0.062, 0.062}},
          {"mirror under milk", layered(glass(), mirror, {{"medium", fog(100, 500, 0.4)}}), {0.132, 0.132}},
          {"slab of white milk", layered(glass(), glass(1), {{"medium", fog(0, 1500, 0.6)}}), {0, 0.08}, true},
          {"shiny mirror under dusty glass", layered(dull, half), {0.067, 0.067}},
          {"slab of dusty glass", layered(dull, glass(1), {{"medium", fog(50, 0, 0)}}), {0.047, 0.01}},
          {"paper on glass", layered(paper, glass(), {{"medium", fog(200, 0, 0)}}), {0.008, 0.006}},
          {"glass on paper", layered(glass(), paper), {0, 0.001}, true},
          {"waxed paper over paper in mist", layered(waxed, paper, {{"medium", fog(0, 300, -0.3)}}), {0, 0.088}, true},
          {"dusty below", layered(glass(), layered(glass(1.3), dull)), {0.017, 0.082}},
          {"plastic under glass", layered(glass(1.2), plastic), {0.006, 0.006}}};
}

/// A smooth function of direction, with different values in all directions.
double probe(const Vector3& v) { return std::pow(0.5 + 0.5 * double(v.x), 3) + (v.z > 0 ? 0.4 * double(v.z) : 0.2); }

TEST(LayeredShader, ValuesAreThoseOfSamples) {
  // The integral of f |cos| times a function: by samples; by evaluation in uniform directions; and by both, weighted with the
  // pdfs that are reported with them. All are equal, whatever the pdfs.
  for (const Case& c : cases())
    for (const double angle : {35.0, 140.0})
      for (const Transport t : {Transport::radiance, Transport::importance}) {
        const Vector3 out = at_angle(frame, angle);
        Mean difference, combined;
        at_many_points(*c.shader, 3000, [&](const Scatter& s, test::Random& random) {
          const float choice = random();
          const auto sample = s.sample(out, choice, random.pair(), {.transport = t});
          const double sampled = sample && !sample->specular() ? double(sample->weight[0]) * probe(sample->direction) : 0;
          const Vector3 in = warp::sphere(random.pair());
          const ScatterValue v = s.value_and_pdf(out, in, {.transport = t});
          const double value = double(v.value[0] / warp::sphere_pdf) * probe(in);
          difference.add(sampled - value);
          const auto weight = [](double p, double q) { return p > 0 ? p / (p + q) : 0; };
          combined.add(sampled * (sampled > 0 ? weight(double(sample->pdf), double(warp::sphere_pdf)) : 0) +
                       value * weight(double(warp::sphere_pdf), double(v.pdf)) - value);
          if (sample && !sample->specular()) {
            EXPECT_FLOAT_EQ(sample->pdf, s.pdf(out, sample->direction, {.transport = t})) << c.name;
            EXPECT_GT(sample->pdf, 0);
          }
        });
        EXPECT_MEAN(difference, 0) << c.name << " at " << angle;
        EXPECT_MEAN(combined, 0) << c.name << " at " << angle;
      }
}

TEST(LayeredShader, ImportanceIsTheAdjoint) {
  // f*(a, b) |b.ns| / |b.ng| = f(b, a) |a.ns| / |a.ng|, with a shading normal that is not the surface's.
  const Normal3 normal = normalize(Normal3(0.4f, -0.3f, 1));
  test::Random directions(3);
  for (const Case& c : cases())
    for (int i = 0; i < 4; ++i) {
      const Vector3 a = at_angle(frame, 60 * double(directions()), 6.28 * double(directions()));
      const Vector3 b = at_angle(frame, i < 2 ? 70 * double(directions()) : 180 - 60 * double(directions()), 2);
      Mean difference;
      double total = 0;
      at_many_points(
          *c.shader, 20000,  // importance has heavy tails at grazing angles
          [&](const Scatter& s, test::Random&) {
            const double light = double(s.evaluate(a, b, {.transport = Transport::importance})[0] / std::abs(b.z));
            const double camera = double(s.evaluate(b, a)[0] / std::abs(a.z));
            difference.add(light - camera);
            total += light + camera;
          },
          normal);
      EXPECT_MEAN(difference, 0) << c.name;
    }
}

TEST(LayeredShader, KeepsEnergyAndEstimatesIt) {
  for (const Case& c : cases())
    for (const double angle : {0.0, 60.0, 83.0, 130.0}) {
      const Vector3 out = at_angle(frame, angle);
      Mean all, reflected;
      double albedo = 0, albedo_reflected = 0;
      at_many_points(*c.shader, 25000, [&](const Scatter& s, test::Random& random) {
        const float choice = random();
        const auto sample = s.sample(out, choice, random.pair(), {.transport = Transport::importance});
        all.add(sample ? double(sample->weight[0]) : 0);
        reflected.add(sample && !sample->transmitted() ? double(sample->weight[0]) : 0);
        albedo = double(s.albedo(out)[0]);
        albedo_reflected = double(s.albedo(out, reflection_lobes)[0]);
        EXPECT_TRUE(!sample || s.has(sample->lobe)) << c.name;
      });
      if (c.lossless)
        EXPECT_MEAN(all, 1) << c.name;
      else
        EXPECT_LE(all.mean(), 1 + 5 * all.error() + 1e-4) << c.name;
      EXPECT_NEAR(albedo, all.mean(), c.off.all + 5 * all.error() + 5e-5) << c.name << " at " << angle;
      EXPECT_NEAR(albedo_reflected, reflected.mean(), c.off.reflected + 5 * reflected.error() + 5e-5)
          << c.name << " at " << angle;
    }
}

// A mirror under tinted glass, with all reflections between them: F + (1 - F)^2 a^2 m / (1 - F a^2 m), where a is the
// transmittance of one passage.
TEST(LayeredShader, AlbedoOfAMirrorUnderTintedGlass) {
  const Ref<Shader> mirror = create<Shader>("PerfectSpecular", {{"color", 0.9}});
  const Ref<Shader> shader = layered(glass(), mirror, {{"medium", fog(300, 0, 0)}});  // 1 mm by default
  Arena arena;
  const Scatter& s = *shader->bind(test::surface_point({0, 0, 1}), test::wavelengths(), arena);
  for (const double angle : {0.0, 45.0, 75.0}) {
    const double c = std::cos(angle * M_PI / 180), sine = std::sin(angle * M_PI / 180) / 1.5;
    const double f = double(fresnel_dielectric(float(c), 1.5f)), a = std::exp(-0.3 / std::sqrt(1 - sine * sine));
    const double m = 0.9 * a * a;
    EXPECT_NEAR(s.albedo(at_angle(frame, angle))[0], f + (1 - f) * (1 - f) * m / (1 - f * m), 1e-5) << angle;
  }
}

// Dense fog between two null boundaries: the two-stream model (Kubelka & Munk 1931) with K = 2 absorption and S = 3/4
// scattering, R = sinh(b) / (a sinh(b) + a' cosh(b)), T = a' / (...), a = (K + S) / S, a' = sqrt(a^2 - 1), b = a' S; and the
// unscattered light, exp(-extinction).
TEST(LayeredShader, AlbedoOfFogIsThatOfTwoStreams) {
  const Ref<Shader> none = create<Shader>("PassThrough");
  for (const double absorption : {0.05, 1.0, 4.0})
    for (const double scattering : {0.5, 6.0, 20.0}) {
      const Ref<Shader> shader = layered(none, none, {{"medium", fog(absorption, scattering, 0)}, {"thickness", 1.0}});
      Arena arena;
      const Scatter& s = *shader->bind(test::surface_point({0, 0, 1}), test::wavelengths(), arena);
      const double K = 2 * absorption, S = 0.75 * scattering, a = (K + S) / S, root = std::sqrt(a * a - 1), b = root * S;
      const double below = a * std::sinh(b) + root * std::cosh(b), unscattered = std::exp(-scattering);
      EXPECT_NEAR(s.albedo({0, 0, 1}, reflection_lobes)[0], (1 - unscattered) * std::sinh(b) / below, 2e-5)
          << absorption << " " << scattering;
      EXPECT_NEAR(s.albedo({0, 0, 1}, transmission_lobes)[0],
                  (1 - unscattered) * root / below + unscattered * std::exp(-absorption), 2e-5)
          << absorption << " " << scattering;
    }
}

TEST(LayeredShader, DispersesEachWavelengthItsOwnWay) {
  // Evaluations hold for all wavelengths of a path, each refracted with its own index: the closed form for plastic, per
  // wavelength.
  const Color index = table_spectrum({360, 830}, {1.8f, 1.3f});
  const Ref<Shader> shader = layered(create<Shader>("Dielectric", {{"ior", index}}), diffuse(0.5));
  const Vector3 out = at_angle(frame, 30), in = at_angle(frame, 55, 3);
  Mean value[spectrum_size];
  at_many_points(*shader, 3000, [&](const Scatter& s, test::Random&) {
    const Spectrum f = s.evaluate(out, in) / s.cosine(in);
    for (int i = 0; i < spectrum_size; ++i) value[i].add(double(f[i]));
  });
  const Wavelengths w = test::wavelengths();
  for (int i = 0; i < spectrum_size; ++i) {
    const float n = index->at(w[i], ColorUse::coefficient);
    const double inner = 1 - (1 - double(mean_fresnel_dielectric(n))) / double(n * n);
    const double t = double((1 - fresnel_dielectric(out.z, n)) * (1 - fresnel_dielectric(in.z, n)));
    EXPECT_MEAN(value[i], 0.5 / M_PI * t / (double(n * n) * (1 - 0.5 * inner)));
  }
}

}  // namespace
}  // namespace etendue
