// Microfacet shaders: distributions, Fresnel's equations, energy, against closed forms and quadrature.

#include <complex>

#include "components/shaders/microfacet/microfacet.h"

#include "components/shaders/fresnel.h"
#include "components/shaders/microfacet/rgb_reflectance.h"
#include "etendue/describe/color.h"
#include "etendue/object_map.h"
#include "support/component_test_support.h"

namespace etendue {
namespace {

using test::create;
using Distribution = MicrofacetDistribution;

Vector3 at_angle(double degrees, double azimuth = 0.7) {
  const double t = degrees * M_PI / 180;
  return {float(std::sin(t) * std::cos(azimuth)), float(std::sin(t) * std::sin(azimuth)), float(std::cos(t))};
}
Vector3 at_angle(const Frame& frame, double degrees, double azimuth = 0.7) {
  return frame.to_world(at_angle(degrees, azimuth));
}

const std::vector<Distribution>& distributions() {
  static const std::vector<Distribution> all = {{Distribution::ggx, 0.1f},           {Distribution::ggx, 0.5f},
                                                {Distribution::ggx, 0.6f, 0.2f},     {Distribution::ggx, 1},
                                                {Distribution::beckmann, 0.1f},      {Distribution::beckmann, 0.5f},
                                                {Distribution::beckmann, 0.6f, 0.2f}};
  return all;
}
std::string name_of(const Distribution& d) {
  return (d.kind == Distribution::ggx ? "ggx " : "beckmann ") + std::to_string(d.alpha_x) + " " + std::to_string(d.alpha_y);
}

/// The mean of g over the microfacets of a distribution, by area: the integral of D(m) m.z g(m) over normals. In steps of the
/// slope's length over alpha, tan(q pi / 2), and of its azimuth.
template <class G>
double mean_over_facets(const Distribution& d, int steps, G&& g) {
  double sum = 0;
  for (int i = 0; i < steps; ++i)
    for (int k = 0; k < steps; ++k) {
      const double q = (i + 0.5) / steps * M_PI / 2, r = std::tan(q), phi = 2 * M_PI * (k + 0.5) / steps;
      const double x = double(d.alpha_x) * r * std::cos(phi), y = double(d.alpha_y) * r * std::sin(phi);
      const double z = 1 / std::sqrt(1 + x * x + y * y);
      const Vector3 m{float(x * z), float(y * z), float(z)};
      // The area of slopes per solid angle of normals is 1 / z^3.
      const double area =
          double(d.alpha_x * d.alpha_y) * r / square(float(std::cos(q))) * (M_PI / 2 / steps) * (2 * M_PI / steps);
      sum += area * z * z * z * double(d.D(m)) * z * g(m);
    }
  return sum;
}

TEST(Microfacet, FacetsCoverTheSurfaceAndWhatIsSeenOfThem) {
  for (const Distribution& d : distributions()) {
    EXPECT_NEAR(mean_over_facets(d, 300, [](const Vector3&) { return 1.0; }), 1, 2e-4) << name_of(d);
    for (const double angle : {0.0, 30.0, 60.0, 80.0, 87.0}) {
      const Vector3 v = at_angle(angle);
      // The visible projected area equals that of the surface (Heitz 2014, eq. 14), and the pdf of visible normals integrates
      // to 1.
      const double seen = mean_over_facets(
          d, 300, [&](const Vector3& m) { return double(d.G1(v, m) * std::max(dot(v, m), 0.0f) / (m.z * v.z)); });
      EXPECT_NEAR(seen, 1, 1e-3) << name_of(d) << " at " << angle;
      const double pdf = mean_over_facets(
          d, 300, [&](const Vector3& m) { return d.D(m) > 0 ? double(d.visible_pdf(v, m) / (d.D(m) * m.z)) : 0; });
      EXPECT_NEAR(pdf, seen, 1e-4) << name_of(d) << " at " << angle;
    }
  }
}

TEST(Microfacet, VisibleNormalsFollowTheirDensity) {
  constexpr int rows = 40, columns = 24, count = 60000;
  const Frame frame(Normal3{0, 0, 1});
  const double significance = test::each_of(int(distributions().size()) * 4);
  std::uint32_t seed = 11;
  for (const Distribution& d : distributions())
    for (const double angle : {0.0, 50.0, 85.0, 120.0}) {  // the last from below
      const Vector3 v = at_angle(angle);
      std::vector<double> expected = test::integrate_cells(
          frame, rows, columns, [&](const Vector3& m) { return m.z > 0 ? double(d.visible_pdf(v, m)) * count : 0; });
      std::vector<double> counts(expected.size());
      test::Random random(seed++);
      for (int i = 0; i < count; ++i) ++counts[test::cell_of(frame, rows, columns, d.sample_visible(v, random.pair()))];
      EXPECT_GT(test::chi_square(counts, expected), significance) << name_of(d) << " at " << angle;
    }
}

TEST(Microfacet, BeckmannMasking) {
  // lambda = (exp(-a^2) / (a sqrt(pi)) - erfc(a)) / 2.
  const Distribution d(Distribution::beckmann, 0.5f);
  for (const double angle : {10.0, 40.0, 60.0, 80.0, 89.0}) {
    const double a = 1 / (0.5 * std::tan(angle * M_PI / 180));
    const double lambda = (std::exp(-a * a) / (a * std::sqrt(M_PI)) - std::erfc(a)) / 2;
    EXPECT_NEAR(d.lambda(at_angle(angle)), lambda, 3e-7 + 2e-5 * lambda) << angle;
  }
}

// Rows 23 to 27 of the validation data's table of closed-form values (analytic.md).
TEST(Microfacet, AlbedoOfSingleScatteringIsTheKnownOne) {
  const double alphas[] = {0.1, 0.25, 0.5, 1}, normal[] = {0.98830, 0.91581, 0.68785, 0.30685},
               mean[] = {0.97209, 0.88234, 0.70024, 0.40914};
  for (size_t i = 0; i < 4; ++i) {
    const Distribution d(Distribution::ggx, float(alphas[i]));
    const Vector3 v{0, 0, 1};
    const double albedo = mean_over_facets(d, 1000, [&](const Vector3& m) {
      const Vector3 in = reflect(v, m);
      return in.z > 0 ? double(dot(v, m) / m.z * d.G2(v, in)) : 0.0;
    });
    EXPECT_NEAR(albedo, normal[i], 2e-4) << alphas[i];
    const MultipleReflection multiple(d);
    EXPECT_NEAR(1 - multiple.missing(v), normal[i], 2.5e-3) << alphas[i];
    EXPECT_NEAR(1 - multiple.mean_missing(), mean[i], 7e-4) << alphas[i];
  }
}

// Rows 28 to 31 of the validation data's table of closed-form values.
TEST(Fresnel, KnownValues) {
  EXPECT_NEAR(fresnel_dielectric(1, 1.5f), 0.040000, 1e-6);
  EXPECT_NEAR(fresnel_dielectric(std::cos(radians(45)), 1.5f), 0.050240, 1e-6);
  EXPECT_NEAR(fresnel_dielectric(0.5f, 1.5f), 0.089187, 1e-6);
  float behind = 0;
  EXPECT_LT(fresnel_dielectric_polarized(std::cos(radians(56.310f)), 1.5f, behind).p, 1e-9f);
  EXPECT_LT(fresnel_dielectric(std::cos(radians(41.800f)), 1 / 1.5f), 1);
  EXPECT_EQ(fresnel_dielectric(std::cos(radians(41.820f)), 1 / 1.5f), 1);
  EXPECT_NEAR(mean_fresnel_dielectric(1.5f), 0.091778, 1e-6);
  EXPECT_NEAR(mean_fresnel_dielectric(1 / 1.5f), 0.596346, 1e-6);
  EXPECT_NEAR(mean_fresnel_dielectric(1.00009f), mean_fresnel_dielectric(1.00011f), 1e-5);
  EXPECT_NEAR(fresnel_conductor(1, 0.789f, 6.15f), 0.923068, 1e-6);
  // Without absorption a conductor reflects like a dielectric, with total internal reflection.
  for (const float eta : {1.5f, 0.5f})
    for (const float c : {0.02f, 0.3f, 0.8f, 1.0f})
      EXPECT_NEAR(fresnel_conductor(c, eta, 0), fresnel_dielectric(c, eta), 2e-6f) << eta << " " << c;
  // The quadrature rule for the mean, against many steps.
  for (const auto& [n, k] : {std::pair{0.2f, 3.0f}, {1.3f, 7.1f}, {3.1f, 3.3f}}) {
    double sum = 0;
    for (int i = 0; i < 5000; ++i) sum += double(fresnel_conductor((float(i) + 0.5f) / 5000, n, k)) * 2 * (i + 0.5) / 5e3 / 5e3;
    EXPECT_NEAR(mean_fresnel_conductor(n, k)[0], sum, 1e-3);
  }
}

/// The albedo seen from `out`: the mean weight of n^2 samples of stratified directions.
Spectrum sampled_albedo(const Scatter& s, const Vector3& out, int n, Lobes lobes = all_lobes) {
  Spectrum sum;
  test::Random random(5);
  for (int i = 0; i < n * n; ++i) {
    const Point2 u{(float(i % n) + random()) / float(n), (float(i / n) + random()) / float(n)};
    if (const auto sample = s.sample(out, random(), u, {Transport::importance, lobes})) sum += sample->weight;
  }
  return sum / float(n * n);
}

// A white furnace: a metal of n = 0.01 and k = 99 reflects everything, to 1e-5 at normal incidence.
TEST(Conductor, CompensatedLosesNothing) {
  for (const char* kind : {"ggx", "beckmann"})
    for (const auto& [x, y] : {std::pair{0.05, 0.05}, {0.3, 0.3}, {1.0, 1.0}, {0.5, 0.1}, {0.8, 0.4}})
      for (const double angle : {0.0, 40.0, 70.0, 86.0}) {
        const Color index = complex_index(flat_spectrum(0.01f), flat_spectrum(99));
        const Ref<Shader> shader =
            create<Shader>("Conductor", {{"ior", index}, {"roughness", x}, {"roughness_v", y}, {"distribution", kind}});
        Arena arena;
        const Scatter& s = *shader->bind(test::surface_point(), test::wavelengths(), arena);
        const Vector3 out = at_angle(s.frame(), angle);
        const double albedo = double(sampled_albedo(s, out, 150)[0]);
        EXPECT_NEAR(albedo, 1, x == y ? 0.008 : 0.015) << kind << " " << x << " " << y << " at " << angle;
        EXPECT_NEAR(s.albedo(out)[0], albedo, 0.02);
      }
}

TEST(Conductor, SmoothIsAMirrorOfTheMetalsColour) {
  Arena arena;
  const Scatter& s =
      *create<Shader>("Conductor", {{"ior", complex_index(flat_spectrum(0.789f), flat_spectrum(6.15f))}, {"roughness", 0.0}})
           ->bind(test::surface_point(), test::wavelengths(), arena);
  EXPECT_EQ(s.lobes(), specular_reflection);
  EXPECT_NEAR(s.sample(at_angle(s.frame(), 0), 0.5f, {})->weight[0], 0.923068, 1e-6);
  EXPECT_NEAR(s.sample(at_angle(s.frame(), 180), 0.5f, {})->weight[0], 0.923068, 1e-6);
  EXPECT_THROW(create<Shader>("Conductor", {{"roughness", 1.5}}), Error);
}

// Copper as three-channel renderers define it (Bitterli's scenes): the reflected light has, under its white, the red, green and
// blue that Fresnel's equations give for each channel.
TEST(Conductor, OfThreeChannelsReflectsTheirColourAtEachAngle) {
  const std::vector<double> n{0.200438, 0.924033, 1.10221}, k{3.91295, 2.45285, 2.14219};
  const Ref<Shader> shader = create<Shader>("Conductor", {{"index", "rgb"}, {"rgb_n", n}, {"rgb_k", k}, {"roughness", 0.0}});
  const RgbSpace& space = rgb_space("srgb");
  Arena arena;
  for (const double angle : {0.0, 60.0, 80.0}) {
    Xyz sum{};
    for (int lambda = 360; lambda <= 830; ++lambda) {
      Wavelengths w;
      for (int i = 0; i < spectrum_size; ++i) w.place(i, float(lambda), 1 / 470.0f);
      const Scatter& s = *shader->bind(test::surface_point(), w, arena);
      const double reflected = double(s.albedo(at_angle(s.frame(), angle))[0]) *
                               double(space.illuminant->at(float(lambda), ColorUse::radiance)) / observer_y_integral();
      const Xyz o = observer(float(lambda));
      sum = {sum.x + reflected * o.x, sum.y + reflected * o.y, sum.z + reflected * o.z};
    }
    for (size_t c = 0; c < 3; ++c) {
      // Born & Wolf, by complex numbers, unlike the shader's own form.
      const std::complex<double> m(n[c], k[c]), cosine = std::cos(angle * M_PI / 180),
                                                inside = std::sqrt(1.0 - (1.0 - cosine * cosine) / (m * m));
      const double wanted = (std::norm((cosine - m * inside) / (cosine + m * inside)) +
                             std::norm((m * cosine - inside) / (m * cosine + inside))) /
                            2;
      const double seen = space.from_xyz[3 * c] * sum.x + space.from_xyz[3 * c + 1] * sum.y + space.from_xyz[3 * c + 2] * sum.z;
      EXPECT_NEAR(seen, wanted, 2e-3) << angle << " " << c;
    }
  }
  EXPECT_THROW(create<Shader>("Conductor", {{"index", "rgb"}, {"rgb_n", std::vector<double>{1, 0, 1}}}), Error);
  EXPECT_THROW(create<Shader>("Conductor", {{"index", "rgb"}, {"rgb_k", std::vector<double>{1, -1, 1}}}), Error);
}

// The table over angles against the exact computation for each angle, which the previous test compares with the equations.
TEST(Conductor, OfThreeChannelsIsTabulatedWithinItsBound) {
  test::Random random(6);
  const RgbSpace& space = rgb_space("srgb");
  float worst = 0;
  for (const auto& [n, k] : {std::pair{Vector3{0.200438f, 0.924033f, 1.10221f}, Vector3{3.91295f, 2.45285f, 2.14219f}},
                             std::pair{Vector3{1.44f, 0.86f, 0.60f}, Vector3{7.74f, 6.40f, 5.39f}},
                             std::pair{Vector3{0.05f, 3, 1}, Vector3{9, 0, 0.1f}}}) {
    const RgbReflectance table(space, n, k);
    for (int i = 0; i < 4000; ++i) {
      const float u = random(), cosine = i % 2 ? u : u * u * u;  // half of them concentrated near grazing angles
      const Wavelengths w = test::wavelengths(380 + 400 * random());
      const Spectrum wanted = table.seen(fresnel_conductor(cosine, table.n(), table.k()), w),
                     found = table.reflectance(cosine, w);
      for (int l = 0; l < spectrum_size; ++l) worst = std::max(worst, std::abs(found[l] - wanted[l]));
    }
    EXPECT_EQ(table.reflectance(1, test::wavelengths())[0],
              table.seen(fresnel_conductor(1, table.n(), table.k()), test::wavelengths())[0]);
  }
  EXPECT_LE(worst, 2 * RgbReflectance::tolerance);  // the tolerance holds at the middle of cells
}

TEST(Dielectric, RoughAndCompensatedLosesNothing) {
  for (const char* kind : {"ggx", "beckmann"})
    for (const double alpha : {0.1, 0.4, 0.9})
      for (const double angle : {0.0, 45.0, 80.0, 110.0, 150.0, 180.0}) {
        const Ref<Shader> shader = create<Shader>("Dielectric", {{"roughness", alpha}, {"distribution", kind}});
        Arena arena;
        const Scatter& s = *shader->bind(test::surface_point(), test::wavelengths(), arena);
        const Vector3 out = at_angle(s.frame(), angle);
        EXPECT_NEAR(sampled_albedo(s, out, 150)[0], 1, 0.02) << kind << " " << alpha << " at " << angle;
        const Spectrum back = sampled_albedo(s, out, 60, reflection_lobes),
                       beyond = sampled_albedo(s, out, 60, transmission_lobes);
        EXPECT_NEAR(back[0] + beyond[0], 1, 0.03) << kind << " " << alpha << " at " << angle;
      }
}

TEST(Dielectric, RoughIsReciprocalAndKeepsAllWavelengths) {
  const Ref<Shader> shader =
      create<Shader>("Dielectric", {{"roughness", 0.3}, {"ior", table_spectrum({360, 830}, {1.6f, 1.5f})}});
  Arena arena;
  const Scatter& s = *shader->bind(test::surface_point(), test::wavelengths(), arena);
  test::Random random(9);
  int through = 0;
  for (int i = 0; i < 500; ++i) {
    const Vector3 a = random.direction(), b = random.direction();
    const Spectrum from_light = s.evaluate(a, b, {.transport = Transport::importance}) / s.cosine(b),
                   from_camera = s.evaluate(b, a) / s.cosine(a);
    for (int k = 0; k < spectrum_size; ++k) EXPECT_NEAR(from_light[k], from_camera[k], 1e-3f * from_camera[k] + 1e-7f);
    through += dot(s.frame().n, a) * dot(s.frame().n, b) < 0 && !from_light.black();
  }
  EXPECT_GT(through, 100);
  // Each wavelength for itself: no weight exceeds 4 by much.
  const Vector3 out = at_angle(s.frame(), 30);
  for (int i = 0; i < 2000; ++i) {
    const float choice = random();
    if (const auto sample = s.sample(out, choice, random.pair(), {.transport = Transport::importance})) {
      EXPECT_FALSE(sample->dispersive);
      EXPECT_LT(sample->weight.maximum(), 4.5f);
    }
  }
  // The albedo of all wavelengths, by quadrature over all directions: multiple scattering is known for the hero alone, and at
  // the other wavelengths it is off by the difference of the indices times the few hundredths of light that it scatters.
  Spectrum albedo;
  constexpr int steps = 300;
  for (int i = 0; i < steps; ++i)
    for (int k = 0; k < steps; ++k) {
      const float z = -1 + 2 * (float(i) + 0.5f) / steps, phi = 2 * pi * (float(k) + 0.5f) / steps, r = std::sqrt(1 - z * z);
      const Vector3 in = s.frame().to_world({r * std::cos(phi), r * std::sin(phi), z});
      albedo += s.evaluate(out, in, {.transport = Transport::importance}) * (4 * pi / (steps * steps));
    }
  for (int k = 0; k < spectrum_size; ++k) EXPECT_NEAR(albedo[k], 1, 0.006) << k;
}

// Row 32 of the validation data's table of closed-form values.
TEST(ThinDielectric, AllReflectionsInside) {
  Arena arena;
  const Ref<Shader> shader = create<Shader>("ThinDielectric");
  const Scatter& s = *shader->bind(test::surface_point(), test::wavelengths(), arena);
  EXPECT_FALSE(shader->transmits());
  const Vector3 normal = at_angle(s.frame(), 0);
  EXPECT_NEAR(s.albedo(normal, null_scattering)[0], 0.923077, 1e-6);
  EXPECT_NEAR(s.albedo(normal, specular_reflection)[0], 1 - 0.923077, 1e-6);
  for (const double angle : {20.0, 56.3, 80.0, 130.0}) {
    const Vector3 out = at_angle(s.frame(), angle);
    EXPECT_NEAR(s.albedo(out)[0], 1, 1e-6);
    // Against the sum of ten passages, for each polarization separately.
    float behind = 0;
    const PolarizedReflectance r = fresnel_dielectric_polarized(std::abs(s.cosine(out)), 1.5f, behind);
    double transmitted = 0;
    for (const double R : {double(r.s), double(r.p)})
      for (int k = 0; k < 10; ++k) transmitted += 0.5 * (1 - R) * (1 - R) * std::pow(R, 2 * k);
    EXPECT_NEAR(s.albedo(out, null_scattering)[0], transmitted, 1e-4);
    const auto straight = s.sample(out, 0, {}, {.lobes = null_scattering});
    EXPECT_NEAR(straight->weight[0], transmitted, 1e-4);
    EXPECT_LT(length(straight->direction + out), 1e-6f);
    EXPECT_EQ(straight->eta, 1);
  }
  // Half of the light is absorbed in one passage: T' = (1 - R)^2 a / (1 - a^2 R^2).
  const Scatter& grey =
      *create<Shader>("ThinDielectric", {{"color", 0.5}})->bind(test::surface_point(), test::wavelengths(), arena);
  EXPECT_NEAR(grey.albedo(normal, null_scattering)[0], 0.96 * 0.96 * 0.5 / (1 - 0.25 * 0.04 * 0.04), 1e-6);
}

TEST(Plastic, AlbedoIsThatOfTheFormula) {
  const double inside = 0.596346;
  for (const double rho : {0.3, 1.0})
    for (const bool nonlinear : {true, false})
      for (const double roughness : {0.0, 0.1, 0.6})
        for (const double angle : {0.0, 50.0, 80.0, 140.0}) {
          const Ref<Shader> shader = create<Shader>("Plastic", {{"color", rho}, {"roughness", roughness}});
          set(*shader, "nonlinear", Value(nonlinear));
          Arena arena;
          const Scatter& s = *shader->bind(test::surface_point(), test::wavelengths(), arena);
          const Vector3 out = at_angle(s.frame(), angle);
          const double body = nonlinear ? rho * (1 - inside) / (1 - rho * inside) : rho;
          const double through = double(s.albedo(out, diffuse_reflection)[0]) / body;
          const Spectrum albedo = sampled_albedo(s, out, 100);
          if (roughness == 0) {
            EXPECT_NEAR(through, 1 - fresnel_dielectric(s.cosine(out), 1.5f), 1e-5);
            EXPECT_NEAR(s.sample(out, 0, {}, {.lobes = specular_reflection})->weight[0], 1 - through, 1e-5);
          } else if (rho == 1) {
            EXPECT_NEAR(albedo[0], 1, 0.01) << roughness << " at " << angle;
          }
          EXPECT_NEAR(albedo[0], s.albedo(out)[0], 0.01) << rho << " " << nonlinear << " " << roughness << " at " << angle;
        }
}

}  // namespace
}  // namespace etendue
