// Shaders as classes of the description: what is declared, and that it renders.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "etendue/describe/color.h"
#include "etendue/language/language.h"
#include "etendue/object_map.h"
#include "etendue/shader.h"
#include "osl/scene/osl_class.h"

namespace etendue::osl {
namespace {

SurfacePoint front() {
  SurfacePoint p;
  p.normal = p.shading_normal = Normal3{0, 0, 1};
  p.dpdu = {1, 0, 0};
  p.dpdv = {0, 1, 0};
  p.uv = {0.25f, 0.5f};
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

std::string written(const std::string& name, const std::string& text) {
  const std::string path = testing::TempDir() + name;
  std::ofstream(path) << text;
  return path;
}

TEST(OslClasses, HaveTheParametersOfTheShader) {
  Registry::instance().load_plugin(written("test_gloss.osl", R"(
surface test_gloss [[ string help = "Gloss." ]] (
    color paint = color(0.6, 0.1, 0.05) [[ string help = "the paint" ]],
    float polish = 0.25 [[ string help = "how rough", float min = 0, float max = 1 ]],
    int many = 3, string mode = "a" [[ string widget = "popup", string options = "a|b" ]],
    float list[3] = {1, 2, 3}, point at = P)
{ Ci = diffuse(N) * paint * polish; })"));
  const ClassInfo* info = Registry::instance().find("TestGloss");
  ASSERT_TRUE(info);
  EXPECT_EQ(info->summary, "Gloss.");
  ASSERT_TRUE(info->find("polish"));
  EXPECT_EQ(info->find("polish")->text, "how rough");
  EXPECT_EQ(info->find("polish")->range->high, 1);
  EXPECT_EQ(info->find("mode")->choices.size(), 2u);
  EXPECT_TRUE(info->find("list")->list);
  const Ref<etendue::Shader> shader = ref_cast<etendue::Shader>(info->create());
  EXPECT_THROW(set(*shader, "polish", etendue::Value(Number{2.0})), Error);
  set(*shader, "polish", etendue::Value(Number{0.5}));
  set(*shader, "paint", etendue::Value(rgb_color("srgb", 0.4, 0.4, 0.4)));
  prepare_tree(*shader);
  Arena arena;
  const Scatter* s = shader->bind(front(), visible(), arena);
  ASSERT_TRUE(s);
  EXPECT_NEAR(s->albedo({0, 0, 1})[0], 0.2f, 1e-4f);
}

TEST(OslClasses, OutputsAreMaps) {
  Registry::instance().load_plugin(written("test_pattern.osl",
                                           "shader test_pattern(float k = 2, output float a = 0, output color c = 0) "
                                           "{ a = k * u; c = color(v, 0, 0); }"));
  const Ref<ObjectMap> map = ref_cast<ObjectMap>(Registry::instance().create("TestPattern"));
  prepare_tree(*map);
  EXPECT_FLOAT_EQ(map->scalar(front()), 0.5f);
  set(*map, "output", etendue::Value(std::string("c")));
  prepare_tree(*map);
  EXPECT_NEAR(map->scalar(front()), 0.5f / 3, 1e-6f);
}

TEST(OslClasses, MapsAreFinite) {
  Registry::instance().load_plugin(
      written("test_overflow.osl", "shader test_overflow(output float a = 0) { a = sin(1e30 * 1e30 * (1 + u)); }"));
  const Ref<ObjectMap> map = ref_cast<ObjectMap>(Registry::instance().create("TestOverflow"));
  prepare_tree(*map);
  EXPECT_EQ(map->scalar(front()), 0);
  EXPECT_EQ(map->color(front(), visible(), ColorUse::reflectance)[0], 0);
}

// The render that is asked to end must not wait for a point that never does.
/// The left pixel is red, the right one blue; (0, 0) of a texture is its upper left corner.
TEST(OslClasses, LookTexturesUp) {
  const std::string image = written("test_pixels.ppm", std::string("P6\n2 1\n255\n") + "\xff" + std::string(4, '\0') + "\xff");
  const std::string file = "\"" + image + "\"";
  Registry::instance().load_plugin(
      written("test_texture.osl",
              "shader test_texture(output float red = 0, output float width = 0, output float blue = 0) { "
              "int r[2] = {0, 0}; gettextureinfo(" +
                  file + ", \"resolution\", r); width = r[0]; red = texture(" + file +
                  ", u, v, \"interp\", \"closest\"); blue = texture(" + file +
                  ", u + 0.5, v, \"interp\", \"closest\", \"firstchannel\", 2); }"));
  const Ref<ObjectMap> map = ref_cast<ObjectMap>(Registry::instance().create("TestTexture"));
  for (const auto& [output, wanted] : std::map<std::string, float>{{"red", 1}, {"width", 2}, {"blue", 1}}) {
    set(*map, "output", etendue::Value(output));
    prepare_tree(*map);
    EXPECT_FLOAT_EQ(map->scalar(front()), wanted) << output;
  }
}

// Object space is that of the point's object, turned and scaled, and back.
TEST(OslClasses, ObjectSpaceIsThatOfTheObject) {
  Registry::instance().load_plugin(
      written("test_spaces.osl",
              "shader test_spaces(output float off = 1) { point there = transform(\"object\", P); "
              "off = length(there - point(1, 0, 0)) + length(transform(\"object\", \"world\", there) - P) + "
              "length(transform(\"object\", vector(0, 2, 0)) - vector(1, 0, 0)); }"));
  const Ref<SceneObject> object = ref_cast<SceneObject>(
      parse_component("Sphere { transform: translate(1 m, 2 m, 3 m) * rotate(90 deg, \"z\") * scale(2), radius: 1 m }"));
  prepare_tree(*object);
  SurfacePoint p = front();
  p.object = object.get();
  p.position = {1, 4, 3};  // the ball's point (1, 0, 0)
  p.object_position = {1, 0, 0};
  const Ref<ObjectMap> map = ref_cast<ObjectMap>(Registry::instance().create("TestSpaces"));
  prepare_tree(*map);
  EXPECT_NEAR(map->scalar(p), 0, 1e-5f);
}

// A texture lies beside the shader that names it, or beside the scene; what is found nowhere is told with the places.
TEST(OslClasses, FindTexturesBesideTheShader) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "beside_shader";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "beside.ppm") << std::string("P6\n1 1\n255\n") + "\xff" + std::string(2, '\0');
  const std::string file = (folder / "test_beside.osl").string();
  std::ofstream(file)
      << "shader test_beside(output float red = 0, output float there = 0, output float missing = 0) { int there_is = 0; "
         "gettextureinfo(\"beside.ppm\", \"exists\", there_is); there = there_is; "
         "red = texture(\"beside.ppm\", u, v, \"interp\", \"closest\"); missing = texture(\"nowhere.ppm\", u, v); }";
  Registry::instance().load_plugin(file);
  const Ref<ObjectMap> map = ref_cast<ObjectMap>(Registry::instance().create("TestBeside"));
  testing::internal::CaptureStderr();  // told once
  for (const char* output : {"red", "there"}) {
    set(*map, "output", etendue::Value(std::string(output)));
    prepare_tree(*map);
    EXPECT_FLOAT_EQ(map->scalar(front()), 1) << output;
  }
  set(*map, "output", etendue::Value(std::string("missing")));
  prepare_tree(*map);
  EXPECT_EQ(map->scalar(front()), 0);
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find("there is no file 'nowhere.ppm' in '" + folder.string() + "'"), std::string::npos) << said;
}

// The value of a member may be a map in which another shader runs: the closures that were made before are still there.
TEST(OslClasses, AShaderThatRunsWithinAnotherLeavesItsClosures) {
  Registry::instance().load_plugin(written("test_inner.osl",
                                           "shader test_inner(output float a = 0) { closure color c = 0.125 * emission(); "
                                           "for (int i = 0; i < 50; ++i) c += 0.5 * translucent(N); if (c) a = 0.5; }"));
  Registry::instance().load_plugin(
      written("test_outer.osl", "surface test_outer(float amount = 1) { closure color c = diffuse(N); Ci = amount * c; }"));
  const Ref<Component> inner = Registry::instance().create("TestInner"), mixed = Registry::instance().create("MultiplyMap");
  set(*mixed, "first", etendue::Value(inner));
  set(*mixed, "second", etendue::Value(inner));
  const Ref<etendue::Shader> shader = ref_cast<etendue::Shader>(Registry::instance().create("TestOuter"));
  set(*shader, "amount", etendue::Value(mixed));
  prepare_tree(*shader);
  Arena arena;
  const Scatter* s = shader->bind(front(), visible(), arena);
  ASSERT_TRUE(s);
  EXPECT_EQ(s->lobes(), diffuse_reflection);
}

// What the reader of Shader::albedo_error may rely on.
TEST(OslClasses, TellHowExactTheirAlbedoIs) {
  const auto error_of = [](const std::string& name, const std::string& body) {
    Registry::instance().load_plugin(written(name + ".osl", "surface " + name + "(float x = 0.5) { Ci = " + body + "; }"));
    const Ref<etendue::Shader> shader =
        ref_cast<etendue::Shader>(Registry::instance().create("Albedo" + std::string(1, char(std::toupper(name.back())))));
    prepare_tree(*shader);
    return shader->albedo_error();
  };
  EXPECT_EQ(error_of("albedo_a", "x * diffuse(N)"), 0);
  EXPECT_EQ(error_of("albedo_b", "mix(diffuse(N), reflection(N, 1.5), x)"), 0);
  EXPECT_FLOAT_EQ(error_of("albedo_c", "oren_nayar(N, x)"), 0.01f);
  EXPECT_EQ(error_of("albedo_d", "dielectric_bsdf(N, dPdu, color(1), color(1), 0, 0, 1.5, \"ggx\")"), 0);
  EXPECT_FLOAT_EQ(error_of("albedo_e", "dielectric_bsdf(N, dPdu, color(1), color(1), x, x, 1.5, \"ggx\")"), 0.15f);
  EXPECT_FLOAT_EQ(error_of("albedo_f", "diffuse(N) + phong(N, 5)"), 0.3f);
}

TEST(OslClasses, AnEndlessShaderIsAnErrorAtItsLoop) {
  Registry::instance().load_plugin(
      written("test_endless.osl", "surface test_endless(int k = 1)\n{\n  while (k > 0) { }\n  Ci = diffuse(N);\n}\n"));
  const Ref<etendue::Shader> shader = ref_cast<etendue::Shader>(Registry::instance().create("TestEndless"));
  prepare_tree(*shader);
  Arena arena;
  try {
    shader->bind(front(), visible(), arena);
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.location.line, 3);
  }
}

