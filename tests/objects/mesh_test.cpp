// Mesh files in PLY and OBJ, valid and hostile.

#include <cstring>
#include <filesystem>
#include <fstream>

#include "components/objects/meshes/mesh_data.h"
#include "etendue/mesh_facts.h"
#include "support/geometry_support.h"

namespace etendue {
namespace {

using namespace geometry_test;

template <class T>
void put(std::string& to, T value, bool swap) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  if (swap) std::reverse(bytes, bytes + sizeof(T));
  to.append(bytes, sizeof(T));
}

/// A grid of n x n quads over [0, n]^2 with z = x y / 10, in one of three formats. Quads of even rows are written as two
/// triangles; extra properties and an extra element stand before, between and after those that are read.
std::string ply_grid(const std::string& format, int n) {
  const bool text = format == "ascii", swap = format == "binary_big_endian";
  int faces = 0;
  for (int y = 0; y < n; ++y) faces += (y % 2 == 0 ? 2 : 1) * n;
  std::string s =
      "ply\nformat " + format + " 1.0\ncomment a test\nobj_info none\nelement camera 1\nproperty list ushort double view\n";
  s += "element vertex " + std::to_string((n + 1) * (n + 1)) +
       "\nproperty uchar red\nproperty float x\nproperty double y\nproperty float z\n";
  s += "property float nx\nproperty float ny\nproperty float nz\nproperty float s\nproperty float t\nproperty short extra\n";
  s += "element face " + std::to_string(faces) +
       "\nproperty list uint8 float weights\nproperty list uchar int vertex_indices\nproperty int tag\nend_header\n";
  const auto number = [&](auto v) {
    if (text)
      s += std::to_string(v) + " ";
    else
      put(s, v, swap);
  };
  number(std::uint16_t(2));
  number(1.5);
  number(-2.5);
  if (text) s += "\n";
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x) {
      number(std::uint8_t(200));
      number(float(x));
      number(double(y));
      number(float(x * y) * 0.125f);
      number(0.0f);
      number(0.0f);
      number(2.0f);
      number(float(x) / float(n));
      number(float(y) / float(n));
      number(std::int16_t(-3));
      if (text) s += "\n";
    }
  const auto face = [&](std::initializer_list<int> corners) {
    number(std::uint8_t(1));
    number(0.5f);
    number(std::uint8_t(corners.size()));
    for (int c : corners) number(std::int32_t(c));
    number(std::int32_t(7));
    if (text) s += "\n";
  };
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const int a = y * (n + 1) + x, b = a + 1, c = b + n + 1, d = a + n + 1;
      if (y % 2 == 0) {
        face({a, b, c});
        face({a, c, d});
      } else {
        face({a, b, c, d});
      }
    }
  return s;
}

TEST(Ply, ThreeFormatsGiveTheSame) {
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    SCOPED_TRACE(format);
    const MeshData m = read_ply(ply_grid(format, 6));
    ASSERT_EQ(m.positions.size(), 49u);
    ASSERT_EQ(m.normals.size(), 49u);
    ASSERT_EQ(m.uvs.size(), 49u);
    ASSERT_EQ(m.triangles.size(), 72u);
    EXPECT_EQ(m.positions[10], (Point3{3, 1, 0.375f}));
    EXPECT_EQ(m.normals[48], (Normal3{0, 0, 2}));
    EXPECT_NEAR(m.uvs[48].x, 1, 1e-6f);
    double area = 0;  // projected: all triangles face up and cover the square once
    for (const auto& t : m.triangles) {
      const float a = cross(m.positions[t[1]] - m.positions[t[0]], m.positions[t[2]] - m.positions[t[0]]).z / 2;
      EXPECT_GT(a, 0);
      area += double(a);
    }
    EXPECT_NEAR(area, 36, 1e-4);
  }
}

