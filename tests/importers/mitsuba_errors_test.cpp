// Errors in scenes of Mitsuba, and features that cannot be expressed, are reported with their location; hostile files do no
// harm.

#include <zlib.h>

#include <cstring>

#include "components/objects/meshes/mesh_data.h"
#include "etendue/language/language.h"
#include "mitsuba_support.h"

namespace etendue::mitsuba_test {
namespace {

/// All messages about a scene whose second line is `line`.
std::string told(const std::string& line, const Parameters& parameters = {}) {
  return import_text(scene(line + "\n" + sensor() + integrator()), parameters).told();
}
testing::AssertionResult tells(const std::string& line, const std::string& words) {
  const std::string all = told(line);
  return (all.find(words) != std::string::npos ? testing::AssertionSuccess() : testing::AssertionFailure()) << all;
}

TEST(MitsubaErrors, AreToldAtTheirPlace) {
  EXPECT_TRUE(tells("<shape type=\"sphre\"/>", "2:2: there is no shape 'sphre' in Mitsuba (did you mean 'sphere'?)"));
  EXPECT_TRUE(tells("<shpe type=\"sphere\"/>", "2:2: <shpe> is unknown (did you mean 'shape'?)"));
  EXPECT_TRUE(
      tells("<shape type=\"sphere\"><float name=\"radius\" value=\"1x\"/></shape>", "2:50: a number is expected, not '1x'"));
  EXPECT_TRUE(tells("<shape type=\"sphere\"><string name=\"radius\" value=\"1\"/></shape>",
                    "'radius' of shape 'sphere' must be a number, not a string"));
  EXPECT_TRUE(tells("<shape type=\"sphere\"><float name=\"radius\" value=\"nan\"/></shape>", "finite"));
  EXPECT_TRUE(tells("<shape type=\"sphere\"><float name=\"radius\" value=\"1e999\"/></shape>", "finite"));
  EXPECT_TRUE(tells("<shape type=\"sphere\"><float name=\"radius\" value=\"-1\"/></shape>", "2:23: "));
  EXPECT_TRUE(tells("<shape type=\"sphere\"><ref id=\"whte\"/></shape><bsdf type=\"diffuse\" id=\"white\"/>",
                    "2:31: there is nothing of the id 'whte' (did you mean 'white'?)"));
  EXPECT_TRUE(tells("<bsdf type=\"diffuse\" id=\"a\"/><bsdf type=\"diffuse\" id=\"a\"/>", "there are two of the id 'a'"));
  EXPECT_TRUE(tells("<shape type=\"obj\"><string name=\"filename\" value=\"no.obj\"/></shape>", "there is no file 'no.obj'"));
  EXPECT_TRUE(tells("<shape type=\"obj\"><string name=\"filename\" value=\"/etc/passwd\"/></shape>", "--allow-path"));
  EXPECT_TRUE(tells("<path value=\"..\"/>", "--allow-path"));
  EXPECT_TRUE(tells("<shape type=\"sphere\"><transform name=\"to_world\"><scale value=\"0\"/></transform></shape>",
                    "cannot be inverted"));
  EXPECT_TRUE(
      tells("<default name=\"size\" value=\"2\"/><shape type=\"sphere\"><float name=\"radius\" value=\"$siz\"/></shape>",
            "the parameter '$siz' has no value: neither <default> nor -D gives one (did you mean 'size'?)"));
  EXPECT_TRUE(tells("<bsdf type=\"twosided\" id=\"a\"><ref id=\"a\"/></bsdf><shape type=\"sphere\"><ref id=\"a\"/></shape>",
                    "holds itself"));
  EXPECT_TRUE(
      tells("<shape type=\"sphere\"/>\n  \xe2\x80\x8b x\n", "3:3: text between elements says nothing to Mitsuba: 'U+200B x'"));
  EXPECT_TRUE(tells("<scene", "this is not XML"));
  // Several at once.
  EXPECT_EQ(import_text(scene("<shape type=\"a\"/><shape type=\"b\"/>" + sensor() + integrator())).errors.size(), 2u);
}

// Where Disney's model differs visibly from Mitsuba's, the difference is reported: for bright colours and for partly
// transmissive surfaces.
TEST(MitsubaErrors, EnergyOfPrincipledIsTold) {
  const auto principled = [](const std::string& inside) {
    return told("<shape type=\"sphere\"><bsdf type=\"principled\">" + inside + "</bsdf></shape>");
  };
  const auto base = [](const std::string& value) { return "<rgb name=\"base_color\" value=\"" + value + "\"/>"; };
  EXPECT_EQ(principled(base("0.5 0.8 0.2")), "");
  EXPECT_NE(principled(base("0.2 0.95 0.2")).find("sends away more light than arrives in Mitsuba"), std::string::npos);
  EXPECT_NE(principled("<float name=\"spec_trans\" value=\"0.5\"/>").find("'energy: kept' of DisneyPrincipled loses none"),
            std::string::npos);
}

TEST(MitsubaErrors, WhatIsNotExpressedIsNoted) {
  EXPECT_EQ(told("<shape type=\"sphere\"/>"), "");
  EXPECT_TRUE(tells("<shape type=\"sphere\"><float name=\"radios\" value=\"1\"/></shape>",
                    "2:23: 'radios' of shape 'sphere' is not used (did you mean 'radius'?)"));
  EXPECT_TRUE(tells("<shape type=\"sphere\"><bsdf type=\"irawan\"/></shape>", "bsdf 'irawan' has no counterpart here"));
  EXPECT_TRUE(tells("<shape type=\"sphere\"><bsdf type=\"diffuse\"><float name=\"alpha\" value=\"1\"/></bsdf></shape>",
                    "'alpha' of bsdf 'diffuse' is not used"));
  EXPECT_TRUE(tells("<shape type=\"sphere\"><texture type=\"bitmap\"/></shape>", "has no use for a texture 'bitmap'"));
  Importing strict("scene.xml", {});
  EXPECT_TRUE(tells("<shape type=\"sphere\"/><integrator type=\"sppm\"/>", "has no use for a integrator") ||
              tells("<shape type=\"sphere\"/><integrator type=\"sppm\"/>", "sppm"));
}

TEST(MitsubaParameters, DefaultsIncludesAndAliases) {
  const TemporaryFolder folder;
  folder.write("white.xml",
               "<scene version=\"3.0.0\"><bsdf type=\"diffuse\" id=\"white\"/>"
               "<alias id=\"white\" as=\"paint\"/></scene>");
  const std::string text = scene(
      "<default name=\"r\" value=\"2\"/><default name=\"file\" value=\"white\"/><include filename=\"$file.xml\"/>"
      "<shape type=\"sphere\"><float name=\"radius\" value=\"$r\"/><ref id=\"paint\"/></shape>"
      "<shape type=\"sphere\"><float name=\"radius\" value=\"1$r.5\"/><ref id=\"white\"/></shape>" +
      sensor() + integrator());
  const Imported by_default = import_text(folder, text), given = import_text(folder, text, {{"r", "3"}});
  EXPECT_EQ(by_default.told(), "");
  EXPECT_EQ(number(by_default.object(0), "radius"), 2);
  EXPECT_EQ(number(by_default.object(1), "radius"), 12.5);
  EXPECT_EQ(number(given.object(0), "radius"), 3);
  EXPECT_EQ(&part(by_default.object(0), "shader"), &part(by_default.object(1), "shader"));
  EXPECT_EQ(part(by_default.object(0), "shader").origin->name, "white");
  EXPECT_NE(import_text(folder, text, {{"q", "3"}}).told().find("the file has no parameter 'q'"), std::string::npos);
}

TEST(MitsubaParameters, NamesOfOlderVersions) {
  const std::string old =
      "<shape type=\"sphere\"><transform name=\"toWorld\"><translate x=\"1\"/></transform><bsdf "
      "type=\"roughconductor\"><float name=\"alphaU\" value=\"0.3\"/><float name=\"alphaV\" value=\"0.2\"/><float "
      "name=\"extEta\" value=\"1\"/><rgb name=\"eta\" value=\"1 2 3\"/><rgb name=\"k\" value=\"1 2 3\"/></bsdf></shape>";
  const Imported i = import_text(scene(sensor() +
                                           "<integrator type=\"path\"><integer name=\"maxDepth\" value=\"7\"/><boolean "
                                           "name=\"strictNormals\" value=\"true\"/></integrator><emitter "
                                           "type=\"constant\"/>" +
                                           old,
                                       "0.5.0"));
  EXPECT_EQ(i.told(), "");
  EXPECT_EQ(number(*i.job->renderer, "max_depth"), 7);
  const Component& metal = part(i.object(1), "shader");
  EXPECT_EQ(*get(metal, "index").as<std::string>(), "rgb");
  EXPECT_NE(write_description(metal).find("roughness: 0.3"), std::string::npos);
}

TEST(MitsubaHostile, FilesDoNoHarm) {
  EXPECT_NE(import_text("<!DOCTYPE s [<!ENTITY a \"aaaa\"><!ENTITY b \"&a;&a;\">]><scene version=\"3.0.0\"/>")
                .told()
                .find("entities"),
            std::string::npos);
  std::string deep;
  for (int i = 0; i < 1000000; ++i) deep += "<bsdf type=\"twosided\">";
  EXPECT_NE(import_text(scene(deep)).told(), "");
  for (int i = 0; i < 1000000; ++i) deep += "</bsdf>";
  EXPECT_NE(import_text(scene(deep)).told().find("nest more than"), std::string::npos);
  EXPECT_NE(import_text(std::string("<scene version=\"3.0.0\">\0</scene>", 32)).told().find("zero byte"), std::string::npos);
  EXPECT_NE(import_text("").told().find("empty"), std::string::npos);

  const TemporaryFolder folder;
  folder.write("b.xml", scene("<include filename=\"scene.xml\"/>"));
  EXPECT_NE(import_text(folder, scene("<include filename=\"b.xml\"/>")).told().find("includes itself"), std::string::npos);
  // Each file includes the next one twice: 2^16 files without a limit.
  for (int i = 0; i < 17; ++i) {
    const std::string next = "<include filename=\"n" + std::to_string(i + 1) + ".xml\"/>";
    folder.write("n" + std::to_string(i) + ".xml", scene(next + next));
  }
  EXPECT_NE(import_text(folder, scene("<include filename=\"n0.xml\"/>")).told(), "");
  std::string doubling = "<default name=\"a0\" value=\"xxxxxxxxxx\"/>";
  for (int i = 1; i < 60; ++i)
    doubling += "<default name=\"a" + std::to_string(i) + "z\" value=\"$a" + std::to_string(i - 1) + (i > 1 ? "z$a" : "$a") +
                std::to_string(i - 1) + (i > 1 ? "z" : "") + "\"/>";
  EXPECT_NE(import_text(scene(doubling)).told().find("longer than"), std::string::npos);
}

template <class T>
void put(std::string& to, T value) {
  to.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

/// A file of two meshes, of one triangle and of two, as Mitsuba 0.5 writes it.
std::string serialized(int version, bool doubles, std::uint32_t first_corner = 0) {
  std::string file;
  std::vector<std::uint64_t> offsets;
  for (int triangles = 1; triangles <= 2; ++triangles) {
    offsets.push_back(file.size());
    std::string body;
    put(body, std::uint32_t(doubles ? 0x2003 : 0x1003));  // normals and uvs
    if (version == 4) body += std::string("name\0", 5);
    put(body, std::uint64_t(4));
    put(body, std::uint64_t(triangles));
    const auto number = [&](double x) {
      if (doubles)
        put(body, x);
      else
        put(body, float(x));
    };
    for (const double x : {0., 0., 0., 1., 0., 0., 1., 1., 0.5, 0., 1., 0.}) number(x);
    for (int i = 0; i < 4; ++i) number(0), number(0), number(2);
    for (const double x : {0., 0., 1., 0., 1., 0.25, 0., 1.}) number(x);
    for (const std::uint32_t c : {first_corner, 1u, 2u}) put(body, c);
    if (triangles == 2)
      for (const std::uint32_t c : {0u, 2u, 3u}) put(body, c);
    put(file, std::uint16_t(0x041c));
    put(file, std::uint16_t(version));
    uLongf size = compressBound(body.size());
    std::string packed(size, 0);
    compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(body.data()), body.size());
    file.append(packed, 0, size);
  }
  for (const std::uint64_t offset : offsets) {
    if (version == 4)
      put(file, offset);
    else
      put(file, std::uint32_t(offset));
  }
  put(file, std::uint32_t(2));
  return file;
}

TEST(SerializedMesh, BothVersionsAndPrecisions) {
  for (const int version : {3, 4})
    for (const bool doubles : {false, true}) {
      const std::string file = serialized(version, doubles);
      EXPECT_EQ(read_serialized(file, 0).triangles.size(), 1u);
      const MeshData mesh = read_serialized(file, 1);
      ASSERT_EQ(mesh.triangles.size(), 2u);
      EXPECT_EQ(mesh.triangles[1], (std::array<std::uint32_t, 3>{0, 2, 3}));
      EXPECT_EQ(mesh.positions[2], (Point3{1, 1, 0.5f}));
      EXPECT_EQ(mesh.normals[3], (Normal3{0, 0, 1}));
      EXPECT_EQ(mesh.uvs[2], (Point2{1, 0.25f}));
      EXPECT_THROW(read_serialized(file, 2), Error);
      EXPECT_THROW(read_serialized(serialized(version, doubles, 4), 0), Error);
      for (size_t length = 0; length < file.size(); ++length) EXPECT_THROW(read_serialized(file.substr(0, length), 0), Error);
    }
}

// Mitsuba 3.9: four panes before a white environment give 0.97 with volpath and max_depth 2, and 0.08 with path.
TEST(MitsubaNotes, ThatPanesCountAsSegmentsHere) {
  const std::string pane = "<shape type=\"rectangle\"><bsdf type=\"thindielectric\"/></shape>\n<emitter type=\"constant\"/>";
  const auto told = [&](int depth, const char* type) {
    return import_text(scene(sensor() + integrator(depth, type) + pane)).told();
  };
  EXPECT_NE(told(3, "volpath").find("4:26: passing through a thin dielectric counts"), std::string::npos) << told(3, "volpath");
  EXPECT_EQ(told(3, "path"), "");
  EXPECT_EQ(told(-1, "volpathmis"), "");
}

}  // namespace
}  // namespace etendue::mitsuba_test
