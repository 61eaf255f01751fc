// Networks of shaders in descriptions: maps as values of parameters, and OslGroup.

#include <gtest/gtest.h>

#include <fstream>

#include "etendue/describe/color.h"
#include "etendue/object_map.h"
#include "etendue/shader.h"

namespace etendue::osl {
namespace {

SurfacePoint at(float u, float v) {
  SurfacePoint p;
  p.normal = p.shading_normal = Normal3{0, 0, 1};
  p.dpdu = {1, 0, 0};
  p.dpdv = {0, 1, 0};
  p.uv = {u, v};
  return p;
}
Wavelengths visible() {
  std::array<float, spectrum_size> lambda, pdf;
  for (size_t i = 0; i < spectrum_size; ++i) {
    lambda[i] = 400 + 40 * float(i);
    pdf[i] = 1 / 470.0f;
  }
  return Wavelengths(lambda, pdf);
}

void declare(const std::string& name, const std::string& text) {
  const std::string path = testing::TempDir() + name + ".osl";
  std::ofstream(path) << text;
  Registry::instance().load_plugin(path);
}
Ref<Component> made(const std::string& name, std::initializer_list<std::pair<const char*, etendue::Value>> members = {}) {
  Ref<Component> c = Registry::instance().create(name);
  for (const auto& [member, value] : members) set(*c, member, value);
  return c;
}
etendue::Value part(const Ref<Component>& c) { return etendue::Value(c); }
etendue::Value text(const char* t) { return etendue::Value(std::string(t)); }
etendue::Value list(std::vector<etendue::Value> entries) { return etendue::Value(etendue::Value::List(std::move(entries))); }
float scalar_of(const Ref<Component>& map, const SurfacePoint& p) {
  prepare_tree(*map);
  return ref_cast<ObjectMap>(map)->scalar(p);
}
Spectrum albedo_of(const Ref<Component>& shader) {
  prepare_tree(*shader);
  static Arena arena;
  const Scatter* s = ref_cast<etendue::Shader>(shader)->bind(at(0.25f, 0.5f), visible(), arena);
  return s ? s->albedo({0, 0, 1}) : Spectrum();
}
std::string fault_of(const Ref<Component>& c) {
  try {
    prepare_tree(*c);
  } catch (const Error& e) {
    return e.what();
  }
  return "no fault";
}

class OslNetworks : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    declare("net_ramp",
            "shader net_ramp(float k = 1, output float f = 0, output color c = 0) { f = k * u; c = color(f, v, 0); }");
    declare("net_look",
            "shader net_look(float x = 0.5, color c = 0.5, output float f = 0, output int linked = 0, output float "
            "green = 0) { f = x; linked = isconnected(x); green = c[1]; }");
    declare("net_red", "shader net_red(output closure color out = 0) { out = color(0.5, 0, 0) * diffuse(N); }");
    declare("net_grey", "shader net_grey(float r = 0.25, output closure color out = 0) { out = r * diffuse(N); }");
    declare("net_mix",
            "surface net_mix(closure color a = 0, closure color b = 0, float amount = 0.5) "
            "{ Ci = amount * a + (1 - amount) * b; }");
  }
};

TEST_F(OslNetworks, AMapThatIsAnOutputIsConnected) {
  const Ref<Component> look = made("NetLook", {{"x", part(made("NetRamp", {{"k", etendue::Value(Number{2.0})}}))}});
  EXPECT_FLOAT_EQ(scalar_of(look, at(0.25f, 0)), 0.5f);
  set(*look, "output", text("linked"));
  EXPECT_EQ(scalar_of(look, at(0, 0)), 1);
}

TEST_F(OslNetworks, OtherMapsAreAskedForTheirValues) {
  const std::string image = testing::TempDir() + "net_pixels.ppm";
  std::ofstream(image, std::ios::binary) << std::string("P6\n2 1\n255\n") + "\xff" + std::string(3, '\0') + "\xff" + '\0';
  const Ref<Component> map = made("ImageMap", {{"file", text(image.c_str())}, {"interpolation", text("nearest")}});
  const Ref<Component> look = made("NetLook", {{"x", part(map)}, {"c", part(map)}});
  EXPECT_NEAR(scalar_of(look, at(0.2f, 0.5f)), 1 / 3.0f, 1e-5f);
  set(*look, "output", text("green"));
  EXPECT_FLOAT_EQ(scalar_of(look, at(0.2f, 0.5f)), 0);
  EXPECT_FLOAT_EQ(scalar_of(look, at(0.8f, 0.5f)), 1);
  // In other primaries: ITU-R BT.2087 has 1.1329 for the green of BT.2020 in those of sRGB.
  set(*map, "color_space", text("rec2020"));
  EXPECT_NEAR(scalar_of(look, at(0.8f, 0.5f)), 1.1329f, 1e-3f);
}

