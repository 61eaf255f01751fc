// 3MF: printed objects stand on the xy plane, in the unit that the file states.

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <vector>

#include "etendue/importer.h"
#include "etendue/scene.h"
#include "support/process.h"

namespace etendue {
namespace {

std::uint32_t check_sum(const std::string& bytes) {
  std::uint32_t sum = 0xffffffffu;
  for (const char c : bytes) {
    sum ^= std::uint8_t(c);
    for (int k = 0; k < 8; ++k) sum = (sum >> 1) ^ (sum & 1 ? 0xEDB88320u : 0);
  }
  return ~sum;
}
void append(std::string& to, std::initializer_list<std::pair<std::uint32_t, size_t>> numbers) {
  for (const auto& [value, size] : numbers) to.append(reinterpret_cast<const char*>(&value), size);
}

/// A ZIP archive whose entries are not compressed.
std::string archive(const std::vector<std::pair<std::string, std::string>>& entries) {
  std::string all, list;
  for (const auto& [name, bytes] : entries) {
    const auto size = std::uint32_t(bytes.size()), offset = std::uint32_t(all.size());
    const auto common = [&](std::string& to) {
      append(to, {{20, 2},
                  {0, 2},
                  {0, 2},
                  {0, 4},
                  {check_sum(bytes), 4},
                  {size, 4},
                  {size, 4},
                  {std::uint32_t(name.size()), 2},
                  {0, 2}});
    };
    all += "PK\3\4";
    common(all);
    all += name + bytes;
    list += "PK\1\2";
    append(list, {{20, 2}});
    common(list);
    append(list, {{0, 2}, {0, 2}, {0, 2}, {0, 4}, {offset, 4}});
    list += name;
  }
  const auto count = std::uint32_t(entries.size());
  const auto begin = std::uint32_t(all.size());
  all += list + "PK\5\6";
  append(all, {{0, 2}, {0, 2}, {count, 2}, {count, 2}, {std::uint32_t(list.size()), 4}, {begin, 4}, {0, 2}});
  return all;
}

/// A package of a tetrahedron of 10, 20 and 30 units, and further contents.
std::string package(const std::string& attributes, const std::string& resources = "",
                    const std::vector<std::pair<std::string, std::string>>& more = {}, const std::string& triangle = "") {
  std::vector<std::pair<std::string, std::string>> entries = more;
  entries.emplace_back(
      "_rels/.rels",
      "<?xml version=\"1.0\"?><Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
      "<Relationship Target=\"/3D/3dmodel.model\" Id=\"rel0\" "
      "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>");
  entries.emplace_back(
      "3D/3dmodel.model",
      "<?xml version=\"1.0\"?><model" + attributes +
          " xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"><resources>" + resources +
          "<object id=\"2\" type=\"model\"><mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"10\" y=\"0\" "
          "z=\"0\"/><vertex x=\"0\" y=\"20\" z=\"0\"/><vertex x=\"0\" y=\"0\" "
          "z=\"30\"/></vertices><triangles><triangle v1=\"0\" v2=\"2\" v3=\"1\"" +
          triangle +
          "/><triangle v1=\"0\" v2=\"1\" v3=\"3\"/><triangle v1=\"1\" v2=\"2\" v3=\"3\"/><triangle v1=\"0\" v2=\"3\" "
          "v3=\"2\"/></triangles></mesh></object></resources><build><item objectid=\"2\"/></build></model>");
  return archive(entries);
}

void expect_size(const Scene& scene, double metres) {
  ASSERT_EQ(scene.objects.size(), 1u);
  prepare_tree(*scene.objects[0]);
  const Vector3 size = scene.objects[0]->bounds().diagonal();
  EXPECT_NEAR(size.x, 10 * metres, 1e-5 * metres);
  EXPECT_NEAR(size.y, 30 * metres, 1e-4 * metres);
  EXPECT_NEAR(size.z, 20 * metres, 1e-4 * metres);
}

TEST(ThreeMf, StandsUprightInItsUnit) {
  for (const auto& [unit, metres] : {std::pair{"", 1e-3}, {" unit=\"inch\"", 0.0254}, {" unit=\"meter\"", 1.0}}) {
    SCOPED_TRACE(unit);
    const TemporaryFolder folder;
    const std::string path = folder.write("p.3mf", package(unit));
    Importing importing(path, {});
    const Ref<Scene> scene = ref_cast<Scene>(importer_of(path)->import(importing));
    EXPECT_TRUE(importing.notes().empty());
    expect_size(*scene, metres);
  }
}

// Most programs put a thumbnail into the package, which Assimp frees before it uses it.
TEST(ThreeMf, PicturesInThePackageDoNoHarm) {
  const TemporaryFolder folder;
  const std::string path = folder.write("p.3mf", package("", "",
                                                         {{"Metadata/thumbnail.png", std::string(1000, 'x')},
                                                          {"Metadata/plate_1.jpg", "y"},
                                                          {"Metadata/slicer.config", "z"}}));
  Importing importing(path, {});
  const Ref<Scene> scene = ref_cast<Scene>(importer_of(path)->import(importing));
  EXPECT_TRUE(importing.notes().empty());
  expect_size(*scene, 1e-3);
}

TEST(ThreeMf, ColoursOfTrianglesAreTold) {
  const TemporaryFolder folder;
  const std::string path = folder.write(
      "p.3mf", package(" xmlns:m=\"http://schemas.microsoft.com/3dmanufacturing/material/2015/02\"",
                       "<m:colorgroup id=\"5\"><m:color color=\"#FF0000FF\"/></m:colorgroup>", {}, " pid=\"5\" p1=\"0\""));
  Importing importing(path, {});
  EXPECT_TRUE(importer_of(path)->import(importing));
  ASSERT_EQ(importing.notes().size(), 1u);
  EXPECT_NE(std::string(importing.notes()[0].what()).find("colours and images of single triangles"), std::string::npos);
}

}  // namespace
}  // namespace etendue