TEST(OslClasses, AreReadAgainWhenTheirFileChanges) {
  const std::string first = "shader test_edited(output float a = 0) { a = 1; }",
                    second = "shader test_edited(float more = 5, output float a = 0) { a = more; }";
  const std::string file = written("test_edited.osl", first);
  Registry::instance().load_plugin(file);
  EXPECT_FALSE(Registry::instance().find("TestEdited")->find("more"));
  written("test_edited.osl", second);
  Registry::instance().load_plugin(file);
  EXPECT_TRUE(Registry::instance().find("TestEdited")->find("more"));
}

TEST(OslClasses, FaultsHaveTheirPlace) {
  const std::string file = written("test_fault.osl", "surface test_fault()\n{\n  Ci = diffuse(Q);\n}\n");
  try {
    Registry::instance().load_plugin(file);
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("test_fault.osl:3"), std::string::npos) << e.what();
  }
}

TEST(OslClasses, SumsOfSaturatedColoursReflectNoMoreThanAllLight) {
  Registry::instance().load_plugin(ETENDUE_SOURCE_DIR "/scenes/osl/car_paint.osl");
  const Ref<etendue::Shader> shader = ref_cast<etendue::Shader>(Registry::instance().create("CarPaint"));
  prepare_tree(*shader);
  Arena arena;
  const Scatter* s = shader->bind(front(), visible(), arena);
  ASSERT_TRUE(s);
  EXPECT_LE(s->albedo({0, 0, 1}).maximum(), 1.001f);
}

}  // namespace
}  // namespace etendue::osl
