// Shaders inside a medium other than vacuum. A boundary depends on the ratio of indices alone (and, for a film, on its
// thickness relative to the wavelength in the surrounding medium): in a medium of index n, a body of index n r scatters as one
// of index r does in vacuum, at every wavelength and every angle, from both sides.

#include "etendue/describe/color.h"
#include "etendue/object_map.h"
#include "etendue/transport/medium_stack.h"
#include "support/component_test_support.h"
#include "support/render_support.h"

namespace etendue {
namespace {

using test::create;
using test::Setting;

/// Wavelengths at whole nanometres, where tables have their entries.
Wavelengths whole_nanometres() {
  Wavelengths w;
  for (int i = 0; i < spectrum_size; ++i) w.place(i, float(420 + 350 * i / spectrum_size), 1.0f / 470);
  return w;
}

/// A spectrum that tabulates a function of the wavelength [nm].
Color table(const std::function<double(double)>& f) {
  std::vector<float> wavelengths, values;
  for (int l = 360; l <= 830; ++l) {
    wavelengths.push_back(float(l));
    values.push_back(float(f(l)));
  }
  return table_spectrum(wavelengths, values);
}

double outside_index(double l) { return 1.45 - 0.0003 * (l - 360); }
double ratio(double l) { return 1.12 + 0.0002 * (l - 360); }

class OutsideMedium : public testing::Test {
 protected:
  void SetUp() override {
    square_.reference();
    water_.reference();
    water_.shader = create<Shader>("Dielectric", {{"ior", table(outside_index)}});
    grey_.reference();
    grey_.shader = create<Shader>("Dielectric", {{"ior", flat_spectrum(1.25f)}});
  }

  SurfacePoint point(const test::TestSquare* around) {
    SurfacePoint p = test::surface_point({0, 0, 1});
    p.object = &square_;
    if (around) {
      media_.enter(*around);
      p.media = &media_;
    }
    return p;
  }

  /// Expects that the first shader, inside a medium, equals the second in vacuum.
  void expect_alike(const std::string& name, const Ref<Shader>& under, const Ref<Shader>& in_vacuum,
                    const test::TestSquare& around, bool hero_only = false) {
    media_ = {};
    const Wavelengths w = whole_nanometres();
    Arena arena;
    const Scatter *a = under->bind(point(&around), w, arena), *b = in_vacuum->bind(point(nullptr), w, arena);
    ASSERT_TRUE(a && b) << name;
    EXPECT_EQ(a->lobes(), b->lobes()) << name;
    test::Random random(23);
    double light = 0;
    const int wavelengths = hero_only ? 1 : spectrum_size;
    for (int i = 0; i < 300; ++i) {
      const Vector3 out = random.direction();
      Vector3 in = random.direction();
      if (i % 2) in = normalize(Vector3{-out.x, -out.y, out.z} + 0.2f * random.direction());
      if (std::abs(out.z) < 0.02f) continue;
      const Spectrum f = a->evaluate(out, in), g = b->evaluate(out, in), e = a->albedo(out), h = b->albedo(out);
      for (int k = 0; k < wavelengths; ++k) {
        EXPECT_NEAR(f[k], g[k], 2e-3f * g[k] + 1e-5f) << name << " " << k << " " << out.z;
        EXPECT_NEAR(e[k], h[k], 2e-3f * h[k] + 1e-5f) << name << " " << k << " " << out.z;
        light += double(f[k]);
      }
      const float choice = random();
      const Point2 u = random.pair();
      for (const Lobes lobes : {Lobes(all_lobes), Lobes(specular_reflection), Lobes(specular_transmission)}) {
        const auto s = a->sample(out, choice, u, {.lobes = lobes}), t = b->sample(out, choice, u, {.lobes = lobes});
        ASSERT_EQ(bool(s), bool(t)) << name << " " << out.z;
        if (!s || s->lobe != t->lobe) continue;  // rounding may change the chosen lobe
        EXPECT_LT(length(s->direction - t->direction), 2e-3f) << name;
        EXPECT_EQ(s->dispersive, t->dispersive) << name;
        for (int k = 0; k < wavelengths; ++k)
          EXPECT_NEAR(s->weight[k], t->weight[k], 5e-3f * t->weight[k] + 1e-4f) << name << " " << k << " " << out.z;
        light += double(s->weight[0]);
      }
      if (HasFailure()) return;
    }
    EXPECT_GT(light, 1) << name;
  }

