// Rare elements of Mitsuba's scenes: rotations about a zero axis, grids of distances, entities, skies that continue below the
// horizon.

#include <cstring>

#include "mitsuba_support.h"

namespace etendue::mitsuba_test {
namespace {

TEST(MitsubaOddities, NoTurnAboutNoAxis) {
  const auto ball = [](const std::string& angle, const std::string& version) {
    return import_text(
        seen_scene("<shape type=\"sphere\"><transform name=\"to_world\"><rotate x=\"0\" y=\"0\" z=\"0\" angle=\"" + angle +
                       "\"/></transform></shape>",
                   2, version));
  };
  for (const std::string version : {"0.6.0", "3.0.0"}) {
    const Imported none = ball("0", version);
    ASSERT_TRUE(none.job) << none.told();
    EXPECT_TRUE(none.job->scene->objects.at(0)->transform.still().identity());
    // Mitsuba 3.9 refuses such a rotation; before, the result was not finite.
    const Imported some = ball("30", version);
    EXPECT_FALSE(some.job);
    EXPECT_NE(some.told().find("<rotate> needs an axis other than zero"), std::string::npos) << some.told();
  }
}

/// A volume in Mitsuba's format: the distance from the plane x = 0.25 of the unit cube, at 3 x 2 x 2 points.
std::string plane() {
  std::string all = "VOL\3";
  const auto add = [&](auto n) { all.append(reinterpret_cast<const char*>(&n), sizeof n); };
  for (const std::int32_t n : std::initializer_list<std::int32_t>{1, 3, 2, 2, 1}) add(n);
  for (const float x : std::initializer_list<float>{-7, -7, -7, 9, 9, 9}) add(x);  // a bounding box, which is ignored
  for (int i = 0; i < 4; ++i)
    for (const float x : std::initializer_list<float>{-0.5f, 0.5f, 1.5f}) add(x);
  return all;
}

// Grid points reach to the corners of the unit cube, the surface is open where the cube ends, and its front is on the side of
// growing values.
TEST(MitsubaOddities, GridsOfDistances) {
  const TemporaryFolder folder;
  folder.write("plane.vol", plane());
  for (const std::string normals : {"smooth", "analytic"}) {
    const Imported i = import_text(
        folder,
        seen_scene("<shape type=\"sdfgrid\"><string name=\"filename\" value=\"plane.vol\"/><string name=\"normals\" value=\"" +
                   normals + "\"/><transform name=\"to_world\"><scale x=\"2\"/><translate x=\"10\"/></transform></shape>"));
    EXPECT_EQ(i.told(), "");
    ASSERT_TRUE(i.job);
    EXPECT_EQ(i.object(0).class_info().name, "SignedDistanceGrid");
    SceneObject& grid = *i.job->scene->objects.at(0);
    prepare_tree(grid);
    Ray ray;
    ray.origin = {20, 0.3f, 0.6f};
    ray.direction = {-1, 0, 0};
    ray.maximum = infinity;
    Hit hit;
    ASSERT_TRUE(grid.intersect(ray, hit));
    EXPECT_NEAR(hit.distance, 9.5f, 1e-4f);  // at x = 10 + 2 * 0.25
    SurfacePoint p;
    grid.surface_point(ray, hit, p);
    EXPECT_NEAR(p.normal.x, 1, 1e-5f);
    ray.origin.y = 1.1f;
    EXPECT_FALSE(grid.intersect(ray, hit));
    ray.origin = {10.2f, 0.5f, 5};
    ray.direction = {0, 0, -1};
    EXPECT_FALSE(grid.intersect(ray, hit));  // it is open where it ends
  }
  const Imported wrong = import_text(
      folder, seen_scene("<shape type=\"sdfgrid\"><string name=\"filename\" value=\"plane.vol\"/><string name=\"normals\" "
                         "value=\"round\"/></shape>"));
  EXPECT_NE(wrong.told().find("'normals' is smooth or analytic, not 'round'"), std::string::npos) << wrong.told();
}

TEST(MitsubaOddities, Entities) {
  const std::string head =
      "<!DOCTYPE scene [\n<!-- <!ENTITY r \"9\"> -->\n<!ENTITY r \"2\">\n<!ENTITY big '&r;0'>\n"
      "<!ENTITY ball '<shape type=\"sphere\"><float name=\"radius\" value=\"&big;\"/></shape>'>\n]>\n";
  const auto scene_of = [&](const std::string& content, const std::string& declared) {
    return import_text(declared + seen_scene(content));
  };
  const Imported i = scene_of(
      "&ball;<!-- &ball; --><shape type=\"sphere\"><float name=\"radius\" value=\"1&r;\"/></shape>\n"
      "<shape type=\"sphere\"><float name=\"radius\" value=\"x&r;\"/></shape>",
      head);
  // Locations are those in the file as written, before entities are expanded.
  EXPECT_NE(i.told().find("11:50: a number is expected, not 'x2'"), std::string::npos) << i.told();
  const Imported good = scene_of("&ball;<shape type=\"sphere\"><float name=\"radius\" value=\"1&r;\"/></shape>", head);
  EXPECT_NE(good.told().find("3:1: entities that the file declares are put in their places"), std::string::npos) << good.told();
  ASSERT_TRUE(good.job);
  EXPECT_EQ(number(good.object(0), "radius"), 20);
  EXPECT_EQ(number(good.object(1), "radius"), 12);
  EXPECT_NE(scene_of("", "<!DOCTYPE s [<!ENTITY part SYSTEM \"part.xml\">]>").told().find("stands for another file"),
            std::string::npos);
  EXPECT_NE(scene_of("&a;", "<!DOCTYPE s [<!ENTITY a \"&a;\">]>").told().find("more than 16 deep"), std::string::npos);
  std::string bomb = "<!DOCTYPE s [<!ENTITY e0 \"0123456789\">";
  for (int k = 1; k < 14; ++k) {
    const std::string before = "&e" + std::to_string(k - 1) + ";";
    std::string ten;
    for (int n = 0; n < 10; ++n) ten += before;
    bomb += "<!ENTITY e" + std::to_string(k) + " \"" + ten + "\">";
  }
  EXPECT_NE(scene_of("&e13;", bomb + "]>").told().find("amount to more than 64 MB"), std::string::npos);
}

TEST(MitsubaOddities, SkiesBelowTheHorizon) {
  const Imported i =
      import_text(scene("<emitter type=\"sky\"><float name=\"stretch\" value=\"1.5\"/><boolean name=\"extend\" value=\"true\"/>"
                        "</emitter>\n" +
                            sensor() + integrator(),
                        "0.6.0"));
  EXPECT_NE(i.told().find("'stretch' is left out: the sky ends at the horizon"), std::string::npos) << i.told();
  EXPECT_NE(i.told().find("'extend' is left out"), std::string::npos) << i.told();
}

}  // namespace
}  // namespace etendue::mitsuba_test
