// Microfacet models against their papers' formulas, computed here in double precision, with all members away from their
// defaults: anisotropic alphas along a tangent that is rotated, both sides of the surface.

#include <complex>

#include "components/shaders/microfacet/microfacet.h"
#include "etendue/object_map.h"
#include "support/shader_formulas_support.h"

namespace etendue::formulas_test {
namespace {

struct Facets {
  bool ggx;
  double ax, ay;
  double D(const V& m) const {
    const double t2 = (pow2(m.x / ax) + pow2(m.y / ay)) / pow2(m.z), c4 = pow2(pow2(m.z));
    return (ggx ? 1 / pow2(1 + t2) : std::exp(-t2)) / (M_PI * ax * ay * c4);
  }
  double lambda(const V& v) const {
    const double t2 = (pow2(ax * v.x) + pow2(ay * v.y)) / pow2(v.z);
    if (t2 == 0) return 0;
    if (ggx) return (std::sqrt(1 + t2) - 1) / 2;
    const double a = 1 / std::sqrt(t2);
    return (std::exp(-a * a) / (a * std::sqrt(M_PI)) - std::erfc(a)) / 2;
  }
  double hidden(const V& out, const V& in, bool independent) const {  // 1 / G2
    const double a = lambda(out), b = lambda(in);
    return independent ? (1 + a) * (1 + b) : 1 + a + b;
  }
  double reflection(const V& out, const V& in, bool independent = false) const {  // f / F
    const V m = unit(sum(out, in));
    return D(m) / hidden(out, in, independent) / (4 * out.z * in.z);
  }
};

/// Fresnel's amplitudes for any complex index: |r|^2 averaged over both polarisations.
double fresnel(double cosine, std::complex<double> n) {
  const std::complex<double> inside = std::sqrt(n * n - (1 - cosine * cosine));
  const double s = std::norm((cosine - inside) / (cosine + inside)),
               p = std::norm((n * n * cosine - inside) / (n * n * cosine + inside));
  return (s + p) / 2;
}

TEST(ShaderFormulas, RoughConductor) {
  const Slope tint{0.9, 0.6}, n{0.3, 1.2}, k{2, 4};
  for (const bool ggx : {true, false}) {
    const Facets facets{ggx, 0.45, 0.2};
    const auto f = [&](const V& out, const V& in, double l) {
      return tint(l) * fresnel(dot(out, unit(sum(out, in))), {n(l), k(l)}) * facets.reflection(out, in);
    };
    const std::vector<Setting> settings = {{"ior", complex_index(n.color(), k.color())},
                                           {"color", tint.color()},
                                           {"roughness", 0.45},
                                           {"roughness_v", 0.2},
                                           {"rotation", 0.1},
                                           {"distribution", ggx ? "ggx" : "beckmann"}};
    const Ref<Shader> once = create<Shader>("Conductor", settings);
    set(*once, "multiple_scattering", Value(false));
    once->prepare();
    expect_formula("once", once, 0.1, f);
    for (const char* heights : {"independent", "correlated"}) {
      set(*once, "heights", Value(std::string(heights)));
      once->prepare();
      expect_formula(heights, once, 0.1, [&](const V& out, const V& in, double l) {
        return f(out, in, l) * facets.hidden(out, in, false) / facets.hidden(out, in, heights == std::string("independent"));
      });
    }

    // Multiple scattering has a lobe of its own (Kulla & Conty 2017), whose colour is a series in the mean reflectance.
    const MultipleReflection more({ggx ? MicrofacetDistribution::ggx : MicrofacetDistribution::beckmann, 0.45f, 0.2f});
    expect_formula(
        "all", create<Shader>("Conductor", settings), 0.1,
        [&](const V& out, const V& in, double l) {
          const double mean = diffuse_mean([&](double c) { return fresnel(c, {n(l), k(l)}); }, 400);
          const double lost = double(more.mean_missing());
          const auto missing = [&](const V& v) { return double(more.missing({float(v.x), float(v.y), float(v.z)})); };
          return f(out, in, l) +
                 tint(l) * mean * mean * (1 - lost) / (1 - mean * lost) * missing(out) * missing(in) / (M_PI * lost);
        },
        1.5e-3);
  }
}

TEST(ShaderFormulas, RoughDielectric) {
  const Slope n{1.7, 1.4};
  for (const auto& [ggx, heights] :
       {std::pair(true, "by_side"), {false, "by_side"}, {true, "independent"}, {false, "correlated"}}) {
    const Facets facets{ggx, 0.5, 0.25};
    const bool apart_above = heights == std::string("independent"), apart_through = heights != std::string("correlated");
    const Ref<Shader> shader = create<Shader>("Dielectric", {{"ior", n.color()},
                                                             {"heights", heights},
                                                             {"roughness", 0.5},
                                                             {"roughness_v", 0.25},
                                                             {"rotation", 0.3},
                                                             {"distribution", ggx ? "ggx" : "beckmann"}});
    set(*shader, "multiple_scattering", Value(false));
    shader->prepare();
    const Wavelengths w = test::wavelengths(500);
    Arena arena;
    const Scatter& s = *shader->bind(flat_point(), w, arena);
    test::Random random(3);
    int through = 0;
    for (int i = 0; i < 3000; ++i) {
      const Vector3 out = random.direction(), in = random.direction();
      if (std::abs(out.z) < 0.05f || std::abs(in.z) < 0.05f) continue;
      const V o = turned({double(out.x), double(out.y), double(out.z)}, 0.3),
              t = turned({double(in.x), double(in.y), double(in.z)}, 0.3);
      const Spectrum radiance = s.evaluate(out, in) / s.cosine(in),
                     importance = s.evaluate(out, in, {.transport = Transport::importance}) / s.cosine(in);
      for (int k = 0; k < spectrum_size; ++k) {
        const double above = 1, below = n(double(w[k])), no = out.z > 0 ? above : below, ni = in.z > 0 ? above : below;
        double expected = 0;
        if (out.z * in.z > 0) {
          const V m = scaled(unit(sum(o, t)), out.z > 0 ? 1 : -1);
          const V a{o.x, o.y, std::abs(o.z)}, b{t.x, t.y, std::abs(t.z)};
          const double eta = out.z > 0 ? below : 1 / below;
          expected = fresnel(std::abs(dot(o, m)), eta) * facets.D(m) / facets.hidden(a, b, apart_above) / (4 * a.z * b.z);
        } else {  // Walter et al. 2007, eq. 21, with h = -(n_o o + n_i i)
          V m = unit(scaled(sum(scaled(o, no), t, ni), -1));
          if (m.z < 0) m = scaled(m, -1);
          const double om = dot(o, m), im = dot(t, m);
          if (om * o.z > 0 && im * t.z > 0)
            expected = std::abs(om * im / (o.z * t.z)) * ni * ni * (1 - fresnel(std::abs(om), ni / no)) * facets.D(m) /
                       facets.hidden(o, t, apart_through) / pow2(no * om + ni * im);
        }
        // The formula is that of power (importance). Radiance scales by the square of the index on the side on which it leaves.
        const double tolerance = 1e-3 * expected + 2e-6;
        EXPECT_NEAR(double(importance[k]), expected, tolerance) << ggx << " " << i << " " << k;
        EXPECT_NEAR(double(radiance[k]), expected * no * no / (ni * ni), tolerance * 3) << ggx << " " << i << " " << k;
        through += out.z * in.z < 0 && expected > 0;
      }
      if (HasFailure()) return;
    }
    EXPECT_GT(through, 1000);
  }
}

// Multiple scattering at an isotropic boundary: for each angle it adds what single scattering loses, so that both together
// reflect and transmit everything, and are reciprocal between the sides.
TEST(ShaderFormulas, RoughDielectricLosesNothing) {
  for (const double alpha : {0.3, 0.8}) {
    const Ref<Shader> shader = create<Shader>("Dielectric", {{"roughness", alpha}, {"ior", flat_spectrum(1.5f)}});
    Arena arena;
    const Scatter& s = *shader->bind(flat_point(), test::wavelengths(), arena);
    for (const double angle : {15.0, 60.0, 120.0, 165.0}) {
      const double t = angle * M_PI / 180;
      const Vector3 out{float(std::sin(t)), 0, float(std::cos(t))};
      double sums[2] = {};
      constexpr int steps = 400;
      for (int i = 0; i < steps; ++i)
        for (int k = 0; k < steps; ++k) {
          const double z = -1 + 2 * (i + 0.5) / steps, phi = M_PI * (k + 0.5) / steps, r = std::sqrt(1 - z * z);
          const Vector3 in{float(r * std::cos(phi)), float(r * std::sin(phi)), float(z)};
          sums[z * double(out.z) < 0] +=
              double(s.evaluate(out, in, {.transport = Transport::importance})[0]) * 4 * M_PI / (steps * steps);
        }
      EXPECT_NEAR(sums[0] + sums[1], 1, 0.006) << alpha << " at " << angle;
      EXPECT_NEAR(double(s.albedo(out, reflection_lobes)[0]), sums[0], 0.01) << alpha << " at " << angle;
    }
  }
}

TEST(ShaderFormulas, Plastic) {
  const Slope rho{0.2, 0.85};
  for (const bool nonlinear : {true, false})
    for (const double eta : {1.3, 1.8})
      for (const double roughness : {0.0, 0.3}) {
        const Ref<Shader> shader = create<Shader>(
            "Plastic", {{"color", rho.color()}, {"ior", eta}, {"roughness", roughness}, {"distribution", "beckmann"}});
        set(*shader, "nonlinear", Value(nonlinear));
        const Facets facets{false, roughness, roughness};
        const CoatTransmittance coat({MicrofacetDistribution::beckmann, float(roughness)}, float(eta));
        const auto passed = [&](const V& v) {
          return roughness > 0 ? double(coat({float(v.x), float(v.y), float(v.z)})) : 1 - fresnel(v.z, eta);
        };
        const double mean =
            roughness > 0 ? double(coat.mean()) : diffuse_mean([&](double c) { return 1 - fresnel(c, eta); }, 20000);
        const double inside = 1 - mean / (eta * eta);
        expect_formula(
            "Plastic", shader, 0,
            [&](const V& out, const V& in, double l) {
              const double body = rho(l) / (1 - (nonlinear ? rho(l) : 1) * inside);
              double f = passed(out) * passed(in) * body / (M_PI * eta * eta);
              if (roughness > 0) f += fresnel(dot(out, unit(sum(out, in))), eta) * facets.reflection(out, in);
              return f;
            },
            5e-4);
      }
}

/// A rough coat's transmittance against one minus its reflectance, by the test's own quadrature over directions.
TEST(ShaderFormulas, RoughCoatLetsThroughWhatItDoesNotReflect) {
  for (const double alpha : {0.2, 0.6}) {
    const Facets facets{true, alpha, alpha};
    const CoatTransmittance coat({MicrofacetDistribution::ggx, float(alpha)}, 1.6f);
    for (const double angle : {0.0, 50.0, 78.0}) {
      const V out{std::sin(angle * M_PI / 180), 0, std::cos(angle * M_PI / 180)};
      double reflected = 0;
      constexpr int steps = 500;
      for (int i = 0; i < steps; ++i)
        for (int k = 0; k < steps; ++k) {
          const double z = (i + 0.5) / steps, phi = M_PI * (k + 0.5) / steps, r = std::sqrt(1 - z * z);
          const V in{r * std::cos(phi), r * std::sin(phi), z};
          reflected += fresnel(dot(out, unit(sum(out, in))), 1.6) * facets.reflection(out, in) * z * 2 * M_PI / (steps * steps);
        }
      EXPECT_NEAR(1 - double(coat({float(out.x), 0, float(out.z)})), reflected, 0.0035) << alpha << " at " << angle;
    }
  }
}

}  // namespace
}  // namespace etendue::formulas_test
