// Shapes, media and settings of Mitsuba whose conventions were found by comparing pictures with PyPI's mitsuba 3.9.

#include <cmath>
#include <cstring>

#include "mitsuba_support.h"

namespace etendue::mitsuba_test {
namespace {

const std::string sky = "<emitter type=\"constant\"/>";

/// A square of 2 m at z = 5 as a mesh, whose triangles are oriented so that their normals point along +z, away from the camera.
const std::string square = "v -1 -1 5\nv 1 -1 5\nv 1 1 5\nv -1 1 5\nf 1 2 3\nf 1 3 4\n";

std::string mesh(const std::string& more) {
  return "<shape type=\"obj\"><string name=\"filename\" value=\"square.obj\"/>" + more +
         "<emitter type=\"area\"><spectrum name=\"radiance\" value=\"1\"/></emitter></shape>";
}

TEST(MitsubaMesh, NormalsOfTrianglesAreThoseInTheWorld) {
  const TemporaryFolder folder;
  folder.write("square.obj", square);
  folder.write("normals.obj", square);
  const std::string mirror = "<transform name=\"to_world\"><scale x=\"-1\"/></transform>";
  const auto light = [&](const std::string& more) {
    return seen(import_text(folder, scene(sensor() + integrator() + mesh(more)))).y;
  };
  EXPECT_NEAR(light(""), 0, 1e-6);
  EXPECT_NEAR(light(mirror), 1, 0.01);  // the orientation of the triangles is reversed
  EXPECT_NEAR(light(mirror + "<boolean name=\"face_normals\" value=\"true\"/>"), 1, 0.01);
  EXPECT_NEAR(light("<boolean name=\"flip_normals\" value=\"true\"/>"), 1, 0.01);
  // Vertex normals are transformed like the surface.
  std::string with_normals = square;
  with_normals.replace(with_normals.find("f 1"), std::string::npos, "vn 0 0 1\nf 1//1 2//1 3//1\nf 1//1 3//1 4//1\n");
  folder.write("square.obj", with_normals);
  EXPECT_NEAR(light(mirror), 0, 1e-6);
}

TEST(MitsubaCurve, RadiiAreNotScaled) {
  const TemporaryFolder folder;
  folder.write("curve.txt", "-50 0 5 0.2\n-20 0 5 0.2\n20 0 5 0.2\n50 0 5 0.2\n60 0 5 0.2\n");
  // Of parallel rays over 2 x 2 m, those within a width of 0.4 m hit the curve: the transform makes it shorter, not thinner.
  const std::string camera =
      "<sensor type=\"orthographic\"><film type=\"hdrfilm\"><integer name=\"width\" value=\"1\"/><integer name=\"height\" "
      "value=\"1\"/><rfilter type=\"box\"/></film></sensor>";
  const std::string curve =
      "<shape type=\"bsplinecurve\"><string name=\"filename\" value=\"curve.txt\"/><transform name=\"to_world\"><scale "
      "value=\"0.5\"/></transform><bsdf type=\"diffuse\"><spectrum name=\"reflectance\" value=\"0\"/></bsdf></shape>";
  EXPECT_NEAR(seen(import_text(folder, scene(camera + integrator() + curve + sky)), 16384).y, 0.8, 0.01);
}

TEST(MitsubaCurve, HairsThatAreLeftOutThereAreTold) {
  const TemporaryFolder folder;
  folder.write("strands.hair", "0 0 0\n0 1 0\n");
  const Imported i = import_text(folder, scene(sensor() + integrator() + sky +
                                               "<shape type=\"hair\"><string name=\"filename\" value=\"strands.hair\"/><float "
                                               "name=\"reduction\" value=\"0.5\"/></shape>"));
  EXPECT_NE(i.told().find("all hairs are there"), std::string::npos) << i.told();
}

TEST(MitsubaCurve, BinaryHair) {
  const TemporaryFolder folder;
  std::string bytes = "BINARY_HAIR";
  const auto put = [&](const auto& value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof value);
  };
  put(std::uint32_t(5));
  const float points[5][3] = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {1, 2, 0}};
  for (int i = 0; i < 5; ++i) {
    if (i == 0 || i == 2) put(INFINITY);
    for (const float x : points[i]) put(x);
  }
  const auto imported = [&](const std::string& contents) {
    folder.write("strands.hair", contents);
    return import_text(folder, scene(sensor() + integrator() + sky +
                                     "<shape type=\"hair\"><string name=\"filename\" value=\"strands.hair\"/></shape>"));
  };
  const Imported whole = imported(bytes);
  ASSERT_TRUE(whole.job) << whole.told();
  const Value counts = get(whole.object(1), "counts");  // object 0 is the sky
  ASSERT_TRUE(counts.as<Numbers>());
  EXPECT_EQ(counts.as<Numbers>()->values, (std::vector<double>{2, 3}));
  EXPECT_NE(imported(bytes.substr(0, bytes.size() - 3)).told().find("ends too early"), std::string::npos);
}

