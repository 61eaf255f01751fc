// Bodies with subsurface scattering: the profile, albedo inversion, energy, and the exit points.

#include "components/shaders/fresnel.h"
#include "components/shaders/subsurface/albedo_inversion.h"
#include "components/shaders/subsurface/diffusion_profile.h"
#include "etendue/describe/color.h"
#include "etendue/render/job.h"
#include "etendue/sampler.h"
#include "etendue/scene.h"
#include "support/component_test_support.h"
#include "support/render_support.h"

namespace etendue {
namespace {

using test::create;

/// A scene of one object with a Subsurface shader, and the point where a ray from above first hits it.
class Body {
 public:
  Body(const std::string& object, const std::string& members)
      : job_(load_job_text(
            test::job_text("PathTracer {}", "PerspectiveCamera {}", 4, object + ", shader: Subsurface { " + members + " } }"),
            "test.etd")),
        sampler_(create<Sampler>("IndependentSampler")) {
    prepare_tree(*job_->scene);
    Ray ray;
    ray.origin = {0.2f, 0.1f, 5};
    ray.direction = {0, 0, -1};
    Hit hit;
    if (!job_->scene->nearest(ray, hit)) throw std::logic_error("no body below");
    job_->scene->locate(ray, hit, entry);
  }

  std::optional<SubsurfaceExit> exit(std::uint32_t sample, const Wavelengths& w = test::wavelengths()) {
    NumberStream stream(*sampler_, SampleKey(1, 0, 0, sample));
    arena.reset();
    return entry.object->shader->sample_exit(entry, *job_->scene, w, stream, arena);
  }
  /// The mean weight at each wavelength, and the standard error of the first.
  Spectrum mean(int count, double& error, const Wavelengths& w = test::wavelengths()) {
    Spectrum sum;
    double squares = 0;
    for (int i = 0; i < count; ++i)
      if (const auto e = exit(std::uint32_t(i), w)) {
        sum += e->weight;
        squares += double(e->weight[0]) * double(e->weight[0]);
      }
    sum /= float(count);
    error = std::sqrt(std::max(squares / count - double(sum[0]) * double(sum[0]), 0.0) / count);
    return sum;
  }

  SurfacePoint entry;
  Arena arena;

