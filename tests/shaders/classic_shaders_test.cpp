// The classic reflection models: values of the papers' formulas, energy, samples against their pdf, reciprocity.

#include "components/shaders/tangent_frame.h"
#include "etendue/object_map.h"
#include "support/component_test_support.h"
#include "support/shader_formulas_support.h"

namespace etendue {
namespace {

using formulas_test::flat_point;
using test::create;

/// A direction by its angle from z and its azimuth from x, both in degrees.
Vector3 direction(double angle, double azimuth) {
  const double t = angle * M_PI / 180, p = azimuth * M_PI / 180;
  return {float(std::sin(t) * std::cos(p)), float(std::sin(t) * std::sin(p)), float(std::cos(t))};
}
Vector3 mirrored(const Vector3& v) { return {v.x, v.y, -v.z}; }

class Bound {
 public:
  explicit Bound(const Ref<Shader>& shader) : scatter_(shader->bind(flat_point(), test::wavelengths(), arena_)) {
    if (!scatter_) throw std::logic_error("the shader is black");
  }
  const Scatter* operator->() const { return scatter_; }
  double value(const Vector3& out, const Vector3& in, Lobes lobes = all_lobes) const {
    return double(scatter_->evaluate(out, in, {.lobes = lobes})[0]) / std::max(double(scatter_->cosine(in)), 1e-30);
  }
  /// The mean weight of stratified samples: the radiance towards `out` in a uniform environment of radiance 1.
  double albedo(const Vector3& out, Lobes lobes = all_lobes, int steps = 48) const {
    double sum = 0;
    test::Random random(1);
    for (int i = 0; i < steps; ++i)
      for (int k = 0; k < steps; ++k) {
        const float choice = (float((i * 29 + k * 13) % steps) + random()) / float(steps);
        const Point2 u{(float(i) + random()) / float(steps), (float(k) + random()) / float(steps)};
        if (const auto s = scatter_->sample(out, std::min(choice, one_minus_epsilon), u, {.lobes = lobes}))
          sum += double(s->weight[0]);
      }
    return sum / (steps * steps);
  }