TEST(MitsubaMedium, ConstantVolumesAreNumbers) {
  const std::string medium =
      "<medium name=\"interior\" type=\"homogeneous\"><volume type=\"constvolume\" name=\"sigma_t\"><float name=\"value\" "
      "value=\"0.5\"/></volume><volume type=\"constvolume\" name=\"albedo\"><float name=\"value\" "
      "value=\"0\"/></volume></medium>";
  const std::string ball = "<shape type=\"sphere\"><point name=\"center\" z=\"5\"/><bsdf type=\"null\"/>" + medium + "</shape>";
  EXPECT_NEAR(seen(import_text(scene(sensor() + integrator(-1, "volpath") + ball + sky))).y, std::exp(-1.0), 0.01);
}

TEST(MitsubaSettings, AreTakenOrTold) {
  const std::string chain = "<integrator type=\"pssmlt\"><integer name=\"max_depth\" value=\"7\"/></integrator>";
  const Imported read = import_text(scene(sensor() + chain + sky));
  ASSERT_TRUE(read.job) << read.told();
  EXPECT_EQ(number(part(*read.job->renderer, "inner"), "max_depth"), 7);
  std::string seeded = sensor();
  seeded.replace(seeded.find("<integer name=\"sample_count\""), 0, "<integer name=\"seed\" value=\"5\"/>");
  EXPECT_EQ(import_text(scene(seeded + integrator() + sky)).job->seed, 5u);
  std::string film = sensor();
  film.replace(film.find("<rfilter"), 0,
               "<string name=\"pixel_format\" value=\"rgba\"/><string name=\"file_format\" value=\"pfm\"/><string "
               "name=\"component_format\" value=\"uint32\"/>");
  const std::string told = import_text(scene(film + integrator() + sky)).told();
  for (const char* word : {"alpha", "'pfm'", "'uint32'"}) EXPECT_NE(told.find(word), std::string::npos) << told;
}

TEST(MitsubaSurface, TablesOfAMetalGoOnAtTheirEnds) {
  const std::string metal =
      "<bsdf type=\"conductor\"><spectrum name=\"eta\" value=\"400:0.2, 700:0.2\"/><spectrum name=\"k\" value=\"400:3, "
      "700:3\"/>"
      "</bsdf>";
  const std::string wall =
      "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"10\"/><rotate y=\"1\" angle=\"180\"/><translate "
      "z=\"5\"/></transform>" +
      metal + "</shape>";
  const double straight_on = ((0.2 - 1) * (0.2 - 1) + 9) / ((0.2 + 1) * (0.2 + 1) + 9);
  EXPECT_NEAR(seen(import_text(scene(sensor() + integrator() + wall + sky))).y, straight_on, 0.01);
}

}  // namespace
}  // namespace etendue::mitsuba_test
