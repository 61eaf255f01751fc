// Scenes of Mitsuba as they are found, mostly of version 0.x: with elements in any order, or without them.

#include <cmath>

#include "etendue/language/language.h"
#include "etendue/scene.h"
#include "etendue/volume_shader.h"
#include "mitsuba_support.h"

namespace etendue::mitsuba_test {
namespace {

const std::string lamp = "<emitter type=\"constant\"/>";

Imported old_scene(const std::string& content) {
  return import_text(scene(sensor() + "<integrator type=\"path\"/>" + content, "0.6.0"));
}
std::string name_of(const Component& of, const std::string& member) { return part(of, member).class_info().name; }
std::string word(const Component& of, const std::string& member) {
  const Value value = get(of, member);
  const auto* found = value.as<std::string>();
  return found ? *found : "";
}
std::vector<double> numbers(const Component& of, const std::string& member) {
  const Value value = get(of, member);
  const auto* found = value.as<Numbers>();
  return found ? found->values : std::vector<double>{};
}
bool tells(const Imported& imported, const std::string& words) {
  const bool found = imported.told().find(words) != std::string::npos;
  EXPECT_TRUE(found) << imported.told();
  return found;
}

TEST(MitsubaSurface, AMapMayStandBehindTheBsdfItTilts) {
  const std::string map = "<texture type=\"checkerboard\"/>", bsdf = "<bsdf type=\"plastic\"/>";
  for (const std::string& inside : {map + bsdf, bsdf + map})
    for (const char* type : {"bumpmap", "normalmap"}) {
      const Imported i = import_text(scene(sensor() + integrator() + lamp + "<shape type=\"sphere\"><bsdf type=\"" + type +
                                           "\">" + inside + "</bsdf></shape>"));
      ASSERT_EQ(i.told(), "");
      EXPECT_EQ(name_of(part(i.object(1), "shader"), "shader"), "LossyPlastic");
    }
  EXPECT_TRUE(tells(old_scene("<shape type=\"sphere\"><bsdf type=\"bumpmap\">" + bsdf + "</bsdf></shape>"), "needs a texture"));
}

// Writes a grid of these values along x, in the box from -1 to 1.
void write_grid(const TemporaryFolder& folder, std::initializer_list<float> values) {
  std::string grid = "VOL\3";
  const auto put = [&](auto number) { grid.append(reinterpret_cast<const char*>(&number), sizeof number); };
  for (const int number : {1, int(values.size()), 2, 2, 1}) put(std::int32_t(number));
  for (const float number : {-1.f, -1.f, -1.f, 1.f, 1.f, 1.f}) put(number);
  for (int copies = 0; copies < 4; ++copies)
    for (const float number : values) put(number);
  folder.write("grid.vol", grid);
}
/// The extinction of the medium in the first object, whose object space is world space.
float extinction(const Imported& imported, Point3 p) {
  const Ref<Component> interior = *get(imported.object(0), "interior").as<Ref<Component>>();
  prepare_tree(*interior);
  return dynamic_cast<const VolumeShader&>(*interior).coefficients(p, 0, Wavelengths()).extinction()[0];
}
std::string filled(const std::string& volume_name, const std::string& more) {
  return "<shape type=\"cube\"><bsdf type=\"null\"/><medium name=\"interior\" type=\"heterogeneous\"><volume "
         "type=\"gridvolume\" name=\"" +
         volume_name + "\"><string name=\"filename\" value=\"grid.vol\"/>" + more + "</volume></medium></shape>";
}

TEST(MitsubaMedium, AGridOfVersion0HasItsValuesInTheCornersOfItsFilesBox) {
  const TemporaryFolder folder;
  write_grid(folder, {2, 4, 12});
  const auto imported = [&](const std::string& more) {
    const Imported i =
        import_text(folder, scene(sensor() + "<integrator type=\"volpath\"/>" + filled("density", more) + lamp, "0.6.0"));
    EXPECT_EQ(i.told(), "");
    return i;
  };
  const Imported plain = imported("");
  for (const auto& [x, d] : {std::pair(-0.999f, 2.f), {-0.5f, 3.f}, {0.f, 4.f}, {0.5f, 8.f}, {0.999f, 12.f}})
    EXPECT_NEAR(extinction(plain, {x, 0.99f, -0.99f}), d, 0.02f) << x;
  EXPECT_EQ(extinction(plain, {-1.01f, 0, 0}), 0);
  EXPECT_EQ(extinction(plain, {0, 0, 1.01f}), 0);
  const Imported moved = imported("<point name=\"min\" x=\"0\" y=\"0\" z=\"0\"/><point name=\"max\" x=\"4\" y=\"1\" z=\"1\"/>");
  EXPECT_NEAR(extinction(moved, {1, 0.5f, 0.5f}), 3, 1e-4f);
  EXPECT_EQ(extinction(moved, {-0.1f, 0.5f, 0.5f}), 0);
  EXPECT_NEAR(extinction(imported("<transform name=\"toWorld\"><translate x=\"10\"/></transform>"), {10.5f, 0, 0}), 8, 1e-3f);
}

// As measured in Mitsuba 3.9.1: a grid of density 1 rotated by 45 degrees attenuates light in all of its bounding box.
TEST(MitsubaMedium, ATurnedGridFillsTheBoxAroundIt) {
  const TemporaryFolder folder;
  write_grid(folder, {1, 3});
  const auto imported = [&](const std::string& more) {
    const Imported i =
        import_text(folder, scene(sensor() + integrator(2, "volpath") +
                                  filled("sigma_t",
                                         "<transform name=\"to_world\"><translate x=\"-0.5\" y=\"-0.5\" z=\"-0.5\"/>"
                                         "<rotate z=\"1\" angle=\"45\"/></transform>" +
                                             more)));
    EXPECT_EQ(i.told(), "");
    return i;
  };
  const Imported clamped = imported(""), by_file = imported("<boolean name=\"use_grid_bbox\" value=\"true\"/>");
  EXPECT_NEAR(extinction(clamped, {0.7f, 0.7f, 0}), 3, 1e-4f);  // 0.49 beyond the grid
  EXPECT_NEAR(extinction(clamped, {-0.7f, -0.7f, 0}), 1, 1e-4f);
  EXPECT_EQ(extinction(clamped, {0.72f, 0, 0}), 0);
  EXPECT_EQ(extinction(clamped, {0, 0, 0.51f}), 0);
  EXPECT_GT(extinction(by_file, {-1.4f, -2.1f, 0}), 0.9f);  // its middle is at (0, -1/sqrt 2, -0.5)
  EXPECT_EQ(extinction(by_file, {0, 0.75f, 0}), 0);
  const Imported mirrored = imported("<string name=\"wrap_mode\" value=\"repeat\"/>");
  EXPECT_LT(extinction(mirrored, {0.7f, 0.7f, 0}), 2.9f);
}

TEST(MitsubaMedium, WhatAHomogeneousOneOfVersion0LeavesOutIsMeasured) {
  const auto medium = [](const std::string& inside, const char* version = "0.6.0") {
    const Imported i = import_text(scene(sensor() + integrator() + lamp +
                                             "<shape type=\"sphere\"><medium name=\"interior\" type=\"homogeneous\">" + inside +
                                             "</medium></shape>",
                                         version));
    EXPECT_EQ(i.told(), "");
    return write_description(part(i.object(1), "interior"));
  };
  const std::string ketchup = medium("<string name=\"material\" value=\"KETCHUP\"/><float name=\"scale\" value=\"0.5\"/>");
  EXPECT_NE(ketchup.find("absorption: 0.5 * rgb(6.1, 97, 145)"), std::string::npos) << ketchup;
  EXPECT_NE(ketchup.find("scattering: 0.5 * rgb(18, 7, 3)"), std::string::npos) << ketchup;
  const std::string skin = medium("<rgb name=\"sigmaA\" value=\"1\"/>");
  EXPECT_NE(skin.find("scattering: rgb(74, 88, 101)"), std::string::npos) << skin;
  const std::string scattering = medium("<rgb name=\"sigmaT\" value=\"1\"/>");
  EXPECT_NE(scattering.find("albedo: rgb(0.95854"), std::string::npos) << scattering;  // 0.74 / 0.772
  EXPECT_NE(medium("", "3.0.0").find("extinction: 1"), std::string::npos);
  EXPECT_TRUE(tells(old_scene(lamp + "<shape type=\"sphere\"><medium name=\"interior\" type=\"homogeneous\"><string "
                                     "name=\"material\" value=\"ketchop\"/></medium></shape>"),
                    "there is no measured medium 'ketchop' (did you mean 'Ketchup'?): Skin1 stands for it"));
}

TEST(MitsubaSky, ASunAndASkyOfVersion0AreOne) {
  const std::string towards = "<vector name=\"sunDirection\" x=\"0\" y=\"1\" z=\"-1\"/>";
  const auto light = [&](const std::string& emitters) {
    Imported i = old_scene(
        "<shape type=\"rectangle\"><transform name=\"toWorld\"><scale value=\"10\"/><rotate y=\"1\" "
        "angle=\"180\"/><translate z=\"5\"/></transform></shape>" +
        emitters);
    EXPECT_TRUE(i.job) << i.told();
    i.job->outputs.clear();
    i.job->renderer->samples = 4096;
    return std::pair(i.job->scene->objects.size(), test::measure(i.job).mean.y);
  };
  const auto of = [&](const char* type, const std::string& more = "") {
    return std::string("<emitter type=\"") + type + "\">" + towards + more + "</emitter>";
  };
  const auto [one, sky] = light(of("sky"));
  const auto [two, both] = light(of("sun") + of("sky"));
  const auto [three, sun] = light(of("sun"));
  const auto [four, large] = light(of("sun", "<float name=\"sunRadiusScale\" value=\"8\"/>"));
  EXPECT_EQ(two, 2u);  // the wall and one sky
  EXPECT_GT(sun, 2 * sky);
  EXPECT_NEAR((sky + sun) / both, 1, 0.01);
  EXPECT_NEAR(large / sun, 1, 0.02);
  const Imported dim = old_scene(of("sky") + of("sun", "<float name=\"scale\" value=\"2\"/>"));
  EXPECT_TRUE(tells(dim, "the sun is brightened with its sky"));
}

TEST(MitsubaSky, TheSunOfVersion0StandsWhereDateAndPlaceSay) {
  const auto emission = [](const std::string& more) {
    const Imported i = old_scene("<emitter type=\"sunsky\">" + more + "</emitter>");
    return copy(part(i.object(0), "emission"));
  };
  const std::vector<double> tokyo = numbers(*emission(""), "sun_direction");
  EXPECT_LT(tokyo[0], -0.5);  // three in the afternoon, in July: in the west, high, a little to the south
  EXPECT_GT(tokyo[1], 0.6);
  EXPECT_GT(tokyo[2], 0);
  const std::vector<double> morning = numbers(*emission("<float name=\"hour\" value=\"8\"/>"), "sun_direction");
  EXPECT_GT(morning[0], 0.5);
  EXPECT_NEAR(number(*emission("<float name=\"sunRadiusScale\" value=\"2\"/>"), "sun_diameter"), 2 * 0.5358 * M_PI / 180, 1e-6);
  const Imported three = import_text(
      scene(sensor() + integrator() + "<emitter type=\"sunsky\"><float name=\"sun_aperture\" value=\"3\"/></emitter>"));
  EXPECT_NEAR(number(part(three.object(0), "emission"), "sun_diameter"), 3 * M_PI / 180, 1e-6);
}

TEST(MitsubaMesh, BsdfsOfVersion0AreForTheMaterialsOfAnObjFile) {
  const TemporaryFolder folder;
  folder.write("two.mtl", "newmtl red\nKd 0.8 0.1 0.1\nnewmtl Green\nKd 0.1 0.8 0.1\n");
  folder.write("two.obj",
               "mtllib two.mtl\nv -1 -1 0\nv 0 -1 0\nv 0 1 0\nv 1 -1 0\nusemtl red\nf 1 2 3\nusemtl Green\nf 2 4 3\n");
  const auto parts = [&](const std::string& inside, const char* told) {
    const Imported i =
        import_text(folder, scene(sensor() + "<integrator type=\"path\"/>" + lamp +
                                      "<shape type=\"obj\"><string name=\"filename\" value=\"two.obj\"/>" + inside + "</shape>",
                                  "0.6.0"));
    if (*told)
      tells(i, told);
    else
      EXPECT_EQ(i.told(), "");
    return i;
  };
  const std::string bsdf = "<bsdf name=\"Green\" type=\"plastic\"/>", metal = "<bsdf name=\"red\" type=\"conductor\"/>";
  const Imported named = parts(bsdf + metal, "");
  const auto& group = dynamic_cast<const Scene&>(named.object(1));
  ASSERT_EQ(group.objects.size(), 2u);
  EXPECT_EQ(word(*group.objects[0], "part"), "usemtl red");
  EXPECT_EQ(name_of(*group.objects[0], "shader"), "Conductor");
  EXPECT_EQ(name_of(*group.objects[1], "shader"), "LossyPlastic");
  const Imported by_file = parts("", "materials of OBJ files are read as");
  EXPECT_EQ(dynamic_cast<const Scene&>(by_file.object(1)).objects.size(), 2u);
  EXPECT_EQ(name_of(parts("<bsdf type=\"plastic\"/>", "").object(1), "shader"), "LossyPlastic");
  parts(bsdf + "<bsdf name=\"blue\" type=\"plastic\"/>", "no face of this file has the material 'blue'");
}

TEST(MitsubaSensor, ASphericalOneSeesAllAround) {
  const Imported i =
      import_text(scene("<sensor type=\"spherical\"><film type=\"hdrfilm\"><integer name=\"width\" "
                        "value=\"100\"/><integer name=\"height\" value=\"50\"/></film></sensor><integrator "
                        "type=\"path\"/>" +
                            lamp + "<shape type=\"sphere\"/>",
                        "0.6.0"));
  ASSERT_EQ(i.told(), "");
  i.job->camera->prepare();
  i.job->camera->set_film(100, 50);
  for (const auto& [u, v] : {std::pair(0.1, 0.3), {0.45, 0.5}, {0.8, 0.9}}) {
    const double phi = 2 * M_PI * u, theta = M_PI * v;
    const Vector3 d = i.job->camera->ray({float(100 * u), float(50 * v)}, {}, 0).direction;
    EXPECT_NEAR(d.x, std::sin(phi) * std::sin(theta), 1e-5);
    EXPECT_NEAR(d.y, std::cos(theta), 1e-5);
    EXPECT_NEAR(d.z, -std::cos(phi) * std::sin(theta), 1e-5);
  }
}

}  // namespace
}  // namespace etendue::mitsuba_test
