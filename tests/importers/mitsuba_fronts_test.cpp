// Which side of a mesh is its front in Mitsuba, and meshes whose medium would lie outside.

#include <cmath>

#include "mitsuba_support.h"

namespace etendue::mitsuba_test {
namespace {

const std::string sky = "<emitter type=\"constant\"/>";
const std::string flat = "<boolean name=\"face_normals\" value=\"true\"/>";
const std::string flip = "<boolean name=\"flip_normals\" value=\"true\"/>";

std::string mesh(const std::string& content) {
  return "<shape type=\"obj\"><string name=\"filename\" value=\"mesh.obj\"/>" + content + "</shape>";
}

// A square whose normals point to the camera; from there its first triangle is clockwise, and the second is not.
TEST(MitsubaFront, NormalsOfFilesSayWhereItIs) {
  const TemporaryFolder folder;
  folder.write("mesh.obj", "v -1 -1 5\nv 1 -1 5\nv 1 1 5\nv -1 1 5\nvn 0 0 -1\nf 1//1 2//1 3//1\nf 1//1 4//1 3//1\n");
  const auto light = [&](const std::string& content) { return seen(import_text(folder, seen_scene(content)), 4096).y; };
  const std::string lamp = "<emitter type=\"area\"><spectrum name=\"radiance\" value=\"1\"/></emitter>";
  EXPECT_NEAR(light(mesh(lamp)), 1, 0.01);
  EXPECT_NEAR(light(mesh(lamp + flat)), 0.5, 0.03);
  EXPECT_NEAR(light(mesh(lamp + flip)), 0, 1e-6);
  EXPECT_NEAR(light(mesh(diffuse("0.8")) + sky), 0.8, 0.02);
  EXPECT_NEAR(light(mesh(flat + diffuse("0.8")) + sky), 0.4, 0.03);
  // Both sides look the same: the file remains.
  const Imported both = import_text(folder, seen_scene(mesh("<bsdf type=\"twosided\">" + diffuse("0.8") + "</bsdf>") + sky));
  EXPECT_EQ(write_value(get(both.object(0), "positions")).find("1"), std::string::npos);
}

/// A cube of 2 m around z = 5. Seen from outside, its faces are clockwise.
std::string cube(const std::string& of_corner = "") {
  std::string text = "v -1 -1 4\nv -1 -1 6\nv -1 1 4\nv -1 1 6\nv 1 -1 4\nv 1 -1 6\nv 1 1 4\nv 1 1 6\n";
  for (const char* normal : {"1 1 1", "1 1 -1", "1 -1 1", "1 -1 -1", "-1 1 1", "-1 1 -1", "-1 -1 1", "-1 -1 -1"})
    text += "vn " + std::string(normal) + "\n";
  for (const char* face : {"3421", "6875", "2651", "7843", "5731", "4862"}) {
    text += "f";
    for (const char* c = face; *c; ++c)
      text += std::string(" ") + *c + (of_corner.empty() ? std::string() : of_corner + std::string(1, *c));
    text += "\n";
  }
  return text;
}

TEST(MitsubaFront, MeshesWithAMediumAreTurnedRound) {
  const TemporaryFolder folder;
  folder.write("mesh.obj", cube());
  const std::string medium =
      "<bsdf type=\"null\"/><medium name=\"interior\" type=\"homogeneous\"><float name=\"sigma_t\" value=\"0.5\"/>"
      "<float name=\"albedo\" value=\"0\"/></medium>";
  const auto import = [&](const std::string& more) {
    return import_text(folder, scene(sensor() + integrator(8, "volpath") + sky + mesh(medium + more)));
  };
  const auto through = [](const Imported& i) {
    i.job->outputs.clear();
    return test::measure(i.job).mean.y;
  };
  const Imported turned = import(flat);
  ASSERT_TRUE(turned.job) << turned.told();
  EXPECT_NE(turned.told().find("point inwards"), std::string::npos) << turned.told();
  EXPECT_NEAR(through(turned), std::exp(-1), 0.02);
  // With flipped normals Mitsuba's front is outside.
  const Imported flipped = import(flip + flat);
  EXPECT_EQ(flipped.told(), "");
  EXPECT_NEAR(through(flipped), std::exp(-1), 0.02);
  // Vertex normals turn with the faces.
  folder.write("mesh.obj", cube("//"));
  const std::string normals = write_value(get(import("").object(1), "normals"));
  EXPECT_EQ(normals[normals.find_first_of("-0123456789")], '-') << normals;
}

}  // namespace
}  // namespace etendue::mitsuba_test
