// Files whose lines are right one by one, but which are too much as a whole: chains of parts that refer to parts, and large
// numbers of one kind. The cases were found by making files of other programs long.

#include <gtest/gtest.h>

#include <functional>

#include "components/objects/meshes/mesh_data.h"
#include "etendue/importer.h"
#include "etendue/render/job.h"
#include "support/process.h"

namespace etendue {
namespace {

/// The error message of a file, with its line; or "".
std::string error_of(const std::string& name, const std::string& text, Ref<Component>* imported = nullptr) {
  const TemporaryFolder folder;
  const std::string path = folder.write(name, text);
  const auto told = [](const Error& error) { return std::to_string(error.location.line) + ": " + error.what(); };
  try {
    Importing importing(path, {});
    const Ref<Component> read = importer_of(path)->import(importing);
    if (imported) *imported = read;
    return "";
  } catch (const Errors& errors) {
    return told(errors.errors.front());
  } catch (const Error& error) {
    return told(error);
  }
}

std::string repeated(int count, const std::function<std::string(int)>& line) {
  std::string all;
  for (int i = 0; i < count; ++i) all += line(i) + "\n";
  return all;
}
std::string number(int i) { return std::to_string(i); }

std::string mitsuba_mixtures(int count) {
  return "<scene version=\"3.0.0\"><sensor type=\"perspective\"/><bsdf type=\"diffuse\" id=\"b0\"/>\n" +
         repeated(count,
                  [](int i) {
                    return "<bsdf type=\"blendbsdf\" id=\"b" + number(i + 1) + "\"><ref id=\"b" + number(i) +
                           "\"/><bsdf type=\"diffuse\"/></bsdf>";
                  }) +
         "<shape type=\"sphere\"><ref id=\"b" + number(count) + "\"/></shape></scene>";
}

TEST(DeepFiles, MitsubasPluginsThatReferToPlugins) {
  EXPECT_EQ(error_of("scene.xml", mitsuba_mixtures(50)), "");
  EXPECT_NE(error_of("scene.xml", mitsuba_mixtures(10000)).find(": plugins that refer to plugins nest more than 100 deep"),
            std::string::npos);
  // By the shape of a group, too.
  EXPECT_NE(error_of("scene.xml", mitsuba_mixtures(120)).find("nest more than"), std::string::npos);
}

std::string pbrt(const std::string& world) {
  return "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\nWorldBegin\n" + world + "Shape \"sphere\"\n";
}
std::string pbrt_textures(int count) {
  return pbrt("Texture \"t0\" \"spectrum\" \"constant\"\n" +
              repeated(count,
                       [](int i) {
                         return "Texture \"t" + number(i + 1) + "\" \"spectrum\" \"scale\" \"texture tex\" \"t" + number(i) +
                                "\"";
                       }) +
              "Material \"diffuse\" \"texture reflectance\" \"t" + number(count) + "\"\n");
}
std::string pbrt_mixtures(int count) {
  return pbrt("MakeNamedMaterial \"m0\" \"string type\" \"diffuse\"\n" +
              repeated(count,
                       [](int i) {
                         return "MakeNamedMaterial \"m" + number(i + 1) +
                                "\" \"string type\" \"mix\" \"string materials\" [ \"m" + number(i) + "\" \"m0\" ]";
                       }) +
              "NamedMaterial \"m" + number(count) + "\"\n");
}

// Mixtures of many parts become chains, which once overflowed the program's stack.
TEST(DeepFiles, MitsubasMixturesOfManyParts) {
  constexpr int count = 20000;
  const auto scene = [](const std::string& of_sphere) {
    return "<scene version=\"0.6.0\"><shape type=\"sphere\">" + of_sphere + "</shape></scene>";
  };
  const std::string weights =
      "<string name=\"weights\" value=\"" + repeated(count, [](int) { return std::string("0.00001"); }) + "\"/>";
  EXPECT_EQ(
      error_of("many.xml", scene("<bsdf type=\"mixturebsdf\">" + weights +
                                 repeated(count, [](int) { return std::string("<bsdf type=\"diffuse\"/>"); }) + "</bsdf>")),
      "1: a mixture of 20000 bsdfs: 100 are the most");
  EXPECT_EQ(error_of("many.xml", scene("<bsdf type=\"null\"/><medium name=\"interior\" type=\"homogeneous\"><phase "
                                       "type=\"mixturephase\">" +
                                       weights + repeated(count, [](int) { return std::string("<phase type=\"hg\"/>"); }) +
                                       "</phase></medium>")),
            "");
}

TEST(DeepFiles, PbrtsTexturesOfTextures) {
  EXPECT_EQ(error_of("scene.pbrt", pbrt_textures(50)), "");
  EXPECT_EQ(error_of("scene.pbrt", pbrt_textures(10000)), "103: textures that name textures nest more than 100 deep");
}

TEST(DeepFiles, PbrtsMixturesOfMixtures) {
  EXPECT_EQ(error_of("scene.pbrt", pbrt_mixtures(50)), "");
  EXPECT_NE(error_of("scene.pbrt", pbrt_mixtures(10000)).find("mixtures of mixtures nest more than 100 deep"),
            std::string::npos);
}

TEST(DeepFiles, PbrtsAttributesOfOneNameAreOne) {
  Ref<Component> read;
  const std::string many = repeated(20000, [](int i) { return "Attribute \"shape\" \"float radius\" " + number(i + 1); });
  ASSERT_EQ(error_of("scene.pbrt", pbrt(many + repeated(1000, [](int) { return std::string("Shape \"sphere\""); })), &read),
            "");
  const Ref<SceneObject>& sphere = ref_cast<Job>(read)->scene->objects.back();
  EXPECT_EQ(get(*sphere, "radius").as<Number>()->value, 20000);  // the last value counts
  const std::string different = repeated(300, [](int i) { return "Attribute \"shape\" \"float a" + number(i) + "\" 1"; });
  EXPECT_EQ(error_of("scene.pbrt", pbrt(different)), "203: more than 200 attributes are given to every shape");
}

TEST(DeepFiles, PropertiesOfOnePlugin) {
  const std::string many = repeated(20000, [](int i) { return "<float name=\"a" + number(i) + "\" value=\"1\"/>"; });
  EXPECT_EQ(error_of("scene.xml", "<scene version=\"3.0.0\"><sensor type=\"perspective\"/><shape type=\"sphere\">\n" + many +
                                      "</shape></scene>"),
            "1002: a shape has more than 1000 values");
  EXPECT_EQ(error_of("scene.pbrt",
                     pbrt("Shape \"sphere\"\n" + repeated(20000, [](int i) { return "\"float a" + number(i) + "\" 1"; }))),
            "1004: Shape \"sphere\" has more than 1000 parameters");
}

TEST(DeepFiles, AnObjFileOfManyMaterials) {
  const TemporaryFolder folder;
  constexpr int materials = 4000;
  const std::string path =
      folder.write("many.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n" + repeated(materials, [](int i) {
                                 return "usemtl m" + number(i % (materials / 2)) + (i % 2 ? "\nf 1 2 3" : "\nf 1 3 4");
                               }));
  const std::vector<std::string> parts = obj_parts(path);
  ASSERT_EQ(parts.size(), size_t(materials / 2));
  for (const int i : {0, 7, materials / 2 - 1, 7}) {
    const MeshData mesh = read_mesh(path, "usemtl m" + number(i));
    ASSERT_EQ(mesh.triangles.size(), 2u) << i;  // both of its places in the file
    ASSERT_EQ(mesh.positions.size(), 3u) << i;
    const Point3 third = i % 2 ? Point3(0, 1, 0) : Point3(0, 0, 1);
    EXPECT_EQ(mesh.positions[mesh.triangles[0][2]], third) << i;
  }
}

TEST(DeepFiles, APlyFileWithAttributesOfFacesAndWithoutTriangles) {
  try {
    read_ply(
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
        "property list uchar int vertex_indices\nproperty float a_0\nproperty float a_1\nend_header\n0 0 0\n0 1 2\n");
    FAIL() << "nothing is to be seen in it";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "it has no faces");  // reading on was undefined behaviour once, found by the sanitizer
  }
}

/// Its list of five shapes would begin four bytes before the file.
TEST(DeepFiles, ASerializedFileThatIsItsListOfShapes) {
  const std::string file("\x1c\x04\x03\0\x78\x9c\x13\x12!\xff\xff\xff\xff\xff\xff\xff\x05\0\0\0", 20);
  for (std::uint32_t number = 0; number < 6; ++number) EXPECT_THROW(read_serialized(file, number), Error) << number;
}

}  // namespace
}  // namespace etendue