  test::TestSquare square_, water_, grey_;
  MediumStack media_;
};

TEST_F(OutsideMedium, Glass) {
  for (const double roughness : {0.0, 0.3}) {
    const Setting rough{"roughness", roughness};
    expect_alike("glass",
                 create<Shader>("Dielectric", {{"ior", table([](double l) { return ratio(l) * outside_index(l); })}, rough}),
                 create<Shader>("Dielectric", {{"ior", table(ratio)}, rough}), water_);
    // From the denser side.
    expect_alike("air", create<Shader>("Dielectric", {{"ior", flat_spectrum(1)}, rough}),
                 create<Shader>("Dielectric", {{"ior", table([](double l) { return 1 / outside_index(l); })}, rough}), water_);
  }
}

TEST_F(OutsideMedium, Metal) {
  const auto k = [](double l) { return 2 + 0.005 * (l - 360); };
  for (const double roughness : {0.0, 0.4}) {
    const Setting rough{"roughness", roughness};
    const Color under = complex_index(table([](double l) { return 0.4 * outside_index(l); }),
                                      table([&](double l) { return k(l) * outside_index(l); })),
                vacuum = complex_index(flat_spectrum(0.4f), table(k));
    expect_alike("metal", create<Shader>("Conductor", {{"ior", under}, rough}),
                 create<Shader>("Conductor", {{"ior", vacuum}, rough}), water_);
  }
}

TEST_F(OutsideMedium, PlasticInAnIndexThatIsTheSameAtAllWavelengths) {
  for (const double roughness : {0.0, 0.4}) {
    const Setting rough{"roughness", roughness};
    expect_alike("plastic", create<Shader>("Plastic", {{"ior", 1.25 * 1.4}, rough}),
                 create<Shader>("Plastic", {{"ior", 1.4}, rough}), grey_);
  }
}

TEST_F(OutsideMedium, ThinPane) {
  const Setting color{"color", table_spectrum({360, 830}, {0.9f, 0.3f})};
  expect_alike("pane",
               create<Shader>("ThinDielectric", {{"ior", table([](double l) { return ratio(l) * outside_index(l); })}, color}),
               create<Shader>("ThinDielectric", {{"ior", table(ratio)}, color}), water_);
}

TEST_F(OutsideMedium, ThinFilm) {
  // The thickness counts relative to the wavelength within the film: n1 d.
  for (const bool metal : {false, true}) {
    const Color base = metal ? complex_index(flat_spectrum(0.8f), flat_spectrum(3)) : flat_spectrum(1.6f),
                under = metal ? complex_index(flat_spectrum(0.8f * 1.25f), flat_spectrum(3 * 1.25f)) : flat_spectrum(2.0f);
    expect_alike(
        "film",
        create<Shader>("ThinFilm", {{"film_ior", flat_spectrum(1.25f * 1.38f)}, {"base_ior", under}, {"thickness", 320.0}}),
        create<Shader>("ThinFilm", {{"film_ior", flat_spectrum(1.38f)}, {"base_ior", base}, {"thickness", 400.0}}), grey_);
  }
}

TEST_F(OutsideMedium, Hair) {
  // Only refraction depends on the medium; the absorption does not change.
  expect_alike("hair", create<Shader>("HairShader", {{"ior", 1.25 * 1.3}}), create<Shader>("HairShader", {{"ior", 1.3}}),
               grey_);
}

TEST_F(OutsideMedium, TranslucentBody) {
  expect_alike("body", create<Shader>("Subsurface", {{"ior", table([](double l) { return ratio(l) * outside_index(l); })}}),
               create<Shader>("Subsurface", {{"ior", table(ratio)}}), water_);
}

TEST_F(OutsideMedium, Principled) {
  const struct {
    const char* name;
    std::vector<Setting> both, under, vacuum;
  } cases[] = {{"glossy", {{"specular_roughness", 0.4}}, {{"specular_ior", 1.25 * 1.5}}, {{"specular_ior", 1.5}}},
               {"polished", {{"specular_roughness", 0.0}}, {{"specular_ior", 1.25 * 1.5}}, {{"specular_ior", 1.5}}},
               {"glass",
                {{"specular_roughness", 0.0}, {"transmission_weight", 1.0}},
                {{"specular_ior", 1.25 * 1.5}},
                {{"specular_ior", 1.5}}},
               {"coat",
                {{"coat_weight", 1.0}, {"coat_roughness", 0.3}, {"base_metalness", 0.5}},
                {{"specular_ior", 1.25 * 1.6}, {"coat_ior", 1.25 * 1.4}},
                {{"specular_ior", 1.6}, {"coat_ior", 1.4}}},
               {"film",
                {{"thin_film_weight", 1.0}, {"specular_roughness", 0.2}},
                {{"specular_ior", 1.25 * 1.6}, {"thin_film_ior", 1.25 * 1.38}, {"thin_film_thickness", 320.0}},
                {{"specular_ior", 1.6}, {"thin_film_ior", 1.38}, {"thin_film_thickness", 400.0}}}};
  for (const auto& c : cases) {
    std::vector<Setting> under = c.both, vacuum = c.both;
    under.insert(under.end(), c.under.begin(), c.under.end());
    vacuum.insert(vacuum.end(), c.vacuum.begin(), c.vacuum.end());
    expect_alike(c.name, create<Shader>("Principled", under), create<Shader>("Principled", vacuum), grey_);
  }
}

// A path is inside a body that it has entered more often than left, also when exits come first (a mesh with inverted normals).
TEST(MediumStack, WhatIsLeftBeforeItIsEnteredIsNotEntered) {
  test::TestSquare a, b;
  for (test::TestSquare* each : {&a, &b}) each->reference();
  MediumStack media;
  media.leave(a);
  media.enter(b);
  EXPECT_EQ(media.current(), &b);
  media.enter(a);
  EXPECT_EQ(media.current(), &b);
  media.enter(a);
  EXPECT_EQ(media.current(), &a);
  // Entries that did not fit into the stack still count.
  MediumStack full;
  for (int i = 0; i < MediumStack::capacity + 2; ++i) full.enter(i < 2 ? a : b);
  for (int i = 0; i < MediumStack::capacity; ++i) full.leave(b);
  for (int i = 0; i < 2; ++i) full.leave(a);
  full.enter(a);
  EXPECT_EQ(full.current(), &a);
}

// A slab of glass above a polished coat, seen along the normal under a white sky. With F = 0.04 at each face of the slab, it
// reflects R = 2 F / (1 + F) and transmits T = (1 - F) / (1 + F); the coat reflects C = (0.2 / 2.2)^2; so R + T^2 C / (1 - R C)
// is seen, for outward and for inverted normals: with inverted normals the refraction is reversed, which does not change F at
// normal incidence. (When the surroundings of an inverted slab were taken for glass, C was that of 1.2 / 1.5.)
TEST(MediumStack, AroundAMeshThatIsInsideOutIsNoGlass) {
  const double r = 2 * 0.04 / 1.04, t = 0.96 / 1.04, c = 0.04 / 4.84;
  const double expected = r + t * t * c / (1 - r * c);
  for (const char* triangles :
       {"[0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4, 1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7]",
        "[0, 1, 2, 0, 2, 3, 4, 6, 5, 4, 7, 6, 0, 5, 1, 0, 4, 5, 1, 6, 2, 1, 5, 6, 2, 7, 3, 2, 6, 7, 3, 4, 0, 3, 7, 4]"}) {
    const test::Measured seen = test::measure(test::job_text(
        "PathTracer { samples: 262144 }", "OrthographicCamera { from: [0, 0, 5], to: [0, 0, 0], up: [0, 1, 0], width: 0.01 }",
        1,
        std::string(
            "TriangleMesh { shader: Dielectric { ior: 1.5 }, positions: [[-9, -9, 1], [9, -9, 1], [9, 9, 1], [-9, 9, 1], "
            "[-9, -9, 2], [9, -9, 2], [9, 9, 2], [-9, 9, 2]], triangles: ") +
            triangles +
            " }\nRectangle { corner: [-9, -9, 0], edge_u: [18, 0, 0], edge_v: [0, 18, 0], shader: Plastic { color: 0, ior: "
            "1.2, "
            "roughness: 0 } }\nEnvironment { emission: DiffuseEmission { radiance: 1 } }"));
    EXPECT_NEAR(seen.mean.y, expected, 4 * seen.error);
    EXPECT_LT(seen.error, 0.0007);
  }
}

}  // namespace
}  // namespace etendue