 private:
  Ref<Job> job_;
  Ref<Sampler> sampler_;
};

constexpr const char* plane = "Rectangle { corner: [-50, -50, 0], edge_u: [100, 0, 0], edge_v: [0, 100, 0]";
constexpr const char* sphere = "Sphere { radius: 1";

// ---- the profile ----------------------------------------------------------------------------------------------------

TEST(Subsurface, ProfileIsNormalised) {
  for (const float d : {1e-4f, 1.0f, 30.0f}) {
    const DiffusionProfile profile(d);
    double sum = 0;
    constexpr int steps = 20000;
    for (int i = 0; i < steps; ++i) {
      const double r = (i + 0.5) / steps * double(profile.end());
      sum += double(profile.by_area(float(r))) * 2 * M_PI * r * double(profile.end()) / steps;
      if (i % 4000 == 3999) {
        EXPECT_NEAR(sum, profile.within(float(r)), 1e-3) << r;
      }
    }
    EXPECT_NEAR(sum, 1, 1e-4);
    EXPECT_EQ(profile.by_area(profile.end() * 1.01f), 0);
  }
}

TEST(Subsurface, RadiiFollowTheProfile) {
  const DiffusionProfile profile(0.3f);
  constexpr int cells = 40, count = 40000;
  std::vector<double> counts(cells), expected;
  test::Random random(1);
  for (int i = 0; i < count; ++i)
    counts[std::min(size_t(profile.within(profile.sample(random())) * cells), size_t(cells - 1))] += 1;
  expected.assign(cells, double(count) / cells);
  EXPECT_GT(test::chi_square(counts, expected), 1e-3);
}

// ---- albedo inversion -----------------------------------------------------------------------------------------------

// Isotropic scattering without a boundary: the fraction 1 - sqrt(1 - w) 2 int H mu dmu of diffuse light is returned, where H is
// Chandrasekhar's (1950, chapter 5), 1 / H(mu) = sqrt(1 - w) + w / 2 int H(m) m / (mu + m) dm.
TEST(Subsurface, InversionAgreesWithChandrasekhar) {
  const AlbedoInversion inversion(0, 1);
  for (const double w : {0.2, 0.5, 0.9, 0.99, 0.999}) {
    constexpr int n = 200;
    std::vector<double> h(n, 1);
    for (int iteration = 0; iteration < 400; ++iteration)
      for (size_t i = 0; i < n; ++i) {
        double sum = 0;
        for (size_t k = 0; k < n; ++k) sum += h[k] * (double(k) + 0.5) / (double(i + k) + 1) / n;
        h[i] = 1 / (std::sqrt(1 - w) + w / 2 * sum);
      }
    double returned = 1;
    for (size_t i = 0; i < n; ++i) returned -= std::sqrt(1 - w) * 2 * h[i] * (double(i) + 0.5) / n / n;
    EXPECT_NEAR(double(inversion.albedo(float(returned))), w, 1.5e-3 * (1 - w) + 1e-3 * w) << w;
  }
  EXPECT_EQ(inversion.albedo(1), 1);
  EXPECT_EQ(inversion.albedo(0), 0);
}

TEST(Subsurface, WalkReturnsTheColourAskedFor) {
  struct Case {
    double color, g, ior;
  };
  for (const Case c : {Case{0.1, 0, 1.4}, {0.5, 0, 1.4}, {0.8, 0, 1.4}, {0.5, 0, 1}, {0.5, 0.8, 1.3}, {0.5, -0.5, 1.6}}) {
    Body body(sphere, "method: random_walk, mean_free_path: 0.001, color: " + std::to_string(c.color) +
                          ", anisotropy: " + std::to_string(c.g) + ", ior: " + std::to_string(c.ior));
    double error = 0;
    const Spectrum mean = body.mean(c.g > 0 ? 6000 : 15000, error);
    EXPECT_NEAR(double(mean[0]), c.color, 0.02 * c.color + 3.3 * error) << c.color << " " << c.g << " " << c.ior;
    EXPECT_LT(3.3 * error, 0.03);
  }
}

// ---- energy ---------------------------------------------------------------------------------------------------------

TEST(Subsurface, WhiteBodiesReturnAllLight) {
  double error = 0;
  Body flat(plane, "color: 1, mean_free_path: 0.01");
  for (std::uint32_t i = 0; i < 500; ++i) {
    const auto e = flat.exit(i);
    ASSERT_TRUE(e);
    EXPECT_NEAR(e->weight.minimum(), 1, 1e-3f);
  }
  Body grey(sphere, "color: 1, mean_free_path: 0.1, method: random_walk");
  for (std::uint32_t i = 0; i < 500; ++i) {
    const auto e = grey.exit(i);
    ASSERT_TRUE(e);
    EXPECT_NEAR(e->weight.minimum(), 1, 1e-3f);
  }
  // Coefficients that differ between wavelengths: single walks have any weights, but their mean is preserved.
  Body colored(sphere, "color: 1, mean_free_path: rgb(0.2, 0.1, 0.05), anisotropy: 0.5, method: random_walk");
  const Spectrum mean = colored.mean(6000, error);
  EXPECT_NEAR(mean.average(), 1, 1e-3f);
  EXPECT_NEAR(double(mean[0]), 1, 3.3 * error);
  EXPECT_LT(error, 0.05);
}

TEST(Subsurface, PlaneReturnsTheColourAtAllWavelengths) {
  double error = 0;
  Body body(plane, "color: rgb(0.8, 0.5, 0.2), mean_free_path: rgb(0.02, 0.01, 0.005)");
  const Spectrum mean = body.mean(20000, error);
  const Spectrum color = rgb_color("srgb", 0.8, 0.5, 0.2)->evaluate(test::wavelengths(), ColorUse::reflectance);
  for (int k = 0; k < spectrum_size; ++k) EXPECT_NEAR(mean[k], color[k], 0.03f * color[k]) << k;

  Wavelengths hero = test::wavelengths();
  hero.drop_secondary();
  EXPECT_NEAR(body.mean(500, error, hero)[0], color[0], 2e-3f);
}

TEST(Subsurface, BoundaryAndExitConserveEnergy) {
  Body body(sphere, "color: 1, ior: 1.5");
  const Shader& shader = *body.entry.object->shader;
  EXPECT_TRUE(shader.has_subsurface_exit());
  EXPECT_FALSE(shader.transmits());
  const Scatter* boundary = shader.bind(body.entry, test::wavelengths(), body.arena);
  test::Random random(4);
  for (int i = 0; i < 200; ++i) {
    const Vector3 out = random.direction();
    if (dot(out, body.entry.normal) < 0.01f) continue;
    const auto s = boundary->sample(out, random(), random.pair());
    ASSERT_TRUE(s);
    EXPECT_NEAR(s->weight[0], 1, 1e-5f);
    EXPECT_NEAR(boundary->albedo(out)[0], 1, 1e-6f);
    EXPECT_EQ(s->transmitted(), dot(s->direction, body.entry.normal) < 0);
    const auto only = boundary->sample(out, random(), random.pair(), {.lobes = specular_transmission});
    EXPECT_NEAR(only->weight[0], 1 - fresnel_dielectric(dot(out, body.entry.normal), 1.5f), 1e-5f);
  }
  const auto e = body.exit(1);
  ASSERT_TRUE(e && e->scatter);
  const Vector3 out(e->point.normal);
  double albedo = 0;
  for (const double cell : test::integrate_cells(e->scatter->frame(), 40, 8,
                                                 [&](const Vector3& in) { return double(e->scatter->evaluate(out, in)[0]); }))
    albedo += cell;
  EXPECT_NEAR(albedo, 1, 2e-3);
}

// ---- where light leaves ---------------------------------------------------------------------------------------------

TEST(Subsurface, ExitsOnAPlaneFollowTheProfile) {
  Body body(plane, "color: 0.6, mean_free_path: 0.05, ior: 1");
  const DiffusionProfile profile(DiffusionProfile::scale(0.6f, 0.05f));
  constexpr int rings = 8, sectors = 6, count = 20000;
  std::vector<double> counts(rings * sectors), expected(rings * sectors, double(count) / (rings * sectors));
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto e = body.exit(i);
    ASSERT_TRUE(e);
    EXPECT_NEAR(e->weight[0], 0.6f, 1e-3f);
    const Vector3 d = e->point.position - body.entry.position;
    const double turn = std::atan2(double(d.y), double(d.x)) / (2 * M_PI) + 0.5;
    const int ring = std::min(int(profile.within(length(d)) * rings), rings - 1),
              sector = std::min(int(turn * sectors), sectors - 1);
    counts[size_t(ring * sectors + sector)] += 1;
  }
  EXPECT_GT(test::chi_square(counts, expected), 1e-3);
}

// With the balance heuristic over the probe lines, the mean is the integral of A R over the body's surface, whatever its shape.
TEST(Subsurface, ExitsOnASphereIntegrateTheProfile) {
  Body body(sphere, "color: 0.9, mean_free_path: 0.3, ior: 1");
  const DiffusionProfile profile(DiffusionProfile::scale(0.9f, 0.3f));
  // In terms of the distance r from the entry, the area of a sphere of radius 1 is 2 pi r dr for r up to 2.
  const double expected = 0.9 * double(profile.within(2));
  double error = 0;
  const Spectrum mean = body.mean(20000, error);
  EXPECT_NEAR(double(mean[0]), expected, 3.3 * error);
  EXPECT_LT(error, 0.01);
  double sum = 0;
  for (std::uint32_t i = 0; i < 20000; ++i)
    if (const auto e = body.exit(i); e && distance(e->point.position, body.entry.position) < 0.5f) sum += double(e->weight[0]);
  EXPECT_NEAR(sum / 20000, 0.9 * double(profile.within(0.5f)), 3.3 * 0.45 / std::sqrt(20000.0) + error);
}

// The profile was fitted to walks without a boundary, and is widened for one that reflects: both methods spread light alike.
TEST(Subsurface, WalkAndProfileSpreadAlike) {
  for (const std::string ior : {"1", "1.5"}) {
    const std::string members = "color: 0.6, mean_free_path: 0.002, ior: " + ior;
    Body walk(sphere, members + ", method: random_walk"), diffusion(sphere, members);
    constexpr float radii[] = {0.001f, 0.003f, 0.008f};
    double within[2][3] = {}, whole[2] = {};
    for (const int k : {0, 1})
      for (std::uint32_t i = 0; i < 6000; ++i) {
        Body& body = k ? diffusion : walk;
        const auto e = body.exit(i);
        if (!e) continue;
        whole[k] += double(e->weight[0]);
        for (int n = 0; n < 3; ++n)
          if (distance(e->point.position, body.entry.position) < radii[n]) within[k][n] += double(e->weight[0]);
      }
    for (int n = 0; n < 3; ++n) EXPECT_NEAR(within[0][n] / whole[0], within[1][n] / whole[1], 0.06) << ior << " " << radii[n];
  }
}

TEST(Subsurface, RefusesWhatMakesNoSense) {
  EXPECT_THROW(create<Shader>("Subsurface", {{"mean_free_path", 0.0}}), Error);
  EXPECT_THROW(create<Shader>("Subsurface", {{"ior", 0.0}}), Error);
  EXPECT_THROW(create<Shader>("Subsurface", {{"color", 1.5}}), Error);
  EXPECT_THROW(create<Shader>("Subsurface", {{"anisotropy", 1.0}}), Error);
}

}  // namespace
}  // namespace etendue