TEST_F(OslNetworks, EachObjectHasValuesOfItsOwn) {
  const Ref<Component> one = made("NetLook"), other = made("NetLook");
  set(*get(*one, "x").as<Ref<Component>>()->get(), "value", etendue::Value(Number{0.125}));
  EXPECT_FLOAT_EQ(scalar_of(one, at(0, 0)), 0.125f);
  EXPECT_FLOAT_EQ(scalar_of(other, at(0, 0)), 0.5f);
}

TEST_F(OslNetworks, LayersAndConnectionsAndTheirText) {
  const Ref<Component> group =
      made("OslGroup", {{"layers", list({part(made("NetRed")), part(made("NetGrey")), part(made("NetRamp"))})},
                        {"surface", part(made("NetMix"))},
                        {"connections", list({text("net_red.out -> net_mix.a"), text("net_grey.out->net_mix.b"),
                                              text("net_ramp.f -> net_mix.amount")})}});
  const Ref<Component> as_text =
      made("OslGroup", {{"text", text("param float r 0.25 ; shader net_grey grey ; shader net_red red ; shader net_ramp ramp ; "
                                      "shader net_mix mixed ; connect red.out mixed.a ; connect grey.out mixed.b ; "
                                      "connect ramp.f mixed.amount ;")}});
  const Spectrum a = albedo_of(group), b = albedo_of(as_text);
  EXPECT_NEAR(a[0], 0.75f * 0.25f, 0.02f);  // blue: the grey alone
  EXPECT_GT(a[7], a[0] + 0.1f);             // red
  for (int i = 0; i < spectrum_size; ++i) EXPECT_EQ(a[i], b[i]);
}

TEST_F(OslNetworks, AnOutputOfAGroupIsAMap) {
  const Ref<Component> group = made("OslGroupMap", {{"layers", list({part(made("NetRamp"))})},
                                                    {"map", part(made("NetLook"))},
                                                    {"output", text("green")},
                                                    {"connections", list({text("net_ramp.c -> net_look.c")})}});
  EXPECT_FLOAT_EQ(scalar_of(group, at(0, 0.75f)), 0.75f);
}

TEST_F(OslNetworks, Faults) {
  const auto group = [](const char* connection) {
    return made("OslGroup", {{"layers", list({part(made("NetRed"))})},
                             {"surface", part(made("NetMix"))},
                             {"connections", list({text(connection)})}});
  };
  EXPECT_NE(fault_of(group("red.out -> net_mix.a")).find("no layer 'red'; there are net_red, net_mix"), std::string::npos);
  EXPECT_NE(fault_of(group("net_red.out net_mix.a")).find("as in"), std::string::npos);
  EXPECT_NE(fault_of(group("net_red.nothing -> net_mix.a")).find("nothing"), std::string::npos);
  EXPECT_NE(fault_of(group("net_red.out -> net_mix.amount")).find("cannot connect"), std::string::npos);
  EXPECT_NE(fault_of(group("net_mix.amount -> net_red.out")).find("gives the result"), std::string::npos);
  const auto with_text = [](const char* t) { return fault_of(made("OslGroup", {{"text", text(t)}})); };
  EXPECT_NE(with_text("shader nowhere a ;").find("no shader 'nowhere'"), std::string::npos);
  EXPECT_NE(with_text("param float wrong 2 ; shader net_mix a ;").find("nonexistent parameter: wrong"), std::string::npos);
  EXPECT_NE(with_text("layer net_mix a ;").find("line 1, column 1"), std::string::npos);
  EXPECT_NE(fault_of(made("OslGroup", {{"layers", list({part(made("NetRed"))})}})).find("is needed"), std::string::npos);
}

}  // namespace
}  // namespace etendue::osl
