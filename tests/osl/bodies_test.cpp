// Closures of bodies, fibres and films against the shaders of the house, as classes of descriptions.

#include <gtest/gtest.h>

#include <fstream>

#include "etendue/describe/color.h"
#include "etendue/object_map.h"
#include "etendue/shader.h"
#include "osl/closures/slots.h"

namespace etendue::osl {
namespace {

struct Place {
  SurfacePoint p;
  Wavelengths w;
  Arena arena;
  Place() {
    p.normal = p.shading_normal = Normal3{0, 0, 1};
    p.dpdu = {1, 0, 0};
    p.dpdv = {0, 1, 0};
    p.uv = {0.25f, 0.3f};
    std::array<float, spectrum_size> lambda, pdf;
    for (size_t i = 0; i < spectrum_size; ++i) {
      lambda[i] = 400 + 40 * float(i);
      pdf[i] = 1 / 470.0f;
    }
    w = Wavelengths(lambda, pdf);
  }
};

Ref<etendue::Shader> surface(const std::string& name, const std::string& parameters, const std::string& body) {
  const std::string path = testing::TempDir() + name + ".osl";
  std::ofstream(path) << "surface " << name << "(" << parameters << ") {" << body << "}";
  Registry::instance().load_plugin(path);
  std::string class_name = name;
  class_name[0] = char(std::toupper(class_name[0]));
  const Ref<etendue::Shader> made = ref_cast<etendue::Shader>(Registry::instance().create(class_name));
  prepare_tree(*made);
  return made;
}

constexpr const char* general = "float glass = 0, float wax = 1";
constexpr const char* general_body =
    "Ci = wax * subsurface_bssrdf(N, color(0.8), color(0.1), 0) + "
    "glass * dielectric_bsdf(N, dPdu, color(1), color(1), 0, 0, 1.5, \"ggx\");";

TEST(OslBodies, LightLeavesThemElsewhere) {
  Place at;
  const Ref<etendue::Shader> wax = surface("bodywax", "", "Ci = subsurface_bssrdf(N, color(0.8), color(0.1), 0);");
  EXPECT_TRUE(wax->has_subsurface_exit());
  EXPECT_FALSE(wax->transmits());
  const Scatter* s = wax->bind(at.p, at.w, at.arena);
  ASSERT_TRUE(s);
  EXPECT_EQ(s->lobes(), specular_transmission);
  EXPECT_FLOAT_EQ(s->albedo({0, 0, 1})[0], 0.8f);
}

// A general material names both; which of them it has depends on its parameters.
TEST(OslBodies, ExcludeRefractionOnlyWhereThereIsOne) {
  Place at;
  const Ref<etendue::Shader> wax = surface("bodygeneral", general, general_body);
  EXPECT_TRUE(wax->has_subsurface_exit());
  EXPECT_FALSE(wax->transmits());
  set(*wax, "glass", etendue::Value(Number{0.5}));
  prepare_tree(*wax);
  EXPECT_FALSE(wax->has_subsurface_exit());
  EXPECT_TRUE(wax->transmits());
  EXPECT_TRUE(wax->bind(at.p, at.w, at.arena)->has(diffuse_reflection));  // what is said in a warning
}

TEST(OslBodies, FilmsAreThoseOfThinFilm) {
  Place at;
  const Ref<etendue::Shader> film = surface("bodyfilm", "",
                                            "Ci = conductor_bsdf(N, dPdu, 0, 0, color(1.5), color(1.6), \"ggx\", "
                                            "\"thinfilm_thickness\", 400.0, \"thinfilm_ior\", 1.8);");
  const Ref<etendue::Shader> house =
      make_model("ThinFilm", {{"thickness", Value(Number{400e-9, Dimension::length})},
                              {"film_ior", Value(flat_spectrum(1.8f))},
                              {"base_ior", Value(complex_index(flat_spectrum(1.5f), flat_spectrum(1.6f)))},
                              {"opaque", Value(true)}});
  prepare_tree(*house);
  const Vector3 out = normalize(Vector3{1, 0, 1});
  const Spectrum a = film->bind(at.p, at.w, at.arena)->albedo(out), b = house->bind(at.p, at.w, at.arena)->albedo(out);
  for (int i = 0; i < spectrum_size; ++i) EXPECT_NEAR(a[i], b[i], 2e-3f);
  EXPECT_GT(a.maximum() - a.minimum(), 0.05f);  // the film colours it
}

TEST(OslBodies, HairIsThatOfHairShader) {
  Place at;
  const Ref<etendue::Shader> hair =
      surface("bodyhair", "",
              "float b = 0.3, v = 0.726 * b + 0.812 * b * b + 3.7 * pow(b, 20); v *= v; "
              "float s = 0.265 * b + 1.194 * b * b + 5.372 * pow(b, 22); "
              "Ci = chiang_hair_bsdf(N, dPdu, color(1), color(1), color(1), 1.55, v, v / 4, 4 * v, s, s, s, 0.5, color(0.3));");
  const Ref<etendue::Shader> house = make_model(
      "HairShader",
      {{"pigment", Value(std::string("absorption"))}, {"absorption", Value(flat_spectrum(0.3f))}, {"tilt", Value(Number{0})}});
  prepare_tree(*house);
  const Scatter *a = hair->bind(at.p, at.w, at.arena), *b = house->bind(at.p, at.w, at.arena);
  for (const Vector3 in : {Vector3{0.3f, 0.2f, 0.8f}, Vector3{-0.6f, 0.1f, 0.5f}, Vector3{0.2f, -0.5f, -0.7f}}) {
    const Vector3 out = normalize(Vector3{0.4f, 0.3f, 0.7f});
    const Spectrum x = a->evaluate(out, normalize(in)), y = b->evaluate(out, normalize(in));
    for (int i = 0; i < spectrum_size; ++i) EXPECT_NEAR(x[i], y[i], 2e-3f * y[i]);
  }
}

}  // namespace
}  // namespace etendue::osl
