// Shaders made of other shaders, and wave optics: mixtures, masks, bumps, layers, thin films and gratings against closed forms.

#include <fstream>

#include "components/shaders/fresnel.h"
#include "components/shaders/microfacet/film_interference.h"
#include "etendue/core/warp.h"
#include "etendue/describe/color.h"
#include "etendue/object_map.h"
#include "etendue/shader.h"
#include "etendue/volume_shader.h"
#include "support/component_test_support.h"
#include "support/shader_test_support.h"

namespace etendue {
namespace {

using test::at_angle;
using test::create;

/// A grey image of 16 bits, used for a map or a shader.
std::string image_file(const std::string& name, int width, int height, int channels,
                       const std::function<double(int x, int y, int c)>& value) {
  const std::string path = testing::TempDir() + name;
  std::ofstream file(path, std::ios::binary);
  file << (channels == 3 ? "P6 " : "P5 ") << width << ' ' << height << " 65535\n";
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < channels; ++c) {
        const int v = int(std::lround(65535 * value(x, y, c)));
        file.put(char(v >> 8)).put(char(v & 255));
      }
  return path;
}

/// A point of a square metre seen from the front, whose surface coordinates are x and y.
SurfacePoint on_square(float u = 0.4f, float v = 0.6f) {
  SurfacePoint p = test::surface_point({0, 0, 1});
  p.position = p.object_position = {u, v, 0};
  p.uv = {u, v};
  p.dpdu = {1, 0, 0};
  p.dpdv = {0, 1, 0};
  return p;
}

/// Tilts a shader by a bump map with a slope of 0.5 along u.
Ref<Shader> bumped(const Ref<Shader>& below) {
  const auto ramp = create<ObjectMap>(
      "ImageMap",
      {{"file", image_file("ramp.ppm", 256, 1, 1, [](int x, int, int) { return x / 255.0; })}, {"transfer", "linear"}});
  return create<Shader>("BumpShader", {{"shader", below}, {"height", ramp}, {"scale", 0.5 * 255 / 256}});
}

// ---- MixShader and MaskShader -------------------------------------------------------------------------------------

TEST(MixShader, OfLambertiansIsTheLambertianOfTheMean) {
  const Ref<Shader> a = create<Shader>("Lambertian", {{"color", 0.2}}), b = create<Shader>("Lambertian", {{"color", 0.8}});
  const Ref<Shader> mix = create<Shader>("MixShader", {{"first", a}, {"second", b}, {"amount", 0.25}});
  Arena arena;
  const Scatter& scatter = *mix->bind(test::surface_point(), test::wavelengths(), arena);
  const Vector3 out = at_angle(scatter.frame(), 40), in = at_angle(scatter.frame(), 70, 2);
  EXPECT_NEAR(scatter.evaluate(out, in)[0], 0.35f * inverse_pi * scatter.cosine(in), 1e-6f);
  EXPECT_NEAR(scatter.pdf(out, in), scatter.cosine(in) * inverse_pi, 1e-6f);
  EXPECT_NEAR(scatter.albedo(out)[0], 0.35f, 1e-6f);
  test::Random random(1);
  for (int i = 0; i < 100; ++i) {
    const float choice = random();
    const auto s = scatter.sample(out, choice, random.pair());
    ASSERT_TRUE(s);
    EXPECT_NEAR(s->weight[0], 0.35f, 1e-5f);
  }
  EXPECT_EQ(create<Shader>("MixShader", {{"first", a}, {"second", b}, {"amount", 1.0}})
                ->bind(test::surface_point(), test::wavelengths(), arena)
                ->albedo(out)[0],
            0.8f);
}

TEST(TwoSidedShader, IsEachOfItsPartsFromItsSide) {
  const Ref<Shader> a = create<Shader>("Lambertian", {{"color", 0.2}}), b = create<Shader>("PhongShader", {{"color", 0.8}});
  const Ref<Shader> both = create<Shader>("TwoSidedShader", {{"front", a}, {"back", b}});
  const SurfacePoint p = on_square();
  const Wavelengths w = test::wavelengths();
  Arena arena;
  const Scatter* const whole = both->bind(p, w, arena);
  for (const double side : {0.0, 180.0}) {
    const Scatter* const part = (side == 0 ? a : b)->bind(p, w, arena);
    const Frame frame(p.normal);
    const Vector3 out = at_angle(frame, side + 30), in = at_angle(frame, side + 50, 2.1), behind = at_angle(frame, side + 150);
    EXPECT_GT(part->evaluate(out, in)[0], 0);
    EXPECT_EQ(whole->evaluate(out, in)[0], part->evaluate(out, in)[0]);
    EXPECT_EQ(whole->pdf(out, in), part->pdf(out, in));
    EXPECT_EQ(whole->evaluate(out, behind)[0], 0);
    EXPECT_EQ(whole->albedo(out)[0], part->albedo(out)[0]);
    const auto sample = whole->sample(out, 0.3f, {0.2f, 0.7f}), own = part->sample(out, 0.3f, {0.2f, 0.7f});
    ASSERT_TRUE(sample && own);
    EXPECT_EQ(sample->direction.x, own->direction.x);
  }
  const Ref<Shader> glass = create<Shader>("Dielectric", {});
  EXPECT_THROW(create<Shader>("TwoSidedShader", {{"front", a}, {"back", glass}}), Error);
}

TEST(MixShader, KeepsTheAdjointOfPartsWithOtherNormals) {
  const Ref<Shader> phong = create<Shader>("PhongShader", {{"exponent", 8.0}});
  const Ref<Shader> mix = create<Shader>("MixShader", {{"first", phong}, {"second", bumped(phong)}, {"amount", 0.6}});
  Arena arena;
  SurfacePoint p = on_square();
  p.shading_normal = normalize(Normal3(0.1f, 0.3f, 1));
  const Scatter& scatter = *mix->bind(p, test::wavelengths(), arena);
  test::Random random(5);
  int seen = 0;
  for (int i = 0; i < 500; ++i) {
    const Vector3 a = random.direction(), b = random.direction();
    const Spectrum light = scatter.evaluate(a, b, {.transport = Transport::importance}) / std::abs(dot(p.normal, b));
    const Spectrum camera = scatter.evaluate(b, a) / std::abs(dot(p.normal, a));
    EXPECT_NEAR(light[0], camera[0], 1e-3f * camera[0] + 1e-9f);
    seen += !light.black();
    // For both transport modes the weight of a sample is f |cos| / pdf.
    for (const Transport t : {Transport::radiance, Transport::importance})
      if (const auto s = scatter.sample(a, to_unit_float(std::uint32_t(i) << 23), random.pair(), {.transport = t})) {
        const ScatterValue v = scatter.value_and_pdf(a, s->direction, {.transport = t});
        EXPECT_NEAR(s->weight[0], v.value[0] / v.pdf, 2e-3f * s->weight[0]);
        EXPECT_NEAR(s->pdf, v.pdf, 2e-3f * v.pdf);
      }
  }
  EXPECT_GT(seen, 100);
}

TEST(MaskShader, LetsTheRestPass) {
  const Ref<Shader> grey = create<Shader>("Lambertian", {{"color", 0.5}}), none = create<Shader>("PassThrough");
  const Ref<Shader> mask = create<Shader>("MaskShader", {{"shader", grey}, {"opacity", 0.3}});
  const Ref<Shader> mix = create<Shader>("MixShader", {{"first", mask}, {"second", none}, {"amount", 0.5}});
  Arena arena;
  const SurfacePoint p = test::surface_point();
  const Scatter &scatter = *mask->bind(p, test::wavelengths(), arena), &both = *mix->bind(p, test::wavelengths(), arena);
  const Vector3 out = at_angle(scatter.frame(), 20), in = at_angle(scatter.frame(), 50, 2);
  EXPECT_NEAR(scatter.sample(out, 0, {}, {.lobes = null_scattering})->weight[0], 0.7f, 1e-6f);
  EXPECT_NEAR(both.sample(out, 0, {}, {.lobes = null_scattering})->weight[0], 0.85f, 1e-6f);
  EXPECT_NEAR(scatter.evaluate(out, in)[0], 0.15f * inverse_pi * scatter.cosine(in), 1e-6f);
  EXPECT_EQ(scatter.lobes(), null_scattering | diffuse_reflection);
  // With all lobes: 70 % null scattering, 15 % reflected. Both weights are constant, so the means are exact up to counting.
  test::Random random(2);
  double straight = 0, reflected = 0;
  constexpr int count = 20000;
  for (int i = 0; i < count; ++i) {
    const float choice = (float(i) + 0.5f) / count;
    const auto s = scatter.sample(out, choice, random.pair());
    if (!s) continue;
    (s->lobe == null_scattering ? straight : reflected) += double(s->weight[0]) / count;
    EXPECT_EQ(s->direction == -out, s->lobe == null_scattering);
  }
  EXPECT_NEAR(straight, 0.7, 1e-3);
  EXPECT_NEAR(reflected, 0.15, 1e-3);
}

// ---- bumps --------------------------------------------------------------------------------------------------------

TEST(BumpShader, TiltsByTheSlope) {
  Arena arena;
  const Ref<Shader> shader = bumped(create<Shader>("Lambertian"));
  const Normal3 expected = normalize(Normal3(-0.5f, 0, 1));
  for (const float footprint : {0.0f, 0.02f}) {
    SurfacePoint p = on_square();
    p.footprint = footprint;
    EXPECT_LT(length(Vector3(shader->bind(p, test::wavelengths(), arena)->frame().n) - Vector3(expected)), 2e-3f);
    // With u reversed and stretched: the same hill.
    p.dpdu = {-2, 0, 0};
    EXPECT_LT(
        length(Vector3(shader->bind(p, test::wavelengths(), arena)->frame().n) - Vector3(normalize(Normal3(0.25f, 0, 1)))),
        2e-3f);
  }
  // Without surface coordinates the normal is unchanged.
  EXPECT_EQ(shader->bind(test::surface_point({0, 0, 1}), test::wavelengths(), arena)->frame().n, Normal3(0, 0, 1));
}

TEST(NormalMapShader, ReadsVectors) {
  // x = 0.5, y = 0.25, z = 1.
  const std::string file = image_file("normal.ppm", 1, 1, 3, [](int, int, int c) {
    return c == 0 ? 0.75 : c == 1 ? 0.625 : 1;
  });
  const Ref<Shader> below = create<Shader>("Lambertian");
  const auto normal = [&](const SurfacePoint& p, double strength, const char* flip) {
    Arena arena;
    const Ref<Shader> s = ref_cast<Shader>(Registry::instance().create("NormalMapShader"));
    set(*s, "shader", Value(Ref<Component>(below)));
    set(*s, "file", Value(file));
    set(*s, "strength", Value(Number{strength}));
    set(*s, "flip_y", Value(std::string(flip) == "yes"));
    prepare_tree(*s);
    return Vector3(s->bind(p, test::wavelengths(), arena)->frame().n);
  };
  SurfacePoint p = on_square();
  EXPECT_LT(length(normal(p, 1, "no") - normalize(Vector3{0.5f, 0.25f, 1})), 1e-4f);
  EXPECT_LT(length(normal(p, 2, "yes") - normalize(Vector3{1, -0.5f, 1})), 1e-4f);
  p.dpdv = -p.dpdv;
  EXPECT_LT(length(normal(p, 1, "no") - normalize(Vector3{0.5f, -0.25f, 1})), 1e-4f);
}

TEST(NormalMapShader, TakesAMapThatHoldsThem) {
  // Two adjacent texels along u: x = 0.5 and -0.5. As a file they are repeated 4 times; as a map, its coordinates are.
  const std::string file = image_file("normals2.ppm", 2, 1, 3, [](int x, int, int c) {
    return c == 0 ? (x == 0 ? 0.75 : 0.25) : c == 1 ? 0.5 : 1;
  });
  const Ref<Shader> below = create<Shader>("Lambertian");
  const Ref<ObjectMap> image = create<ObjectMap>("ImageMap", {{"file", file}, {"transfer", "linear"}}),
                       moved = create<ObjectMap>("UvTransformMap", {{"map", image}, {"scale", std::vector<double>{4, 1}}});
  const Ref<Shader> by_file = create<Shader>("NormalMapShader",
                                             {{"shader", below}, {"file", file}, {"repeat", std::vector<double>{4, 1}}}),
                    by_map = create<Shader>("NormalMapShader", {{"shader", below}, {"map", moved}});
  Arena arena;
  bool tilted = false;
  for (const float u : {0.03f, 0.1f, 0.18f, 0.31f, 0.8f})
    for (const float footprint : {0.0f, 0.4f}) {
      SurfacePoint p = on_square();
      p.uv = {u, 0.4f};
      p.footprint = footprint;
      const Vector3 a(by_file->bind(p, test::wavelengths(), arena)->frame().n),
          b(by_map->bind(p, test::wavelengths(), arena)->frame().n);
      EXPECT_LT(length(a - b), 2e-3f) << u;
      tilted = tilted || std::abs(b.x) > 0.3f;
    }
  EXPECT_TRUE(tilted);
  // Maps without such vectors are refused, instead of being taken for grey.
  EXPECT_THROW(create<Shader>("NormalMapShader", {{"shader", below}, {"map", create<ObjectMap>("CheckerMap")}}), Error);
  EXPECT_THROW(create<Shader>("NormalMapShader",
                              {{"shader", below},
                               {"map", create<ObjectMap>("UvTransformMap", {{"map", create<ObjectMap>("CheckerMap")}})}}),
               Error);
}

// ---- ThinFilm -----------------------------------------------------------------------------------------------------

float film_reflectance(const Shader& film, double angle, float hero = 500, Lobes lobes = reflection_lobes) {
  Arena arena;
  const Scatter& s = *film.bind(test::surface_point(), test::wavelengths(hero), arena);
  return s.albedo(at_angle(s.frame(), angle), lobes)[0];
}

TEST(ThinFilm, WithoutThicknessIsTheBareSurface) {
  const Ref<Shader> film = create<Shader>("ThinFilm", {{"thickness", 0.0}});
  const Ref<Shader> metal =
      create<Shader>("ThinFilm", {{"thickness", 0.0}, {"base_ior", complex_index(flat_spectrum(0.8f), flat_spectrum(6))}});
  for (const double angle : {0.0, 30.0, 56.31, 80.0, 89.0, 91.0, 110.0, 150.0, 180.0}) {
    const float c = float(std::abs(std::cos(angle * M_PI / 180)));
    EXPECT_NEAR(film_reflectance(*film, angle), fresnel_dielectric(c, angle < 90 ? 1.5f : 1 / 1.5f), 3e-5f) << angle;
    EXPECT_NEAR(film_reflectance(*metal, angle), fresnel_conductor(c, 0.8f, 6), 3e-5f) << angle;
  }
}

TEST(ThinFilm, QuarterWaveAndHalfWave) {
  // A quarter of a wave thick: R = ((n0 n2 - n1^2) / (n0 n2 + n1^2))^2, Born & Wolf section 1.6.4, eq. 62; 0 for n1 = sqrt(n2).
  // Half a wave thick: as without the film.
  for (const double n1 : {1.2247449, 1.38, 2.3}) {
    const Ref<Shader> quarter = create<Shader>("ThinFilm", {{"thickness", 500 / (4 * n1)}, {"film_ior", n1}});
    const Ref<Shader> half = create<Shader>("ThinFilm", {{"thickness", 500 / (2 * n1)}, {"film_ior", n1}});
    EXPECT_NEAR(film_reflectance(*quarter, 0), std::pow((1.5 - n1 * n1) / (1.5 + n1 * n1), 2), 1e-5);
    EXPECT_NEAR(film_reflectance(*half, 0), 0.04, 1e-5);
  }
}

TEST(ThinFilm, LosesNothingAndIsReciprocal) {
  test::Random random(4);
  for (int i = 0; i < 2000; ++i) {
    const float n0 = 1 + random(), n1 = 1 + 2 * random(), n2 = 1 + 2 * random(), d = 3 * random(), c = 0.01f + 0.99f * random();
    const FilmFractions there = film_fractions(c, n0, n1, n2, d);
    const float sine = n0 / n2 * std::sqrt(1 - c * c);
    if (sine > 0.99f && sine < 1.01f) continue;
    EXPECT_NEAR(there.reflected + there.transmitted, 1, 1e-3f);
    if (sine >= 1) continue;
    EXPECT_NEAR(film_fractions(std::sqrt(1 - sine * sine), n2, n1, n0, d).reflected, there.reflected, 1e-3f);
  }
  // On a metal the transmitted light is absorbed by the metal; the film itself absorbs nothing.
  const FilmFractions metal = film_fractions(0.6f, 1, 1.4f, {0.8f, 3}, 0.3f);
  EXPECT_NEAR(metal.reflected + metal.transmitted, 1, 1e-5f);
  // Beyond the critical angle light tunnels through a thin film, and hardly through a thick one.
  EXPECT_LT(film_fractions(0.6f, 1.5f, 1, 1.5f, 0.02f).reflected, 0.1f);
  EXPECT_GT(film_fractions(0.6f, 1.5f, 1, 1.5f, 2).reflected, 0.999f);
}

// ---- DiffractionGrating -------------------------------------------------------------------------------------------

TEST(DiffractionGrating, OrdersFollowTheGratingEquation) {
  // 600 grooves a millimetre along x, 500 nm: lambda / d = 0.3.
  const Ref<Shader> grating =
      create<Shader>("DiffractionGrating", {{"lines", 600.0}, {"efficiency", std::vector<double>{0.2, 0.3, 0.1}}});
  Arena arena;
  const Scatter& s = *grating->bind(on_square(), test::wavelengths(500), arena);
  const Vector3 out{0, 0.5f, std::sqrt(0.75f)};
  std::array<double, 5> weight{};
  constexpr int count = 1000;
  for (int i = 0; i < count; ++i) {
    const auto sample = s.sample(out, (float(i) + 0.5f) / count, {});
    ASSERT_TRUE(sample);
    const double order = double((sample->direction.y + 0.5f) / 0.3f);
    ASSERT_NEAR(order, std::round(order), 1e-4);
    EXPECT_EQ(sample->dispersive, std::round(order) != 0);
    EXPECT_NEAR(sample->direction.x, 0, 1e-6f);
    weight[size_t(std::lround(order) + 2)] += double(sample->weight[0]) / count;
    // Reciprocity: from the sampled direction, one of the orders leads back to the original direction.
    bool found = false;
    for (int k = 0; k < 5; ++k)
      if (const auto back = s.sample(sample->direction, 0.1f + 0.2f * float(k), {}))
        found |= length(back->direction - out) < 1e-5f;
    EXPECT_TRUE(found);
  }
  // in.y = -0.5 - 0.6 is no direction: its fraction of 0.1 is lost.
  const double expected[] = {0, 0.3, 0.2, 0.3, 0.1};
  for (size_t i = 0; i < 5; ++i) EXPECT_NEAR(weight[i], expected[i], 2e-3) << i;
  EXPECT_NEAR(s.albedo(out)[0], 0.9f, 1e-5f);
  EXPECT_THROW(create<Shader>("DiffractionGrating", {{"efficiency", std::vector<double>{0.5, 0.3}}}), Error);
}

}  // namespace
}  // namespace etendue