 private:
  Arena arena_;
  const Scatter* scatter_;
};

struct Case {
  std::string name;
  Ref<Shader> shader;
};
const std::vector<Case>& cases() {
  static const std::vector<Case> made = {
      {"EON 0", create<Shader>("OrenNayar", {{"roughness", 0.0}})},
      {"EON 0.4", create<Shader>("OrenNayar", {{"roughness", 0.4}, {"color", 0.8}})},
      {"EON 1", create<Shader>("OrenNayar", {{"roughness", 1.0}, {"color", 1.0}})},
      {"Ward", create<Shader>("WardShader", {{"roughness_u", 0.2}, {"roughness_v", 0.5}})},
      {"Ward, lobe only",
       create<Shader>("WardShader", {{"roughness_u", 1.0}, {"roughness_v", 0.3}, {"color", 0.0}, {"specular", 1.0}})},
      {"Ashikhmin-Shirley", create<Shader>("AshikhminShirley")},
      {"Ashikhmin-Shirley, white",
       create<Shader>("AshikhminShirley", {{"exponent_u", 0.0}, {"exponent_v", 3.0}, {"color", 1.0}, {"specular", 0.3}})},
      {"Schlick 0.3", create<Shader>("SchlickShader")},
      {"Schlick 0.7, white", create<Shader>("SchlickShader", {{"roughness", 0.7}, {"color", 1.0}})},
      {"Schlick 0.3, scratched, white",
       create<Shader>("SchlickShader", {{"roughness", 0.3}, {"isotropy", 0.2}, {"color", 1.0}})},
      {"Schlick, two layers, white",
       create<Shader>("SchlickShader",
                      {{"roughness", 0.2}, {"isotropy", 0.5}, {"color", 0.05}, {"base_color", 1.0}, {"base_roughness", 0.8}})},
      {"Lafortune", create<Shader>("LafortuneShader")},
      {"Lafortune, three lobes",
       create<Shader>("LafortuneShader", {{"coefficients", std::vector<double>{-1, -0.9, 0.8, 0.7, 0.7, 0.7, -0.5, -0.5, 0.9}},
                                          {"exponents", std::vector<double>{12, 4, 0.5}}})},
      {"coupled", create<Shader>("CoupledMatteSpecular", {{"color", 1.0}, {"specular", 0.2}})},
      {"transmitter", create<Shader>("DiffuseTransmitter", {{"reflectance", 0.9}, {"transmittance", 0.6}})}};
  return made;
}

// ---- values -------------------------------------------------------------------------------------------------------

// f [1/sr] for four pairs of directions (angle and azimuth of each, in degrees), computed in double precision from the
// papers' angular forms with integrals (EON's albedos, Schlick's bounds, the elliptic integral) by quadrature.
TEST(ClassicShaders, ValuesOfThePapers) {
  constexpr double pairs[4][4] = {{40, 20, 60, 230}, {70, 100, 30, 70}, {80, 10, 78, 185}, {0, 0, 50, 300}};
  const struct {
    std::string name;
    Ref<Shader> shader;
    Lobes lobes;
    double expected[4];
  } table[] = {
      {"EON",
       create<Shader>("OrenNayar", {{"roughness", 0.7}, {"color", 0.8}}),
       all_lobes,
       {0.1637851694, 0.2989708606, 0.0718012142, 0.2456364404}},
      {"Ward",
       create<Shader>("WardShader", {{"roughness_u", 0.2}, {"roughness_v", 0.5}, {"specular", 1.0}, {"color", 0.0}}),
       all_lobes,
       {1.3193166096, 0.0244900453, 18.7011069075, 0.1921406753}},
      {"Ashikhmin-Shirley, lobe",
       create<Shader>("AshikhminShirley", {{"exponent_u", 10.0}, {"exponent_v", 80.0}, {"color", 0.6}, {"specular", 0.1}}),
       glossy_lobes,
       {0.00231994031, 2.80782701e-16, 1.6395217895, 0.0002800163994}},
      {"Ashikhmin-Shirley, base",
       create<Shader>("AshikhminShirley", {{"exponent_u", 10.0}, {"exponent_v", 80.0}, {"color", 0.6}, {"specular", 0.1}}),
       diffuse_lobes,
       {0.1453288426, 0.1198675018, 0.0322601423, 0.1735423751}},
      {"Schlick 0.4",
       create<Shader>("SchlickShader", {{"roughness", 0.4}, {"color", 1.0}}),
       all_lobes,
       {0.2335886254, 0.0994740516, 0.6277748769, 0.1512110118}},
      {"Schlick 0.1, bounded",
       create<Shader>("SchlickShader", {{"roughness", 0.1}, {"color", 1.0}}),
       all_lobes,
       {0.1659529670, 0.0211606677, 1.8303503937, 0.0621016622}},
      {"Schlick 0.05, scratched",
       create<Shader>("SchlickShader", {{"roughness", 0.05}, {"isotropy", 0.3}, {"color", 1.0}}),
       all_lobes,
       {0.1334550097, 0.0119948888, 2.3937716482, 0.0230498157}},
      {"Schlick, two layers",
       create<Shader>("SchlickShader",
                      {{"roughness", 0.05}, {"isotropy", 0.3}, {"color", 0.06}, {"base_color", 0.5}, {"base_roughness", 0.7}}),
       all_lobes,
       {0.0674893088, 0.0385392987, 0.9501756212, 0.0603934061}},
      {"Lafortune",
       create<Shader>(
           "LafortuneShader",
           {{"coefficients", std::vector<double>{-0.9, -1.1, 1.0}}, {"exponents", std::vector<double>{8.5}}, {"color", 0.0}}),
       all_lobes,
       {0.2415291607, 0, 0.4188250309, 0.0233654270}},
      {"coupled",
       create<Shader>("CoupledMatteSpecular", {{"color", 0.7}, {"specular", 0.05}}),
       all_lobes,
       {0.2151633393, 0.1948405193, 0.0940213238, 0.2209671902}},
      {"transmitter",
       create<Shader>("DiffuseTransmitter", {{"reflectance", 0.5}, {"transmittance", 0.25}}),
       all_lobes,
       {0.1591549431, 0.1591549431, 0.1591549431, 0.1591549431}},
  };
  for (const auto& row : table) {
    const Bound scatter(row.shader);
    for (size_t i = 0; i < 4; ++i) {
      const double* a = pairs[i];
      const Vector3 out = direction(a[0], a[1]), in = direction(a[2], a[3]);
      const double tolerance = 2e-5 * row.expected[i] + 1e-9;
      EXPECT_NEAR(scatter.value(out, in, row.lobes), row.expected[i], tolerance) << row.name << ", pair " << i;
      EXPECT_NEAR(scatter.value(mirrored(out), mirrored(in), row.lobes), row.expected[i], tolerance) << row.name << ", behind";
    }
  }
}

// ---- what holds of all --------------------------------------------------------------------------------------------

constexpr double angles[] = {0, 35, 65, 84, 89.5, 125};  // the last from behind

TEST(ClassicShaders, ReflectAtMostWhatArrives) {
  for (const Case& c : cases()) {
    const Bound scatter(c.shader);
    for (const double angle : angles)
      for (const double azimuth : {0.0, 45.0, 90.0}) {
        const Vector3 out = direction(angle, azimuth);
        const double albedo = scatter.albedo(out), estimate = double(scatter->albedo(out)[0]);
        EXPECT_LE(albedo, 1.004) << c.name << " at " << angle << ", " << azimuth;  // a standard error is below 0.002
        EXPECT_NEAR(estimate, albedo, 0.06) << c.name << " at " << angle << ", " << azimuth;
        EXPECT_LE(estimate, 1.0001f) << c.name;
      }
  }
}

TEST(ClassicShaders, SamplesFollowDensity) {
  constexpr int rows = 10, columns = 12, finer = 3, count = 10000;
  const double significance = test::each_of(int(cases().size() * std::size(angles) * 2));
  std::uint32_t seed = 1;
  for (const Case& c : cases()) {
    const Bound scatter(c.shader);
    for (const double angle : angles)
      for (const Lobes lobes : {Lobes(all_lobes), Lobes(glossy_reflection | diffuse_transmission)}) {
        if (!scatter->has(lobes) || (lobes != all_lobes && scatter->lobes() == lobes)) continue;
        const Vector3 out = direction(angle, 40);
        const std::vector<double> fine =
            test::integrate_cells(scatter->frame(), finer * rows, finer * columns,
                                  [&](const Vector3& in) { return double(scatter->pdf(out, in, {.lobes = lobes})); });
        std::vector<double> expected(size_t(rows * columns));
        for (size_t i = 0; i < fine.size(); ++i) {
          const size_t row = i / (finer * columns), column = i % (finer * columns);
          expected[row / finer * columns + column / finer] += fine[i];
        }
        double total = 0;
        for (double& e : expected) {
          total += e;
          e *= count;
        }
        EXPECT_LE(total, 1.002) << c.name << " at " << angle;
        expected.push_back(std::max(0.0, (1 - total) * count));
        std::vector<double> counts(expected.size());
        test::Random random(seed++);
        for (int i = 0; i < count; ++i) {
          const float choice = random();
          const auto s = scatter->sample(out, choice, random.pair(), {.lobes = lobes});
          ++counts[s && !s->specular() ? test::cell_of(scatter->frame(), rows, columns, s->direction) : counts.size() - 1];
        }
        EXPECT_GT(test::chi_square(counts, expected), significance) << c.name << " at " << angle << ", lobes " << int(lobes);
      }
  }
}

TEST(ClassicShaders, AreReciprocalAndConsistent) {
  test::Random random(3);
  for (const Case& c : cases()) {
    const Bound scatter(c.shader);
    int seen = 0;
    for (int i = 0; i < 400; ++i) {
      const Vector3 out = random.direction();
      const Lobes lobes = i % 2 ? Lobes(all_lobes) : Lobes(1u << (i / 2 % 7));
      const float choice = random();
      const auto s = scatter->sample(out, choice, random.pair(), {.lobes = lobes});
      if (!s || s->specular()) continue;
      ++seen;
      const ScatterValue both = scatter->value_and_pdf(out, s->direction, {.lobes = lobes});
      EXPECT_NEAR(both.pdf, s->pdf, 2e-3f * s->pdf) << c.name;
      EXPECT_NEAR(both.value[0], s->weight[0] * s->pdf, 2e-3f * s->weight[0] * s->pdf) << c.name;
      const double there = scatter.value(out, s->direction), back = scatter.value(s->direction, out);
      EXPECT_NEAR(there, back, 1e-5 * there) << c.name;
    }
    EXPECT_GT(seen, 30) << c.name;
  }
}

// ---- what holds of single ones ------------------------------------------------------------------------------------

TEST(OrenNayar, WhiteLosesNothing) {
  for (const double roughness : {0.0, 1e-6, 0.01, 0.3, 0.6, 1.0}) {
    const Bound scatter(create<Shader>("OrenNayar", {{"roughness", roughness}, {"color", 1.0}}));
    for (const double angle : {0.0, 20.0, 50.0, 75.0, 88.0}) {
      const Vector3 out = direction(angle, 40);
      double albedo = 0;
      for (const double cell : test::integrate_cells(
               scatter->frame(), 40, 40, [&](const Vector3& in) { return scatter.value(out, in) * scatter->cosine(in); }))
        albedo += cell;
      EXPECT_NEAR(albedo, 1, 3e-4) << roughness << " at " << angle;  // the kinks of f make the quadrature wrong by 1e-4
      EXPECT_NEAR(scatter->albedo(out)[0], 1, 1e-6f);
    }
  }
  EXPECT_TRUE(create<Shader>("OrenNayar", {{"color", 1.0}})->lossless());
  EXPECT_FALSE(create<Shader>("OrenNayar", {{"color", 0.99}})->lossless());
}

TEST(CoupledMatteSpecular, AlbedoIsCoatPlusWhatItLetsThrough) {
  const Bound scatter(create<Shader>("CoupledMatteSpecular", {{"color", 0.6}, {"specular", 0.1}}));
  for (const double angle : {0.0, 45.0, 80.0, 100.0}) {
    const Vector3 out = direction(angle, 10);
    const double r = 0.1 + 0.9 * std::pow(1 - std::abs(std::cos(angle * M_PI / 180)), 5);
    EXPECT_NEAR(scatter->albedo(out)[0], r + 0.6 * (1 - r), 1e-6);
    EXPECT_NEAR(scatter.albedo(out, diffuse_lobes), 0.6 * (1 - r), 1e-3);
    EXPECT_NEAR(scatter->sample(out, 0, {0.5f, 0.5f}, {.lobes = specular_lobes})->weight[0], r, 1e-6);
  }
}

TEST(WardShader, FollowsTheTangentAndItsRotation) {
  const auto lobe = [](double rotation) {
    return create<Shader>(
        "WardShader", {{"color", 0.0}, {"specular", 1.0}, {"roughness_u", 0.1}, {"roughness_v", 0.5}, {"rotation", rotation}});
  };
  const Vector3 out{0, 0, 1}, along = direction(40, 0), across = direction(40, 90);
  const Bound plain(lobe(0)), turned(lobe(0.25));
  EXPECT_GT(plain.value(out, across), 100 * plain.value(out, along));
  EXPECT_NEAR(turned.value(out, along), plain.value(out, across), 1e-4 * plain.value(out, across));
  const Frame frame = tangent_frame(flat_point(), 0.125f);
  EXPECT_NEAR(length(frame.s - direction(90, 45)), 0, 1e-6);
  EXPECT_NEAR(length(frame.t - direction(90, 135)), 0, 1e-6);
}

TEST(SchlickShader, GoesFromMirrorToMatt) {
  const auto lobes = [](double roughness) {
    return Bound(create<Shader>("SchlickShader", {{"roughness", roughness}}))->lobes();
  };
  EXPECT_EQ(lobes(0), specular_reflection);
  EXPECT_EQ(lobes(0.2), specular_reflection | glossy_reflection);
  EXPECT_EQ(lobes(0.5), glossy_reflection);
  EXPECT_EQ(lobes(0.8), diffuse_reflection | glossy_reflection);
  EXPECT_EQ(lobes(1), diffuse_reflection);
}

TEST(LafortuneShader, ScalesDownWhatWouldCreateEnergy) {
  // cx = cy = -1, cz = 1, n = 0 has the albedo 2 pi, twice pi times too much: f = 1 becomes 1 / pi.
  const auto flat = [](double c, double n) {
    return create<Shader>(
        "LafortuneShader",
        {{"coefficients", std::vector<double>{-c, -c, c}}, {"exponents", std::vector<double>{n}}, {"color", 0.0}});
  };
  const Vector3 up{0, 0, 1};
  EXPECT_NEAR(Bound(flat(1, 0)).value(up, direction(30, 0)), 1 / M_PI, 1e-4);
  // Phong's lobe has the albedo 2 pi c^n / (n + 2) at normal incidence; if that is below 1, the lobe is unchanged.
  EXPECT_NEAR(Bound(flat(1, 20))->albedo(up)[0], 2 * M_PI / 22, 1e-4);
  EXPECT_NEAR(Bound(flat(1.1, 20)).value(up, up), 22 / (2 * M_PI), 1e-3);  // 1.1^20 2 pi / 22 = 1.92
  EXPECT_THROW(create<Shader>("LafortuneShader", {{"exponents", std::vector<double>{1, 2}}}), Error);
  EXPECT_THROW(flat(100, 50), Error);
}

TEST(DiffuseTransmitter, SharesLightBetweenTheSides) {
  const Ref<Shader> shader = create<Shader>("DiffuseTransmitter", {{"reflectance", 0.9}, {"transmittance", 0.6}});
  EXPECT_FALSE(shader->transmits());
  const Bound scatter(shader);
  const Vector3 out = direction(30, 0);
  EXPECT_NEAR(scatter.albedo(out, reflection_lobes), 0.6, 1e-5);
  EXPECT_NEAR(scatter.albedo(out, transmission_lobes), 0.4, 1e-5);
  EXPECT_NEAR(scatter.value(out, direction(120, 50)), 0.4 / M_PI, 1e-6);
  EXPECT_EQ(scatter.value(out, direction(120, 50), reflection_lobes), 0);
}

TEST(ClassicShaders, RefuseWhatIsOutOfRange) {
  EXPECT_THROW(create<Shader>("OrenNayar", {{"roughness", 1.5}}), Error);
  EXPECT_THROW(create<Shader>("WardShader", {{"roughness_u", 0.0}}), Error);
  EXPECT_THROW(create<Shader>("AshikhminShirley", {{"exponent_u", -1.0}}), Error);
  EXPECT_THROW(create<Shader>("SchlickShader", {{"isotropy", 0.0}}), Error);
  EXPECT_THROW(create<Shader>("CoupledMatteSpecular", {{"specular", 2.0}}), Error);
}

}  // namespace
}  // namespace etendue
