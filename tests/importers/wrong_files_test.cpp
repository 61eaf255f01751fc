// Files with an extension that cannot be read, and files whose contents are not what their names say: reported in one line.

#include <gtest/gtest.h>

#include <algorithm>

#include "etendue/importer.h"
#include "etendue/render/job.h"
#include "files/file_kind.h"
#include "images/linear_image.h"
#include "support/process.h"

namespace etendue {
namespace {

/// The errors of a job's file, one per line.
std::string errors(const std::string& path) {
  try {
    const Ref<Job> job = load_job(path);
    prepare_tree(*job);
  } catch (const Errors& list) {
    std::string all;
    for (const Error& e : list.errors) all += std::string(e.what()) + "\n";
    return all;
  } catch (const Error& e) {
    return std::string(e.what()) + "\n";
  }
  return {};
}
bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }
size_t lines(const std::string& text) { return size_t(std::ranges::count(text, '\n')); }

const std::string lfs = "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n";
const std::string page = "\n<!DOCTYPE html>\n<html><body>404</body></html>\n";
const std::string glb("glTF\2\0\0\0\x14\0\0\0\0\0\0\0JSON", 20);
const std::string png("\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR", 16);
const std::string collada = "<?xml version=\"1.0\"?>\n<!-- <scene> -->\n<COLLADA version=\"1.4.1\"/>\n";

TEST(WrongFiles, EndingsThatAreNotRead) {
  const TemporaryFolder folder;
  for (const std::string text : {"0\nSECTION\n", "\1\2\3\xff", "import numpy as np\n", "v 1 2 3\n", "<a/>"}) {
    const std::string told = errors(folder.write("model.dxf", text));
    EXPECT_TRUE(has(told, "files ending in .dxf are not read; these are: .3ds, ")) << told;
    for (const std::string& ending : imported_extensions()) EXPECT_TRUE(has(told, "." + ending)) << ending;
    EXPECT_TRUE(has(told, ".etd") && has(told, ".json")) << told;
    EXPECT_EQ(lines(told), 1u) << told;
    const std::string included =
        errors(folder.write("scene.etd", "include \"model.dxf\"\nJob { camera: PerspectiveCamera {}, scene: BvhScene {} }\n"));
    EXPECT_TRUE(has(included, "files ending in .dxf are not read")) << included;
    EXPECT_EQ(lines(included), 1u) << included;
  }
  // A render description may have any file name, and its errors are reported.
  EXPECT_EQ(errors(folder.write("scene.txt", "# mine\nJob { camera: PerspectiveCamera {}, scene: BvhScene {} }\n")), "");
  EXPECT_TRUE(has(errors(folder.write("scene.txt", "Job { camera: PerspectiveCamera {}, scene: BvhScen {} }\n")), "BvhScen"));
  folder.write("parts.inc", "param white = 0.8\n");
  EXPECT_EQ(
      errors(folder.write("main.job", "include \"parts.inc\"\nJob { camera: PerspectiveCamera {}, scene: BvhScene {} }\n")),
      "");
}

TEST(WrongFiles, OtherContents) {
  const TemporaryFolder folder;
  const auto expect = [&](const std::string& name, const std::string& contents, const std::string& words) {
    const std::string told = errors(folder.write(name, contents));
    EXPECT_TRUE(has(told, name + "'") && has(told, words)) << name << ": " << told;
    EXPECT_EQ(lines(told), 1u) << told;
  };
  expect("a.etd", "{\"asset\": {\"version\": \"2.0\"}}",
         "is no render description: it is glTF (JSON), whose files end in .gltf");
  expect("b.etd", glb, "it is binary glTF, whose files end in .glb");
  expect("c.pbrt", "<scene version=\"3.0.0\"></scene>", "it is a scene of Mitsuba (XML), whose files end in .xml");
  expect("d.xml", collada, "it is a Collada model (XML), whose files end in .dae");
  expect("e.obj", glb, "it is binary glTF");
  expect("f.ply", "solid a\nfacet normal 0 0 1\nouter loop\n", "it is an STL mesh, whose files end in .stl");
  std::string stl(84 + 50, '\0');
  stl[80] = 1;
  expect("g.ply", stl, "it is an STL mesh");
  expect("h.gltf", page, "it is a web page (HTML), whose files end in .html; perhaps a download failed");
  for (const char* name : {"i.pbrt", "j.xml", "k.obj", "l.stl", "m.etd", "n.glb", "o.ply"})
    expect(name, lfs, "it is a pointer of Git LFS, not the file itself; 'git lfs pull' brings the file");
  expect("p.xml", "# made by hand\nLookAt 0 0 1 0 0 0 0 1 0\nCamera \"perspective\"\nWorldBegin\n", "it is a scene of pbrt");
  expect("q.pbrt", "Job {\n}\n", "it is a render description, whose files end in .etd");
  // Wherever such files are named.
  folder.write("mesh.ply", lfs);
  folder.write("map.exr", page);
  const std::string inner = errors(folder.write(
      "r.etd", "Job { camera: PerspectiveCamera {}, scene: BvhScene { objects: [ TriangleMesh { file: \"mesh.ply\" } ] } }"));
  EXPECT_TRUE(has(inner, "mesh.ply': it is a pointer of Git LFS")) << inner;
  try {
    read_linear_image(folder / "map.exr", automatic_transfer);
    FAIL() << "it is no image";
  } catch (const Error& e) {
    EXPECT_TRUE(has(e.what(), "map.exr': it is a web page")) << e.what();
  }
}

TEST(WrongFiles, KindsByTheirBeginnings) {
  const auto kind = [](const std::string& text) {
    const FileKind* found = kind_of(text, text.size());
    return found ? std::string(found->what) : std::string();
  };
  EXPECT_EQ(kind(png), "a PNG image");
  EXPECT_EQ(kind("OFF\n3 1 0\n"), "an OFF mesh");
  EXPECT_EQ(kind("# x\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n"), "an OBJ mesh");
  EXPECT_EQ(kind("\xff\xfe" + std::string("<\0s\0c\0e\0n\0e\0/\0>\0", 16)), "a scene of Mitsuba (XML)");
  // A text that may be a render description is not taken for anything else.
  for (const char* text : {"", "solid = Lambertian {}\nfacet = 3\n", "v = 3\n", "ply = 1\n", "x = [1, 2]\n", "OFF = 1\nx = 2\n",
                           "Film = 3", "\x1", "usemtl = 3\n"})
    EXPECT_EQ(kind(text), "") << text;
}

}  // namespace
}  // namespace etendue
