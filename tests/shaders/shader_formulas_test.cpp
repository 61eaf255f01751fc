// Diffuse, classic and mixed models against their papers' formulas, computed here in double precision, and in another form if
// there is one, at random pairs of directions, with all members away from their defaults: colours that differ between
// wavelengths, tangents that are rotated, both sides of the surface.

#include "etendue/object_map.h"
#include "support/shader_formulas_support.h"

namespace etendue::formulas_test {
namespace {

// ---- matt ------------------------------------------------------------------------------------------------------------------

// Portsmouth, Kutz & Hill 2025. Its albedo E is found by quadrature of the single-scattering part.
TEST(ShaderFormulas, OrenNayar) {
  const Slope rho{0.3, 0.95};
  for (const double r : {0.35, 1.0}) {
    const double A = 1 / (1 + (0.5 - 2 / (3 * M_PI)) * r);
    const auto once = [&](const V& out, const V& in) {
      const double s = out.x * in.x + out.y * in.y;
      return A / M_PI * (1 + r * (s > 0 ? s / std::max(out.z, in.z) : s));
    };
    std::vector<double> table(401);
    for (size_t i = 0; i < table.size(); ++i) {
      const double c = std::max(pow2(double(i) / double(table.size() - 1)), 1e-6);  // finer near the horizon
      const V out{std::sqrt(1 - c * c), 0, c};
      constexpr int steps = 160;
      for (int a = 0; a < steps; ++a)
        for (int b = 0; b < steps; ++b) {
          const double theta = M_PI / 2 * (a + 0.5) / steps, z = std::cos(theta), q = std::sin(theta);
          const double phi = M_PI * (b + 0.5) / steps, weight = 2 * z * q * (M_PI / 2 / steps) * M_PI / steps;
          table[i] += once(out, {q * std::cos(phi), q * std::sin(phi), z}) * weight;
        }
    }
    const auto E = [&](double c) {
      const double x = std::sqrt(c) * double(table.size() - 1);
      const size_t i = std::min(size_t(x), table.size() - 2);
      return std::lerp(table[i], table[i + 1], x - double(i));
    };
    const double Em = diffuse_mean(E);
    expect_formula(
        "EON", create<Shader>("OrenNayar", {{"color", rho.color()}, {"roughness", r}}), 0,
        [&](const V& out, const V& in, double l) {
          const double more = rho(l) * rho(l) * Em / (1 - rho(l) * (1 - Em));
          return rho(l) * once(out, in) + more / M_PI * (1 - E(out.z)) * (1 - E(in.z)) / (1 - Em);
        },
        1.5e-3);
  }
}

TEST(ShaderFormulas, LambertianAndTransmitter) {
  const Slope back{0.5, 0.1}, through{0.1, 0.45};
  expect_formula("Lambertian", create<Shader>("Lambertian", {{"color", back.color()}}), 0,
                 [&](const V&, const V&, double l) { return back(l) / M_PI; });
  const Ref<Shader> sheet =
      create<Shader>("DiffuseTransmitter", {{"reflectance", back.color()}, {"transmittance", through.color()}});
  expect_formula("sheet", sheet, 0, [&](const V&, const V&, double l) { return back(l) / M_PI; });
  const Wavelengths w = test::wavelengths(430);
  Arena arena;
  const Scatter& s = *sheet->bind(flat_point(), w, arena);
  test::Random random(4);
  for (int i = 0; i < 200; ++i) {
    const Vector3 out = random.direction(), in = random.direction();
    const bool crosses = out.z * in.z < 0;
    const Spectrum f = s.evaluate(out, in) / s.cosine(in);
    for (int k = 0; k < spectrum_size; ++k)
      EXPECT_NEAR(double(f[k]) * M_PI, crosses ? through(double(w[k])) : back(double(w[k])), 1e-5);
    double r = 0, t = 0;
    for (int k = 0; k < spectrum_size; ++k) r += back(double(w[k])), t += through(double(w[k]));
    EXPECT_NEAR(double(s.pdf(out, in)), std::abs(double(in.z)) / M_PI * (crosses ? t : r) / (r + t), 1e-5);
    const auto sample = s.sample(out, random(), random.pair());
    ASSERT_TRUE(sample);
    const bool sample_crosses = sample->direction.z * out.z < 0;
    EXPECT_NEAR(double(sample->pdf), std::abs(double(sample->direction.z)) / M_PI * (sample_crosses ? t : r) / (r + t), 1e-5);
    EXPECT_NEAR(double(sample->weight[0]), (sample_crosses ? through(double(w[0])) / t : back(double(w[0])) / r) * (r + t),
                1e-4);
  }
}

// ---- classic models ---------------------------------------------------------------------------------------------------------

TEST(ShaderFormulas, Ward) {
  const Slope kd{0.3, 0.1}, ks{0.2, 0.6};
  const double ax = 0.35, ay = 0.15;
  expect_formula(
      "Ward",
      create<Shader>(
          "WardShader",
          {{"color", kd.color()}, {"specular", ks.color()}, {"roughness_u", ax}, {"roughness_v", ay}, {"rotation", 0.15}}),
      0.15, [&](const V& out, const V& in, double l) {
        const V H = sum(out, in);
        return kd(l) / M_PI + ks(l) * std::exp(-(pow2(H.x / ax) + pow2(H.y / ay)) / pow2(H.z)) * dot(H, H) /
                                  (M_PI * ax * ay * pow2(pow2(H.z)));
      });
}

TEST(ShaderFormulas, AshikhminShirley) {
  const Slope rd{0.7, 0.4}, rs{0.05, 0.3};
  const double nu = 30, nv = 8;
  expect_formula(
      "Ashikhmin & Shirley",
      create<Shader>(
          "AshikhminShirley",
          {{"color", rd.color()}, {"specular", rs.color()}, {"exponent_u", nu}, {"exponent_v", nv}, {"rotation", -0.2}}),
      -0.2, [&](const V& out, const V& in, double l) {
        const V h = unit(sum(out, in));
        const double u = dot(out, h), phi = std::atan2(h.y, h.x);
        const double n = nu * pow2(std::cos(phi)) + nv * pow2(std::sin(phi));
        const double F = rs(l) + (1 - rs(l)) * pow5(1 - u);
        return std::sqrt((nu + 1) * (nv + 1)) / (8 * M_PI) * std::pow(h.z, n) * F / (u * std::max(out.z, in.z)) +
               28 * rd(l) / (23 * M_PI) * (1 - rs(l)) * (1 - pow5(1 - out.z / 2)) * (1 - pow5(1 - in.z / 2));
      });
}

TEST(ShaderFormulas, Phong) {
  const Slope kd{0.3, 0.5}, ks{0.6, 0.1};
  expect_formula("Phong", create<Shader>("PhongShader", {{"color", kd.color()}, {"specular", ks.color()}, {"exponent", 17.0}}),
                 0, [&](const V& out, const V& in, double l) {
                   const double alpha = -out.x * in.x - out.y * in.y + out.z * in.z;
                   return kd(l) / M_PI + ks(l) * 19 / (2 * M_PI) * std::pow(std::max(alpha, 0.0), 17);
                 });
}

TEST(ShaderFormulas, Lafortune) {
  const Slope kd{0.2, 0.1}, first{0.5, 0.3}, second{0.1, 0.25};
  const Ref<Shader> shader =
      create<Shader>("LafortuneShader", {{"color", kd.color()},
                                         {"coefficients", std::vector<double>{-0.9, -0.7, 0.8, 0.5, 0.6, 0.6}},
                                         {"exponents", std::vector<double>{9, 3}},
                                         {"rotation", 0.2}});
  Value::List colors;
  for (const Slope* s : {&first, &second}) {
    const Ref<ObjectMap> map = create<ObjectMap>("ConstantMap", {{"value", s->color()}});
    colors.emplace_back(Ref<Component>(map));
  }
  set(*shader, "lobe_colors", Value(colors));
  shader->prepare();
  expect_formula("Lafortune", shader, 0.2, [&](const V& out, const V& in, double l) {
    const auto lobe = [&](double x, double y, double z, double n) {
      return std::pow(std::max(x * out.x * in.x + y * out.y * in.y + z * out.z * in.z, 0.0), n);
    };
    return kd(l) / M_PI + first(l) * lobe(-0.9, -0.7, 0.8, 9) + second(l) * lobe(0.5, 0.6, 0.6, 3);
  });
  // If base and lobes together would reflect more than arrives, all are scaled down by the same factor: the base keeps its
  // share.
  const Ref<Shader> strong =
      create<Shader>("LafortuneShader",
                     {{"color", 0.6}, {"coefficients", std::vector<double>{-1, -1, 1}}, {"exponents", std::vector<double>{4}}});
  Arena arena;
  const Scatter& s = *strong->bind(flat_point(), test::wavelengths(), arena);
  const Vector3 up{0, 0, 1};
  const double lobe = 2 * M_PI / 6;  // of f = cos^4 at normal incidence, where it is greatest
  EXPECT_NEAR(double(s.albedo(up, diffuse_lobes)[0]), 0.6 / (0.6 + lobe), 2e-3);
  EXPECT_NEAR(double(s.evaluate(up, up)[0]), (0.6 / M_PI + 1) / (0.6 + lobe), 2e-3);
}

// Shirley, Hu, Smits & Lafortune 1997.
TEST(ShaderFormulas, CoupledMatteSpecular) {
  const Slope rm{0.9, 0.5}, r0{0.05, 0.2};
  const Ref<Shader> shader = create<Shader>("CoupledMatteSpecular", {{"color", rm.color()}, {"specular", r0.color()}});
  const auto R = [&](double c, double l) { return r0(l) + (1 - r0(l)) * pow5(1 - c); };
  expect_formula("coupled", shader, 0, [&](const V& out, const V& in, double l) {
    return 21 / (20 * M_PI * (1 - r0(l))) * rm(l) * (1 - R(out.z, l)) * (1 - R(in.z, l));
  });
  const Wavelengths w = test::wavelengths(430);
  Arena arena;
  const Scatter& s = *shader->bind(flat_point(), w, arena);
  for (const double c : {1.0, 0.6, 0.15}) {
    const Vector3 out{0, float(-std::sqrt(1 - c * c)), float(c)};
    const auto mirrored = s.sample(out, 0, {}, {.lobes = specular_reflection});
    ASSERT_TRUE(mirrored);
    for (int k = 0; k < spectrum_size; ++k) {
      EXPECT_NEAR(double(mirrored->weight[k]), R(c, double(w[k])), 1e-5);
      EXPECT_NEAR(double(s.albedo(out, diffuse_lobes)[k]), rm(double(w[k])) * (1 - R(c, double(w[k]))), 1e-5);
    }
    // With both lobes requested: samples of the base have the weight value times cosine over pdf.
    test::Random random(8);
    for (int i = 0; i < 40; ++i) {
      const auto sample = s.sample(out, random(), random.pair());
      ASSERT_TRUE(sample);
      if (sample->specular()) continue;
      const ScatterValue v = s.value_and_pdf(out, sample->direction);
      for (int k = 0; k < spectrum_size; ++k) EXPECT_NEAR(sample->weight[k], v.value[k] / v.pdf, 1e-4f * sample->weight[k]);
    }
  }
}

TEST(ShaderFormulas, Schlick) {
  const Slope top{0.05, 0.4}, base{0.9, 0.3};
  const double r = 0.3, p = 0.4, q = 0.7;  // the base layer: between specular and diffuse, isotropic
  const Ref<Shader> shader = create<Shader>("SchlickShader", {{"color", top.color()},
                                                              {"roughness", r},
                                                              {"isotropy", p},
                                                              {"base_color", base.color()},
                                                              {"base_roughness", q},
                                                              {"rotation", 0.05}});
  // Parameters for which the bound on the base's albedo has no effect: r is above 1/4 and q as well, so that D is the paper's
  // own.
  const auto S = [](double c, double u) { return c + (1 - c) * pow5(1 - u); };
  const auto D = [](double rough, double iso, const V& out, const V& in) {
    const V h = unit(sum(out, in));
    const auto G = [&](double v) { return v / (rough - rough * v + v); };
    const double w2 = pow2(h.x) / (pow2(h.x) + pow2(h.y));
    // The azimuth is measured so that scratches along x spread light across x.
    const double A = std::sqrt(iso / (iso * iso * (1 - w2) + w2));
    return G(out.z) * G(in.z) * rough / pow2(1 + rough * h.z * h.z - h.z * h.z) * A / (4 * M_PI * out.z * in.z);
  };
  const auto T = [](double c, double v) {
    const double m = (std::sqrt(1 + v) - std::sqrt(1 - v)) / 2;
    return (1 - c) * (1 - pow5(1 - m));
  };
  const auto bound = [&](double v) {  // of the top layer's lobe (see the shader), by the mean over azimuths
    double mean = 0;
    constexpr int steps = 4000;
    for (int i = 0; i < steps; ++i) {
      const double w2 = pow2(std::cos(2 * M_PI * (i + 0.5) / steps));
      mean += std::sqrt(p / (p * p * (1 - w2) + w2)) / steps;
    }
    const double s = std::sqrt(1 - v * v), x = std::sqrt(r) * s;
    const double isotropic = 0.5 * (v + std::sqrt(r + (1 - r) * v * v)) / std::sqrt(p);
    return std::min(isotropic, mean * (v + 0.5 * x * std::atan2(x, v))) / (v * (1 - r) + r);
  };
  expect_formula(
      "Schlick", shader, 0.05,
      [&](const V& out, const V& in, double l) {
        const double u = dot(out, unit(sum(out, in)));
        const double g = 4 * r * (1 - r), h = 4 * q * (1 - q);
        const double excess = std::max({1.0, bound(out.z), bound(in.z)});
        return S(top(l), u) * g * D(r, p, out, in) / excess +
               std::min(T(top(l), out.z), T(top(l), in.z)) * S(base(l), u) * ((1 - h) / M_PI + h * D(q, 1, out, in));
      },
      1e-3);
}

// Estevez & Kulla 2017, with the paper's table of fitted coefficients at r = 0 and 1. The base is black.
TEST(ShaderFormulas, Sheen) {
  const Slope color{0.9, 0.5};
  constexpr double at1[] = {21.5473, 3.82987, 0.19823, -1.97760, -4.32054},
                   at0[] = {25.3245, 3.32435, 0.16801, -1.27393, -4.85967};
  for (const double r : {0.2, 0.6, 1.0}) {
    const auto lambda = [&](double c) {
      double k[5];
      for (int i = 0; i < 5; ++i) k[i] = (1 - r) * (1 - r) * at0[i] + (1 - (1 - r) * (1 - r)) * at1[i];
      const auto L = [&](double x) { return k[0] / (1 + k[1] * std::pow(x, k[2])) + k[3] * x + k[4]; };
      return std::exp(c < 0.5 ? L(c) : 2 * L(0.5) - L(1 - c));
    };
    const Ref<Shader> black = create<Shader>("Lambertian", {{"color", 1e-7}});
    expect_formula(
        "sheen", create<Shader>("SheenShader", {{"base", black}, {"color", color.color()}, {"roughness", r}}), 0,
        [&](const V& out, const V& in, double l) {
          const V h = unit(sum(out, in));
          const double sine = std::sqrt(std::max(1 - h.z * h.z, 0.0));
          return color(l) * (2 + 1 / r) * std::pow(sine, 1 / r) / (2 * M_PI) /
                 ((1 + lambda(out.z) + lambda(in.z)) * 4 * out.z * in.z);
        },
        2e-3);
  }
}

// ---- mixtures ---------------------------------------------------------------------------------------------------------------

TEST(ShaderFormulas, Mixtures) {
  const Slope kd{0.3, 0.5}, other{0.8, 0.2};
  const Ref<Shader> first = create<Shader>("PhongShader", {{"color", 0.0}, {"specular", kd.color()}, {"exponent", 6.0}}),
                    second = create<Shader>("Lambertian", {{"color", other.color()}});
  const auto phong = [&](const V& out, const V& in, double l) {
    return kd(l) * 8 / (2 * M_PI) * std::pow(std::max(-out.x * in.x - out.y * in.y + out.z * in.z, 0.0), 6);
  };
  expect_formula("mix", create<Shader>("MixShader", {{"first", first}, {"second", second}, {"amount", 0.3}}), 0,
                 [&](const V& out, const V& in, double l) { return 0.7 * phong(out, in, l) + 0.3 * other(l) / M_PI; });
  expect_formula("mask", create<Shader>("MaskShader", {{"shader", first}, {"opacity", 0.35}}), 0,
                 [&](const V& out, const V& in, double l) { return 0.35 * phong(out, in, l); });
}

}  // namespace
}  // namespace etendue::formulas_test