TEST(Ply, CommonLayoutIsReadInOnePiece) {
  std::string s =
      "ply\r\nformat binary_little_endian 1.0\r\nelement vertex 4\r\nproperty float x\r\nproperty float y\r\nproperty float "
      "z\r\nelement face 3\r\nproperty list uchar uint vertex_index\r\nend_header\r\n";
  for (float f : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 1.f, 0.f, 0.f, 1.f, 0.f}) put(s, f, false);
  const auto face = [&](std::initializer_list<std::uint32_t> corners) {
    put(s, std::uint8_t(corners.size()), false);
    for (std::uint32_t c : corners) put(s, c, false);
  };
  face({0, 1, 2});
  face({0, 1, 2, 3});
  face({0, 2, 3});
  const MeshData m = read_ply(s);
  ASSERT_EQ(m.triangles.size(), 4u);
  EXPECT_EQ(m.triangles[3], (std::array<std::uint32_t, 3>{0, 2, 3}));
  EXPECT_THROW(read_ply(s.substr(0, s.size() - 1)), Error);
}

std::string message(const std::string& text, MeshData (*reader)(std::string_view) = read_ply) {
  try {
    reader(text);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

TEST(Ply, HostileFilesAreRefused) {
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    // Every proper prefix and every changed byte gives an error, or a mesh with indices in range, but never a crash.
    const std::string sound = ply_grid(format, 3);
    for (size_t n = 0; n + 40 < sound.size(); ++n) EXPECT_NE(message(sound.substr(0, n)), "") << n;
    Random random(31);
    for (int i = 0; i < 3000; ++i) {
      std::string changed = sound;
      changed[size_t(random.number() * float(sound.size()))] = char(std::uint8_t(random.number() * 256));
      try {
        const MeshData m = read_ply(changed);
        for (const auto& t : m.triangles)
          for (std::uint32_t c : t) ASSERT_LT(c, m.positions.size());
      } catch (const Error& e) {
        EXPECT_STRNE(e.what(), "");
      }
    }
  }
  const std::string head = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_EQ(message(head + faces + "3 0 1 2\n"), "");
  EXPECT_NE(message(head + faces + "3 0 1 3\n").find("line 13"), std::string::npos) << message(head + faces + "3 0 1 3\n");
  EXPECT_NE(message(head + faces + "3 0 -1 2\n"), "");
  EXPECT_NE(message(head + faces + "3 0 x 2\n").find("number"), std::string::npos);
  EXPECT_NE(message(head + faces + "300000000 0 1 2\n").find("more than the file holds"), std::string::npos);
  EXPECT_NE(message(head + faces).find("the file"), std::string::npos);
  EXPECT_NE(message("ply\nformat ascii 1.0\nelement vertex 99999999999999\nproperty float x\nproperty float y\nproperty float "
                    "z\nend_header\n0 0 0\n")
                .find("more than the file holds"),
            std::string::npos);
  EXPECT_NE(message("ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\nproperty float "
                    "y\nproperty float z\nend_header\n")
                .find("more than the file holds"),
            std::string::npos);
  EXPECT_NE(message("ply\nelement vertex 0\nend_header\n"), "");
  EXPECT_NE(message(head + "end_header\n0 0 0\n1 0 0\n0 1 0\n").find("no faces"), std::string::npos);
}

TEST(Obj, AllForms) {
  const std::string text =
      "# a comment\nmtllib x.mtl\no thing\nv 0 0 0\nv 1 0 0 1.0\nv 1 1 0 0.5 0.5 0.5\nv 0 1 +0\r\n"
      "vt 0 0\nvt 1 0 0\nvt 1 1\nvn 0 0 1\nvn 0 0 2\ng group\ns off\nusemtl m\n"
      "f 1/1/1 2/2/1 3/3/1\nf 1//1 3//1 4//1\nf 1/1 2/2 3/3 # end\nf -4 -3 \\\n -2 -1\nf 1/1/2 2/2/2 3/3/2\nl 1 2\n";
  const MeshData m = read_obj(text);
  ASSERT_EQ(m.triangles.size(), 6u);
  EXPECT_EQ(m.positions.size(), 3u + 3 + 3 + 4 + 3);  // one vertex for each combination
  EXPECT_EQ(m.normals.size(), m.positions.size());
  const auto& last = m.triangles.back();
  EXPECT_EQ(m.normals[last[1]], (Normal3{0, 0, 2}));
  EXPECT_EQ(m.uvs[last[2]], (Point2{1, 1}));
  EXPECT_EQ(m.positions[last[2]], (Point3{1, 1, 0}));
  EXPECT_EQ(m.normals[m.triangles[2][0]], Normal3{});
  // Without vt and vn the vertices are unchanged; faces may come before their vertices; a concave quad is split correctly.
  const MeshData late = read_obj("f 1 2 3 4\nv 0 0 0\nv 2 0 0\nv 0.2 0.2 0\nv 0 2 0\n");
  ASSERT_EQ(late.triangles.size(), 2u);
  EXPECT_EQ(late.positions.size(), 4u);
  for (const auto& t : late.triangles)
    EXPECT_GT(cross(late.positions[t[1]] - late.positions[t[0]], late.positions[t[2]] - late.positions[t[0]]).z, 0);
}

TEST(Obj, HostileFilesAreRefused) {
  const std::string v = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_EQ(message(v + "f 1 2 3\n", read_obj), "");
  EXPECT_NE(message(v + "f 1 2 4\n", read_obj).find("line 4"), std::string::npos);
  EXPECT_NE(message(v + "f 1 2 0\n", read_obj).find("is 0"), std::string::npos);
  EXPECT_NE(message(v + "f 1 2 -4\n", read_obj), "");
  EXPECT_NE(message(v + "f 1 2 99999999999999999999\n", read_obj), "");
  EXPECT_NE(message(v + "vt 0 0\nf 1/2 2 3\n", read_obj), "");
  EXPECT_NE(message(v + "f 1 2\n", read_obj), "");
  EXPECT_NE(message(v + "f a b c\n", read_obj), "");
  EXPECT_NE(message("v 0 0\nf 1 1 1\n", read_obj), "");
  EXPECT_NE(message(v, read_obj).find("no faces"), std::string::npos);
  EXPECT_NE(message("", read_obj), "");
  EXPECT_NE(message("v 1 2 3 \\", read_obj), "");
}

/// A temporary folder, removed after the test.
class MeshFiles : public testing::Test {
 protected:
  MeshFiles() { std::filesystem::create_directories(folder_); }
  ~MeshFiles() override { std::filesystem::remove_all(folder_); }
  std::string file(const std::string& name, const std::string& contents) {
    const std::string path = (folder_ / name).string();
    std::ofstream(path, std::ios::binary) << contents;
    return path;
  }
  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("etendue_mesh_test_" + std::to_string(std::random_device()()));
};

TEST_F(MeshFiles, MeshFromFile) {
  const Ref<SceneObject> a = object("TriangleMesh", {{"file", file("grid.ply", ply_grid("ascii", 4))}});
  const Ref<SceneObject> b =
      object("TriangleMesh", {{"file", file("grid2.ply", ply_grid("binary_big_endian", 4))}}, Transform::scale({2, 2, 2}));
  EXPECT_NEAR(4 * a->area(0), b->area(0), 1e-3f);
  Hit hit;
  const Ray down = ray({1.3f, 2.2f, 9}, {0, 0, -1});
  ASSERT_TRUE(a->intersect(down, hit));
  SurfacePoint p;
  a->surface_point(down, hit, p);
  EXPECT_NEAR(p.uv.x, 1.3f / 4, 1e-5f);
  EXPECT_NEAR(p.uv.y, 2.2f / 4, 1e-5f);
  EXPECT_NEAR(p.shading_normal.z, 1, 1e-6f);  // the file's normals, not the surface's
  EXPECT_LT(p.normal.z, 0.99f);
  const Ref<SceneObject> flat = object("TriangleMesh", {{"file", file("grid.ply", ply_grid("ascii", 4))}, {"flat", true}});
  flat->surface_point(down, hit, p);
  EXPECT_EQ(p.shading_normal, p.normal);
  EXPECT_FALSE(a->closed());
  EXPECT_TRUE(object("TriangleMesh", cube_settings())->closed());
}

// Spheres generated by programs end at sin(2 pi) = -2.4e-16 and begin at 0.
TEST(Mesh, SeamsOfRoundingAreClosed) {
  const auto tetrahedron = [](double seam, double size) {
    return object("TriangleMesh", {{"positions", {0, 0, 0, size, 0, 0, 0, size, 0, 0, 0, size, seam, 0, 0}},
                                   {"triangles", {0, 2, 1, 4, 1, 3, 0, 3, 2, 1, 2, 3}}});
  };
  for (const double size : {1.0, 1e-6, 1e6}) {
    EXPECT_TRUE(tetrahedron(-2.4e-16 * size, size)->closed()) << size;
    EXPECT_FALSE(tetrahedron(-1e-6 * size, size)->closed()) << size;
    EXPECT_EQ(tetrahedron(-1e-6 * size, size)->mesh_facts()->open_edges(), 4u);
  }
}

TEST_F(MeshFiles, ErrorsNameTheFile) {
  const auto error = [&](const std::string& path) -> std::string {
    try {
      object("TriangleMesh", {{"file", path}});
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(error("no/such.ply").find("No such file"), std::string::npos);
  EXPECT_NE(error(file("bad.ply", "ply\nrubbish\n")).find("bad.ply"), std::string::npos);
  EXPECT_NE(error(file("empty.obj", "")).find("empty"), std::string::npos);
  EXPECT_NE(error(file("what.xyz", "1 2 3")).find("format"), std::string::npos);
  EXPECT_NE(error(folder_.string()).find("folder"), std::string::npos);
}

// A file without any usable triangle is no error, as it may be one of many in a scene: a warning gives the reason.
TEST_F(MeshFiles, WithoutUsableTrianglesAreLeftOutAndTold) {
  const auto told = [&](const std::string& path) {
    testing::internal::CaptureStderr();
    EXPECT_FALSE(object("TriangleMesh", {{"file", path}})->luminaire());
    return testing::internal::GetCapturedStderr();
  };
  const std::string infinite = told(file("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")),
                    flat = told(file("thin.obj", "v 2 0 0\nv 1 0 0\nv 0 0 0\nf 1 2 3\n"));
  EXPECT_NE(infinite.find("nan.obj': none of its 1 triangles can be used (1 with coordinates that are not finite"),
            std::string::npos)
      << infinite;
  EXPECT_NE(
      flat.find("thin.obj': none of its 1 triangles can be used (0 with coordinates that are not finite, 1 without area)"),
      std::string::npos)
      << flat;
}

TEST_F(MeshFiles, UnusableTrianglesAreLeftOut) {
  const Ref<SceneObject> m = object(
      "TriangleMesh",
      {{"file",
        file("some.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv inf 0 0\nv 1e300 0 0\nf 1 2 3\nf 1 2 4\nf 1 2 5\nf 1 2 2\nf 1 1 1\n")}});
  EXPECT_EQ(still_triangles(*m)->triangles.size(), 1u);
  EXPECT_NEAR(m->area(0), 0.5f, 1e-6f);
  EXPECT_TRUE(is_finite(m->bounds().high));
}

TEST(MeshReference, KnownFiles) {
  const std::filesystem::path data = std::filesystem::path(ETENDUE_SOURCE_DIR) / "../shared/validation";
  if (!std::filesystem::exists(data / "mesh/bunny.ply")) GTEST_SKIP() << "no validation data";
  const auto triangles = [&](const std::string& name) { return read_mesh((data / name).string()).triangles.size(); };
  EXPECT_EQ(triangles("mesh/bunny.ply"), 69451u);
  EXPECT_EQ(triangles("mesh/teapot.obj"), 6320u);
  EXPECT_EQ(triangles("mesh/spot.obj"), 5856u);
  EXPECT_EQ(triangles("mesh/cow.obj"), 5804u);
  EXPECT_EQ(triangles("mesh/suzanne.obj"), 2u * 468 + 32);
}

TEST(MeshReference, BrokenFilesAreRefused) {
  const std::filesystem::path data = std::filesystem::path(ETENDUE_SOURCE_DIR) / "../shared/validation";
  if (!std::filesystem::exists(data / "import/broken")) GTEST_SKIP() << "no validation data";
  for (const auto& entry : std::filesystem::directory_iterator(data / "import/broken")) {
    const std::string ending = entry.path().extension().string();
    if (ending != ".ply" && ending != ".obj") continue;
    EXPECT_THROW(read_mesh(entry.path().string()), Error) << entry.path();
  }
}

}  // namespace
}  // namespace etendue
