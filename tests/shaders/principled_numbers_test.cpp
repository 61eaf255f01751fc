// Principled, layer by layer, against the equations of OpenPBR Surface 1.1 written out here: roughening, anisotropy, tints,
// darkening, thin walls. Other tests check the whole by its energy; this one checks the numbers.

#include "components/shaders/microfacet/microfacet.h"
#include "etendue/describe/color.h"
#include "etendue/object_map.h"
#include "support/component_test_support.h"

namespace etendue {
namespace {

using test::create;
using test::Setting;
using Settings = std::vector<Setting>;

double pow2(double x) { return x * x; }
double pow5(double x) { return x * x * x * x * x; }

Ref<Shader> principled(const Settings& settings, bool thin = false) {
  const Ref<Shader> shader = create<Shader>("Principled", settings);
  set(*shader, "thin_walled", Value(thin));
  shader->prepare();
  return shader;
}

SurfacePoint flat_point() {
  SurfacePoint p = test::surface_point({0, 0, 1});
  p.dpdu = {1, 0, 0};
  return p;
}
Vector3 direction(double degrees, double azimuth) {
  const double t = degrees * M_PI / 180;
  return {float(std::sin(t) * std::cos(azimuth)), float(std::sin(t) * std::sin(azimuth)), float(std::cos(t))};
}

double fresnel(double c, double eta) {
  const double b2 = 1 - (1 - c * c) / (eta * eta);
  if (b2 <= 0) return 1;
  const double b = std::sqrt(b2);
  return (pow2((c - eta * b) / (c + eta * b)) + pow2((eta * c - b) / (eta * c + b))) / 2;
}

/// GGX's reflection without F: D G2 / (4 cos cos).
double ggx(double ax, double ay, const Vector3& out, const Vector3& in) {
  const Vector3 m = normalize(out + in);
  const auto lambda = [&](const Vector3& v) {
    return (std::sqrt(1 + (pow2(ax * double(v.x)) + pow2(ay * double(v.y))) / pow2(double(v.z))) - 1) / 2;
  };
  const double D = 1 / (M_PI * ax * ay * pow2(pow2(double(m.x) / ax) + pow2(double(m.y) / ay) + pow2(double(m.z))));
  return D / (1 + lambda(out) + lambda(in)) / (4 * double(out.z) * double(in.z));
}

/// The multiple scattering of metal microfacets (Kulla & Conty 2017) with the mean reflectance of a flat colour without tint.
double more(double ax, double ay, double color, const Vector3& out, const Vector3& in) {
  const MultipleReflection m({MicrofacetDistribution::ggx, float(ax), float(ay)});
  const double mean = color + (1 - color) / 21, lost = double(m.mean_missing());
  return mean * mean * (1 - lost) / (1 - mean * lost) * double(m.missing(out)) * double(m.missing(in)) / (M_PI * lost);
}

double value(const Ref<Shader>& shader, const Vector3& out, const Vector3& in, Lobes lobes = smooth_lobes) {
  Arena arena;
  return double(shader->bind(flat_point(), test::wavelengths(), arena)->evaluate(out, in, {.lobes = lobes})[0]) /
         std::abs(double(in.z));
}

struct Pair {
  Vector3 out, in;
};
const std::vector<Pair> pairs = {{direction(20, 0.3), direction(35, 3.3)},
                                 {direction(60, 1.2), direction(55, 4.1)},
                                 {direction(5, 0), direction(70, 2)},
                                 {direction(75, 5), direction(40, 2.4)}};

double schlick(double color, const Vector3& out, const Vector3& in) {
  return color + (1 - color) * pow5(1 - double(dot(out, normalize(out + in))));
}

// Section "Microfacet model": alpha_t = r^2 sqrt(2 / (1 + (1 - a)^2)), alpha_b = (1 - a) alpha_t.
TEST(PrincipledNumbers, AnisotropyKeepsTheMeanSquareOfAlphas) {
  for (const auto& [roughness, anisotropy] : {std::pair{0.5, 0.0}, {0.6, 0.5}, {0.7, 0.8}}) {
    const double along = pow2(roughness) * std::sqrt(2 / (1 + pow2(1 - anisotropy))), across = (1 - anisotropy) * along;
    EXPECT_NEAR(along * along + across * across, 2 * pow2(pow2(roughness)), 1e-12);
    const Ref<Shader> metal = principled({{"base_metalness", 1.0},
                                          {"base_color", 0.7},
                                          {"specular_roughness", roughness},
                                          {"specular_roughness_anisotropy", anisotropy}});
    for (const Pair& p : pairs) {
      const double expected =
          schlick(0.7, p.out, p.in) * ggx(along, across, p.out, p.in) + more(along, across, 0.7, p.out, p.in);
      EXPECT_NEAR(value(metal, p.out, p.in), expected, 2e-3 * expected) << roughness << " " << anisotropy;
    }
  }
}

// Section "Roughening": r' = (r^4 + 2 r_coat^4)^(1/4), mixed by the coat's weight. A coat of index 1 only roughens and tints.
// Section "Coat": light passes it twice, coat_color^((1 / cos + 1 / cos') / 2) with the angles inside.
TEST(PrincipledNumbers, CoatsRoughenAndTint) {
  for (const double weight : {1.0, 0.4}) {
    const double base = 0.4, coat = 0.5, tint = 0.3;
    const double roughness = (1 - weight) * base + weight * std::pow(std::pow(base, 4) + 2 * std::pow(coat, 4), 0.25);
    const Ref<Shader> metal = principled({{"base_metalness", 1.0},
                                          {"base_color", 0.7},
                                          {"specular_roughness", base},
                                          {"coat_weight", weight},
                                          {"coat_roughness", coat},
                                          {"coat_ior", 1.0},
                                          {"coat_darkening", 0.0},
                                          {"coat_color", tint}});
    for (const Pair& p : pairs) {
      const double a = roughness * roughness;
      const double absorbed = 1 - weight + weight * std::pow(tint, (1 / double(p.out.z) + 1 / double(p.in.z)) / 2);
      const double expected = (schlick(0.7, p.out, p.in) * ggx(a, a, p.out, p.in) + more(a, a, 0.7, p.out, p.in)) * absorbed;
      EXPECT_NEAR(value(metal, p.out, p.in), expected, 4e-3 * expected) << weight;
    }
  }
  // With an index above 1 the angles inside are steeper: through a polished coat, the ratio of tinted to untinted light.
  const auto seen = [](double tint, const Pair& p) {
    return value(principled({{"base_metalness", 1.0},
                             {"specular_roughness", 0.5},
                             {"coat_weight", 1.0},
                             {"coat_ior", 1.6},
                             {"coat_darkening", 0.0},
                             {"coat_color", tint}}),
                 p.out, p.in);
  };
  for (const Pair& p : pairs) {
    const auto slant = [](const Vector3& v) { return 1 / std::sqrt(1 - (1 - pow2(double(v.z))) / pow2(1.6)); };
    const double expected = std::pow(0.2, (slant(p.out) + slant(p.in)) / 2);
    EXPECT_NEAR(seen(0.2, p) / seen(1.0, p), expected, 2e-3 * expected);
  }
}

// Section "Darkening": Delta = (1 - K) / (1 - E_b K), mixed by amount and weight. For a diffuse body under a coat, K is the
// coat's internal reflectance of diffuse light, 1 - (1 - F) / eta^2 with the mean F from outside, and E_b is the albedo of the
// base with its surface.
TEST(PrincipledNumbers, CoatsDarkenMattBodies) {
  const auto diffuse = [](double color, double amount, double weight) {
    return value(principled({{"base_color", color},
                             {"specular_roughness", 0.3},
                             {"coat_weight", weight},
                             {"coat_ior", 1.6},
                             {"coat_darkening", amount}}),
                 direction(20, 0), direction(50, 1), diffuse_lobes);
  };
  double outside = 0;
  for (int i = 0; i < 20000; ++i) outside += 2 * (i + 0.5) / 2e4 / 2e4 * fresnel((i + 0.5) / 2e4, 1.6);
  const double K = 1 - (1 - outside) / pow2(1.6);
  for (const double color : {0.2, 0.8}) {
    // The base's index 1.5 is relative to the coat's: its reflectance is that of 1.6 / 1.5.
    const double gloss = pow2((1.6 / 1.5 - 1) / (1.6 / 1.5 + 1)), E = gloss + color * (1 - gloss);
    for (const auto& [amount, weight] : {std::pair{1.0, 1.0}, {0.5, 1.0}}) {
      const double expected = 1 - amount + amount * (1 - K) / (1 - E * K);
      EXPECT_NEAR(diffuse(color, amount, weight) / diffuse(color, 0, weight), expected, 2e-3 * expected)
          << color << " " << amount;
    }
    // At a weight of 0.5 only half of the surface is darkened.
    const double half_gloss = [&] {  // the ratio of indices is mixed as well
      const double ratio = 0.5 * 1.5 + 0.5 * 1.5 / 1.6;
      return pow2((ratio - 1) / (ratio + 1));
    }();
    const double half_E = half_gloss + color * (1 - half_gloss);
    const double half = 0.5 + 0.5 * (1 - K) / (1 - half_E * K);
    EXPECT_NEAR(diffuse(color, 1, 0.5) / diffuse(color, 0, 0.5), half, 3e-3 * half) << color;
  }
}

// Metal: F82-tint. At the cosine 1/7 the reflectance is Schlick's times the tint; along the normal it is the colour.
TEST(PrincipledNumbers, MetalsEdge) {
  const Ref<Shader> metal = principled({{"base_metalness", 1.0},
                                        {"base_color", 0.6},
                                        {"specular_color", 0.4},
                                        {"specular_roughness", 0.0},
                                        {"specular_weight", 0.9}});
  Arena arena;
  const Scatter& s = *metal->bind(flat_point(), test::wavelengths(), arena);
  const double at82 = 0.6 + 0.4 * pow5(6 / 7.0), b = at82 * 0.6 / (1 / 7.0 * std::pow(6 / 7.0, 6));
  for (const double c : {1.0, 0.8, 0.4, 1 / 7.0, 0.05}) {
    const double t = std::acos(c) * 180 / M_PI;
    const auto sample = s.sample(direction(t, 1), 0.5f, {});
    ASSERT_TRUE(sample);
    const double expected = 0.9 * (0.6 + 0.4 * pow5(1 - c) - b * c * std::pow(1 - c, 6));
    EXPECT_NEAR(double(sample->weight[0]), expected, 1e-4) << c;
    if (c == 1 / 7.0) EXPECT_NEAR(expected, 0.9 * 0.4 * at82, 1e-9);
  }
}

// Section "Modulated IOR": eta' = (1 + e) / (1 - e), e^2 = weight ((eta - 1) / (eta + 1))^2.
TEST(PrincipledNumbers, SpecularWeightScalesTheReflectance) {
  for (const double weight : {0.25, 0.6, 2.0}) {
    const Ref<Shader> glossy =
        principled({{"base_weight", 0.0}, {"specular_ior", 1.5}, {"specular_roughness", 0.0}, {"specular_weight", weight}});
    Arena arena;
    const Scatter& s = *glossy->bind(flat_point(), test::wavelengths(), arena);
    const double e = std::sqrt(weight) * 0.2, eta = (1 + e) / (1 - e);
    for (const double angle : {0.0, 55.0, 80.0}) {
      const auto sample = s.sample(direction(angle, 1), 0, {}, {.lobes = specular_reflection});
      ASSERT_TRUE(sample);
      EXPECT_NEAR(double(sample->weight[0]), fresnel(std::cos(angle * M_PI / 180), eta), 2e-4) << weight << " " << angle;
    }
  }
}

// A thin pane: both faces and the reflections between them, with transmission_color^(1 / cos inside) on each passage.
TEST(PrincipledNumbers, ThinWallsArePanes) {
  const Ref<Shader> pane = principled(
      {{"transmission_weight", 1.0}, {"transmission_color", 0.5}, {"specular_roughness", 0.0}, {"specular_ior", 1.6}}, true);
  Arena arena;
  const Scatter& s = *pane->bind(flat_point(), test::wavelengths(), arena);
  for (const double angle : {0.0, 50.0, 78.0}) {
    const double c = std::cos(angle * M_PI / 180), inside = std::sqrt(1 - (1 - c * c) / pow2(1.6));
    const double R = fresnel(c, 1.6), a = std::pow(0.5, 1 / inside);
    const double through = pow2(1 - R) * a / (1 - pow2(R * a)), back = R + pow2(1 - R) * R * a * a / (1 - pow2(R * a));
    const auto t = s.sample(direction(angle, 1), 0.999f, {}, {.lobes = specular_transmission}),
               r = s.sample(direction(angle, 1), 0, {}, {.lobes = specular_reflection});
    ASSERT_TRUE(t && r);
    EXPECT_NEAR(double(t->weight[0]), through, 2e-4) << angle;
    EXPECT_NEAR(double(r->weight[0]), back, 2e-4) << angle;
    EXPECT_LT(length(t->direction + direction(angle, 1)), 1e-5f);
  }
}

// A leaf: (1 - g) / 2 of subsurface_color is scattered to its own side and (1 + g) / 2 to the other.
TEST(PrincipledNumbers, ThinWallsScatterToBothSides) {
  const Vector3 out = direction(30, 0.5), in = direction(50, 2), beyond{in.x, in.y, -in.z};
  const auto leaf = [&](double g, double weight) {
    return principled({{"base_color", 0.6},
                       {"subsurface_weight", weight},
                       {"subsurface_color", 0.8},
                       {"subsurface_scatter_anisotropy", g},
                       {"specular_weight", 0.0}},
                      true);
  };
  for (const double g : {-0.4, 0.0, 0.7})
    for (const double weight : {1.0, 0.3}) {
      const Ref<Shader> shader = leaf(g, weight);
      EXPECT_NEAR(value(shader, out, in, diffuse_lobes) * M_PI, (1 - weight) * 0.6 + weight * 0.8 * (1 - g) / 2, 2e-3);
      EXPECT_NEAR(value(shader, out, beyond, diffuse_lobes) * M_PI, weight * 0.8 * (1 + g) / 2, 2e-3);
    }
}

// Cauchy's law through n at 587.6 nm with Abbe's number from 486.1 and 656.3 nm: the index by which the glass refracts.
TEST(PrincipledNumbers, DispersionIsThatOfTheAbbeNumber) {
  const Ref<Shader> glass = principled({{"transmission_weight", 1.0},
                                        {"specular_roughness", 0.0},
                                        {"specular_ior", 1.6},
                                        {"transmission_dispersion_scale", 0.5},
                                        {"transmission_dispersion_abbe_number", 10.0}});
  const auto index = [&](double l) {
    Wavelengths w;
    for (int i = 0; i < spectrum_size; ++i) w.place(i, float(l), 1);
    return double(glass->interior_index(w)[0]);
  };
  EXPECT_NEAR(index(587.6), 1.6, 1e-5);
  EXPECT_NEAR(0.6 / (index(486.1) - index(656.3)), 10 / 0.5, 2e-3);
  EXPECT_NEAR((index(420) - index(587.6)) / (index(486.1) - index(656.3)),
              (1 / pow2(420.0) - 1 / pow2(587.6)) / (1 / pow2(486.1) - 1 / pow2(656.3)), 1e-4);
}

}  // namespace
}  // namespace etendue
