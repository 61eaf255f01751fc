// Media around the cameras of pbrt and Mitsuba: by Beer's law, by Mitsuba's own numbers, and where a body holds them already.

#include <fmt/format.h>

#include "mitsuba_support.h"
#include "pbrt_support.h"

namespace etendue {
namespace {

using mitsuba_test::integrator;
using mitsuba_test::sensor;

mitsuba_test::Imported mitsuba(const std::string& content, const std::string& of_sensor = "<ref id=\"fog\"/>",
                               const std::string& type = "volpath") {
  const std::string fog =
      "<medium type=\"homogeneous\" id=\"fog\"><spectrum name=\"sigma_t\" value=\"0.5\"/><float name=\"albedo\" value=\"0\"/>"
      "</medium>\n";
  return mitsuba_test::import_text(
      mitsuba_test::scene(fog + sensor("<float name=\"fov\" value=\"1\"/>" + of_sensor) + integrator(4, type) + content));
}
pbrt_test::Imported pbrt(const std::string& content, const std::string& integrator = "volpath") {
  return pbrt_test::import_text(pbrt_test::v4(content, "", "\"float fov\" 1",
                                              "Integrator \"" + integrator +
                                                  "\" \"integer maxdepth\" 3\nMakeNamedMedium \"fog\" \"string type\" "
                                                  "\"homogeneous\" \"spectrum sigma_a\" [300 .5 900 .5] "
                                                  "\"spectrum sigma_s\" [300 0 900 0]\nMediumInterface \"\" \"fog\"\n"));
}
std::string m_lamp(double z) {
  return fmt::format(
      "<shape type=\"rectangle\"><transform name=\"to_world\"><rotate y=\"1\" angle=\"180\"/><translate z=\"{}\"/></transform>"
      "<emitter type=\"area\"><spectrum name=\"radiance\" value=\"1\"/></emitter></shape>\n",
      z);
}
std::string p_lamp(double z) {
  return fmt::format(
      "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"bool twosided\" true\nTranslate 0 0 {}\nShape "
      "\"bilinearmesh\" \"point3 P\" [-1 -1 0 1 -1 0 -1 1 0 1 1 0]\nAttributeEnd\n",
      z);
}
std::string m_ball(double z, double radius, const std::string& bsdf, const std::string& media) {
  return fmt::format(
      "<shape type=\"sphere\"><point name=\"center\" z=\"{}\"/><float name=\"radius\" value=\"{}\"/>{}{}</shape>\n", z, radius,
      bsdf, media);
}
std::string p_ball(double z, double radius, const std::string& material, const std::string& media) {
  return fmt::format(
      "AttributeBegin\nMediumInterface {}\nMaterial {}\nTranslate 0 0 {}\nShape \"sphere\" \"float radius\" {}\n"
      "AttributeEnd\n",
      media, material, z, radius);
}
const std::string
    null_bsdf = "<bsdf type=\"null\"/>",
    as_air = "<bsdf type=\"dielectric\"><float name=\"int_ior\" value=\"1\"/><float name=\"ext_ior\" value=\"1\"/></bsdf>",
    interior = "<ref name=\"interior\" id=\"fog\"/>", exterior = "<ref name=\"exterior\" id=\"fog\"/>";

template <class Imported>
size_t surroundings(const Imported& i) {
  size_t n = 0;
  for (const Ref<SceneObject>& o : i.job->scene->objects) n += o->surrounds();
  return n;
}

struct Case {
  const char* what;
  std::string m, p;
  double wanted;
  size_t surroundings = 1;
};

TEST(MediumAroundTheCamera, WeakensLightOnItsWholeWay) {
  const Case cases[] = {
      {"fog alone", m_lamp(4), p_lamp(4), std::exp(-0.5 * 4)},
      {"a ball of nothing in it, 2 m through", m_lamp(4) + m_ball(2, 1, null_bsdf, exterior),
       p_lamp(4) + p_ball(2, 1, "\"interface\"", "\"\" \"fog\""), std::exp(-0.5 * 2)},
      {"a ball that names no media: the fog goes on in it", m_lamp(4) + m_ball(2, 1, null_bsdf, ""),
       p_lamp(4) + p_ball(2, 1, "\"interface\"", "\"\" \"\""), std::exp(-0.5 * 4)},
      {"a ball that is filled with it", m_lamp(4) + m_ball(2, 1, null_bsdf, interior + exterior),
       p_lamp(4) + p_ball(2, 1, "\"interface\"", "\"fog\" \"fog\""), std::exp(-0.5 * 4)},
      {"a body around the camera, which ends 1 m away, nothing beyond", m_lamp(4) + m_ball(-1, 2, null_bsdf, interior),
       p_lamp(4) + p_ball(-1, 2, "\"interface\"", "\"fog\" \"\""), std::exp(-0.5 * 1), 0},
  };
  for (const Case& c : cases) {
    const auto m = mitsuba(c.m);
    ASSERT_EQ(m.told(), "") << c.what;
    EXPECT_EQ(surroundings(m), c.surroundings) << c.what;
    EXPECT_NEAR(mitsuba_test::seen(m, 256).y, c.wanted, 2e-3) << c.what;
    const auto p = pbrt(c.p);
    ASSERT_EQ(p.told(), "") << c.what;
    EXPECT_EQ(surroundings(p), c.surroundings) << c.what;
    EXPECT_NEAR(pbrt_test::seen(p, 256).y, c.wanted, 2e-3) << c.what;
  }
}

TEST(MediumAroundTheCamera, IsToldWhereItIsNotTheSame) {
  const std::string sky_m = "<emitter type=\"constant\"/>", sky_p = "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";
  const auto says = [](const std::string& told, const char* words) { return told.find(words) != std::string::npos; };
  for (const std::string& told : {mitsuba(sky_m).told(), pbrt(sky_p).told()})
    EXPECT_TRUE(says(told, "twice the radius")) << told;
  // A body of the medium that does not contain the camera.
  for (const std::string& told : {mitsuba(m_lamp(4) + m_ball(2, 1, null_bsdf, interior)).told(),
                                  pbrt(p_lamp(4) + p_ball(2, 1, "\"interface\"", "\"fog\" \"\"")).told()})
    EXPECT_TRUE(says(told, "goes on for ever")) << told;
  // Integrators that ignore media.
  for (const std::string& told : {mitsuba(m_lamp(4), "<ref id=\"fog\"/>", "path").told(), pbrt(p_lamp(4), "path").told()})
    EXPECT_TRUE(says(told, "is left out, as")) << told;
  // A medium that is used nowhere.
  EXPECT_TRUE(says(mitsuba(m_lamp(4) + m_ball(2, 1, null_bsdf, exterior), "").told(), "neither around the sensor"));
}

TEST(MediumAroundTheCamera, OnAGridFillsTheBoxOfTheGrid) {
  // Density 1 in a box from z = 1 to z = 3, through which the ray passes.
  const TemporaryFolder folder;
  std::string grid = "VOL\3";
  for (const std::int32_t number : {1, 1, 1, 1, 1}) grid.append(reinterpret_cast<const char*>(&number), 4);
  for (const float number : {-1.f, -1.f, 1.f, 1.f, 1.f, 3.f, 1.f}) grid.append(reinterpret_cast<const char*>(&number), 4);
  folder.write("grid.vol", grid);
  for (const bool named : {true, false}) {
    const std::string place = named
                                  ? "<boolean name=\"use_grid_bbox\" value=\"true\"/>"
                                  : "<transform name=\"to_world\"><scale x=\"2\" y=\"2\" z=\"2\"/><translate x=\"-1\" y=\"-1\" "
                                    "z=\"1\"/></transform>";
    const auto m = mitsuba_test::import_text(
        folder, mitsuba_test::scene(
                    "<medium type=\"heterogeneous\" id=\"fog\"><volume type=\"gridvolume\" name=\"sigma_t\"><string "
                    "name=\"filename\" value=\"grid.vol\"/>" +
                    place + "</volume><float name=\"albedo\" value=\"0\"/><float name=\"scale\" value=\"0.5\"/></medium>" +
                    sensor("<float name=\"fov\" value=\"1\"/><ref id=\"fog\"/>") + integrator(4, "volpath") + m_lamp(4)));
    ASSERT_EQ(m.told(), "");
    EXPECT_NEAR(mitsuba_test::seen(m, 1 << 16).y, std::exp(-0.5 * 2), 5e-3);
  }
  const auto p = pbrt_test::import_text(pbrt_test::v4(p_lamp(4), "", "\"float fov\" 1",
                                                      "Integrator \"volpath\"\nMakeNamedMedium \"fog\" \"string type\" "
                                                      "\"uniformgrid\" \"point3 p0\" [-1 -1 1] \"point3 p1\" [1 1 3] "
                                                      "\"spectrum sigma_a\" [300 .5 900 .5] \"spectrum sigma_s\" [300 0 900 0] "
                                                      "\"float density\" [1 1 1 1 1 1 1 1] \"integer nx\" 2 "
                                                      "\"integer ny\" 2 \"integer nz\" 2\nMediumInterface \"\" \"fog\"\n"));
  ASSERT_EQ(p.told(), "");
  // Its density falls to a half within the outer quarters: an eighth of it is missing.
  EXPECT_NEAR(pbrt_test::seen(p, 1 << 16).y, std::exp(-0.5 * 2 * 0.875), 5e-3);
}

}  // namespace
}  // namespace etendue
