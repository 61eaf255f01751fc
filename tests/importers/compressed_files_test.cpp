// Files compressed by gzip are read like their contents.

#include <zlib.h>

#include "components/objects/meshes/mesh_data.h"
#include "pbrt_support.h"

namespace etendue {
namespace {

using namespace pbrt_test;

std::string compressed(const std::string& text) {
  const TemporaryFolder folder;
  const std::string path = folder / "packed";
  gzFile file = gzopen(path.c_str(), "wb9");
  gzwrite(file, text.data(), unsigned(text.size()));
  gzclose(file);
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string refusal(const std::string& name, const std::string& bytes) {
  const TemporaryFolder folder;
  try {
    read_mesh(folder.write(name, bytes));
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

const std::string one_triangle =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
    "property list uchar int vertex_indices\nend_header\n-1 -1 2\n1 -1 2\n0 1 2\n3 0 1 2\n";

TEST(CompressedFiles, HoldMeshesOfAnyFormat) {
  const TemporaryFolder folder;
  EXPECT_EQ(read_mesh(folder.write("mesh.ply.gz", compressed(one_triangle))).triangles.size(), 1u);
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  EXPECT_EQ(read_mesh(folder.write("MESH.OBJ.GZ", compressed(obj))).triangles.size(), 1u);
  // A file that has only the extension of a compressed one is read unchanged.
  EXPECT_EQ(read_mesh(folder.write("plain.obj.gz", obj)).triangles.size(), 1u);
}

TEST(CompressedFiles, AreMeshesAndPartsOfPbrtsScenes) {
  const TemporaryFolder folder;
  folder.write("mesh.ply.gz", compressed(one_triangle));
  folder.write("world.pbrt.gz", compressed("Shape \"plymesh\" \"string filename\" \"mesh.ply.gz\"\n"));
  // With an area light the importer writes out the triangles; without one the object reads the file.
  for (const char* light : {"", "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\n"}) {
    const Imported read = import_text(folder, v4(std::string(light) + "Include \"world.pbrt.gz\"\n"));
    ASSERT_TRUE(read.job) << read.told();
    EXPECT_TRUE(read.errors.empty()) << read.told();
  }
  EXPECT_TRUE(importer_of("scene.pbrt.gz"));
}

TEST(CompressedFiles, AreGivenToImportersAsTheirContents) {
  const TemporaryFolder folder;
  const std::string text = "3\n\nC 0 0 0\n", packed = compressed(text);
  const auto contents = [&](const std::string& name, const std::string& bytes) {
    return Importing(folder.write(name, bytes), {}).contents();
  };
  EXPECT_EQ(contents("a.xyz", text), text);
  EXPECT_EQ(contents("a.xyz.gz", packed), text);
  EXPECT_EQ(contents("A.XYZ.GZ", packed), text);
  EXPECT_EQ(contents("plain.xyz.gz", text), text);
  EXPECT_EQ(contents("packed.xyz", packed), packed);  // the name does not say so
  Importing importing(folder.write("main.xyz", text), {});
  folder.write("other.xyz.gz", packed);
  EXPECT_EQ(importing.contents(importing.file("other.xyz.gz", importing.at(2, 1)), importing.at(2, 1)), text);
  try {
    (void)contents("short.xyz.gz", packed.substr(0, packed.size() - 9));
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("short.xyz.gz': "), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.location.file).find("short.xyz.gz"), std::string::npos);
  }
  try {
    (void)importing.contents(folder / "missing.xyz", importing.at(2, 1));
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("missing.xyz': "), std::string::npos) << error.what();
    EXPECT_EQ(error.location.line, 2);
  }
}

TEST(CompressedFiles, AreRefusedWhenDamagedOrMadeToFillTheMemory) {
  const std::string whole = compressed(one_triangle);
  EXPECT_NE(refusal("short.ply.gz", whole.substr(0, whole.size() / 2)).find("ends too early"), std::string::npos);
  std::string damaged = whole;
  damaged[damaged.size() / 2] = char(damaged[damaged.size() / 2] ^ 0x55);
  EXPECT_NE(refusal("damaged.ply.gz", damaged), "");
  const std::string bomb = compressed(std::string(300 << 20, '\0'));
  EXPECT_LT(bomb.size(), 1u << 20);
  EXPECT_NE(refusal("bomb.ply.gz", bomb).find("over 64 times its own size"), std::string::npos) << refusal("bomb.ply.gz", bomb);
}

}  // namespace
}  // namespace etendue
