// Models that other libraries (Assimp, USD) read in a process of their own: small models written here, and those of the
// validation data, whose numbers of triangles come from another program or from the file itself.

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "components/objects/meshes/mesh_data.h"
#include "etendue/describe/color.h"
#include "etendue/importer.h"
#include "etendue/render/job.h"
#include "etendue/scene.h"
#include "files/regular_file.h"
#include "support/process.h"
#include "support/render_support.h"

namespace etendue {
namespace {

namespace fs = std::filesystem;

struct Model {
  Ref<Scene> scene;
  std::vector<std::string> notes;
  std::string error;  ///< empty if it was read
};

Model model(const std::string& path) {
  Model result;
  try {
    Importing importing(path, {});
    const Ref<Component> read = importer_of(path)->import(importing);
    const Ref<Job> job = ref_cast<Job>(read);
    result.scene = job ? job->scene : ref_cast<Scene>(read);
    for (const Error& note : importing.notes()) result.notes.emplace_back(note.what());
  } catch (const Errors& errors) {
    result.error = errors.what();
    for (const Error& error : errors.errors) EXPECT_TRUE(error.location.known()) << error.what();
  } catch (const Error& error) {
    result.error = error.what();
    EXPECT_STREQ(error.location.file, path.c_str()) << error.what();
  }
  return result;
}

/// The triangles of all meshes; a mesh that is placed several times counts once.
size_t triangles(const Scene& scene, std::set<std::string>& counted) {
  size_t count = 0;
  for (const Ref<SceneObject>& object : scene.objects) {
    if (object->class_info().name == "TriangleMesh") {
      const Value file = get(*object, "file"), part = get(*object, "part");
      if (!counted.insert(*part.as<std::string>()).second) continue;
      count += read_mesh(file.as<FilePath>()->resolved(), *part.as<std::string>()).triangles.size();
    }
    prepare_tree(*object);
    if (const Scene* inner = scene_within(*object)) count += triangles(*inner, counted);
  }
  return count;
}
size_t triangles(const Scene& scene) {
  std::set<std::string> counted;
  return triangles(scene, counted);
}

Bounds3 bounds(const Scene& scene) {
  Bounds3 all;
  for (const Ref<SceneObject>& object : scene.objects) {
    prepare_tree(*object);
    if (!object->infinite()) all.add(object->bounds());
  }
  return all;
}

// A pyramid over the square from (-1, -1, 0) to (1, 1, 0), with its top at (0, 0, 2): four triangles without the square below.

const std::string collada =
    R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1"/><up_axis>Y_UP</up_axis></asset>
<library_effects><effect id="e"><profile_COMMON><technique sid="c"><lambert><diffuse><color>0.8 0.2 0.1 1</color></diffuse></lambert>
</technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="15">-1 -1 0 1 -1 0 1 1 0 -1 1 0 0 0 2</float_array>
<technique_common><accessor source="#a" count="5" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4" material="m"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 4 1 2 4 2 3 4 3 0 4</p></triangles></mesh></geometry>
</library_geometries><library_visual_scenes><visual_scene id="w"><node><instance_geometry url="#g"><bind_material><technique_common>
<instance_material symbol="m" target="#m"/></technique_common></bind_material></instance_geometry></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#w"/></scene></COLLADA>)";

const std::string direct_x = R"(xof 0303txt 0032
Frame Root { FrameTransformMatrix { 1.0,0.0,0.0,0.0, 0.0,1.0,0.0,0.0, 0.0,0.0,1.0,0.0, 0.0,0.0,0.0,1.0;; }
 Mesh p { 5; -1.0;-1.0;0.0;, 1.0;-1.0;0.0;, 1.0;1.0;0.0;, -1.0;1.0;0.0;, 0.0;0.0;2.0;;
  4; 3;0,1,4;, 3;1,2,4;, 3;2,3,4;, 3;3,0,4;; } }
)";

const std::string ac3d =
    "AC3Db\nMATERIAL \"paint\" rgb 0.8 0.2 0.1 amb 0 0 0 emis 0 0 0 spec 0 0 0 shi 0 trans 0\nOBJECT world\nkids 1\nOBJECT "
    "poly\n"
    "name \"p\"\nnumvert 5\n-1 -1 0\n1 -1 0\n1 1 0\n-1 1 0\n0 0 2\nnumsurf 4\nSURF 0x20\nmat 0\nrefs 3\n0 0 0\n1 0 0\n4 0 0\n"
    "SURF 0x20\nmat 0\nrefs 3\n1 0 0\n2 0 0\n4 0 0\nSURF 0x20\nmat 0\nrefs 3\n2 0 0\n3 0 0\n4 0 0\n"
    "SURF 0x20\nmat 0\nrefs 3\n3 0 0\n0 0 0\n4 0 0\nkids 0\n";

std::string ase() {
  std::string text =
      "*3DSMAX_ASCIIEXPORT 200\n*GEOMOBJECT {\n *NODE_NAME \"p\"\n *MESH {\n  *MESH_NUMVERTEX 5\n  *MESH_NUMFACES 4\n"
      "  *MESH_VERTEX_LIST {\n   *MESH_VERTEX 0 -1 -1 0\n   *MESH_VERTEX 1 1 -1 0\n   *MESH_VERTEX 2 1 1 0\n"
      "   *MESH_VERTEX 3 -1 1 0\n   *MESH_VERTEX 4 0 0 2\n  }\n  *MESH_FACE_LIST {\n";
  for (int i = 0; i < 4; ++i)
    text += "   *MESH_FACE " + std::to_string(i) + ": A: " + std::to_string(i) + " B: " + std::to_string((i + 1) % 4) +
            " C: 4 AB: 1 BC: 1 CA: 1 *MESH_SMOOTHING 1 *MESH_MTLID 0\n";
  return text + "  }\n }\n}\n";
}

template <class T>
std::string bytes(std::initializer_list<T> values) {
  std::string all;
  for (const T value : values) all.append(reinterpret_cast<const char*>(&value), sizeof value);
  return all;
}
/// A chunk of a 3D Studio file: kind, length, content.
std::string chunk(std::uint16_t kind, const std::string& content) {
  return bytes<std::uint16_t>({kind}) + bytes<std::uint32_t>({std::uint32_t(6 + content.size())}) + content;
}
std::string studio_3d() {
  const std::string points =
      chunk(0x4110, bytes<std::uint16_t>({5}) + bytes<float>({-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0, 0, 0, 2}));
  const std::string faces = chunk(0x4120, bytes<std::uint16_t>({4, 0, 1, 4, 7, 1, 2, 4, 7, 2, 3, 4, 7, 3, 0, 4, 7}));
  const std::string object = chunk(0x4000, std::string("p") + '\0' + chunk(0x4100, points + faces));
  return chunk(0x4D4D, chunk(0x0002, bytes<std::uint32_t>({3})) + chunk(0x3D3D, object));
}

const std::string usd = R"(#usda 1.0
( defaultPrim = "p"
  upAxis = "Y"
  metersPerUnit = 1 )
def Mesh "p" {
  int[] faceVertexCounts = [3, 3, 3, 3]
  int[] faceVertexIndices = [0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4]
  point3f[] points = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0), (0, 0, 2)]
  uniform token subdivisionScheme = "none"
}
)";

fs::path data() { return fs::path(ETENDUE_SOURCE_DIR) / "../shared/validation/import"; }

void expect_pyramid(const Model& m) {
  ASSERT_EQ(m.error, "");
  EXPECT_EQ(triangles(*m.scene), 4u);
  // The orientation of the axes depends on the format: the pyramid's bounding box has the sides 2, 2 and 2 in any case.
  const Vector3 size = bounds(*m.scene).diagonal();
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(size[k], 2, 1e-4) << k;
}

TEST(ForeignModels, APyramidOfEachFormat) {
  const TemporaryFolder folder;
  for (const auto& [name, text] : {std::pair<std::string, std::string>{"p.dae", collada},
                                   {"p.x", direct_x},
                                   {"p.ac", ac3d},
                                   {"p.ase", ase()},
                                   {"p.3ds", studio_3d()}}) {
    SCOPED_TRACE(name);
    expect_pyramid(model(folder.write(name, text)));
  }
}

TEST(ForeignModels, AColourIsTheBaseColour) {
  const TemporaryFolder folder;
  const Model m = model(folder.write("p.dae", collada));
  ASSERT_EQ(m.error, "");
  const std::string written = write_description(*m.scene);
  EXPECT_NE(written.find("base_color: rgb(0.800000011920929, 0.20000000298023224, 0.10000000149011612)"), std::string::npos)
      << written;
}

TEST(ForeignModels, AseInUtf16) {
  const TemporaryFolder folder;
  std::string wide = "\xff\xfe";
  for (const char c : ase()) wide += {c, '\0'};
  expect_pyramid(model(folder.write("p.ase", wide)));
}

// The library adds highlights to a Lambertian surface; they are removed.
TEST(ForeignModels, LambertianSurfacesDoNotShine) {
  const TemporaryFolder folder;
  const Model m = model(folder.write("p.dae", collada));
  ASSERT_EQ(m.error, "");
  const std::string written = write_description(*m.scene);
  EXPECT_NE(written.find("specular_weight: 0\n"), std::string::npos) << written;
}

/// A box as FBX text, with more objects in it and another unit of length.
std::string box_of_fbx(double unit, const std::string& objects, const std::string& connections) {
  std::string text = read_regular_file((data() / "fbx/embedded_ascii/box.FBX").string());
  const std::string stated = "\"UnitScaleFactor\", \"double\", \"Number\", \"\",100";
  text.replace(text.find(stated) + stated.size() - 3, 3, std::to_string(unit));
  text.insert(text.find("\tMaterial: 2669981279872"), objects);
  return text.insert(text.find("Connections:  {") + 15, connections);
}

// Lights have no unit of length in FBX: the middle is lit as the colour says, however long a unit is.
TEST(ForeignModels, LightsOfFbxDoNotDependOnTheUnit) {
  if (!fs::exists(data() / "fbx/embedded_ascii/box.FBX")) GTEST_SKIP() << "no validation data";
  const std::string light =
      "\tNodeAttribute: 111, \"NodeAttribute::Lamp\", \"Light\" {\n\t\tTypeFlags: \"Light\"\n\t\tProperties70:  {\n\t\t\tP: "
      "\"Color\", \"Color\", \"\", \"A\",1,1,1\n\t\t}\n\t}\n\tModel: 222, \"Model::Lamp\", \"Light\" {\n\t\tVersion: "
      "232\n\t\tProperties70:  {\n\t\t\tP: \"Lcl Translation\", \"Lcl Translation\", \"\", \"A\",0,300,0\n\t\t}\n\t}\n";
  const auto intensity = [&](double unit) {
    const TemporaryFolder folder;
    const Model m = model(folder.write("box.fbx", box_of_fbx(unit, light, "\n\tC: \"OO\",222,0\n\tC: \"OO\",111,222\n")));
    EXPECT_EQ(m.error, "");
    for (const Ref<SceneObject>& object : m.scene->objects)
      if (object->class_info().name == "Point") {
        const Value emission = get(*object, "emission"), map = get(**emission.as<Ref<Component>>(), "radiance");
        const Value value = get(**map.as<Ref<Component>>(), "value");
        if (const Color* c = value.as<Color>()) return double((*c)->at(550, ColorUse::radiance));
      }
    return 0.0;
  };
  const double metres = intensity(100);
  EXPECT_GT(metres, 0);
  EXPECT_NEAR(intensity(1) / metres, 1e-4, 1e-7);
}

// An image of metalness alone, for which glTF has no place, is kept; where it cannot be read, nothing becomes metal.
TEST(ForeignModels, ImagesOfMetalOfFbx) {
  if (!fs::exists(data() / "fbx/embedded_ascii/box.FBX")) GTEST_SKIP() << "no validation data";
  const std::string line = "\n\tC: \"OP\",2669981291872,2669981279872, \"ReflectionFactor\"\n";
  const TemporaryFolder folder;
  const Model m = model(folder.write("box.fbx", box_of_fbx(100, "", line)));
  ASSERT_EQ(m.error, "");
  const std::string written = write_description(*m.scene);
  EXPECT_EQ(written.find("base_metalness: 1"), std::string::npos) << written;
}

TEST(ForeignModels, WhatIsDamagedIsRefusedByName) {
  const TemporaryFolder folder;
  for (const auto& [name, text] : {std::pair<std::string, std::string>{"p.dae", collada.substr(0, 900)},
                                   {"p.3ds", "no 3ds at all"},
                                   {"p.x", "xof"},
                                   {"p.fbx", ""},
                                   {"p.blend", "BLENDER-v999"},
                                   {"p.lwo", "FORM"}}) {
    const Model m = model(folder.write(name, text));
    EXPECT_FALSE(m.error.empty()) << name;
  }
}

TEST(ForeignModels, ImagesOutsideOfTheFolderAreNotRead) {
  const TemporaryFolder folder;
  fs::create_directories(folder / "inner");
  folder.write("secret.png", "no picture");
  std::string text = collada;
  const std::string plain = "<diffuse><color>0.8 0.2 0.1 1</color></diffuse>";
  text.replace(text.find(plain), plain.size(), R"(<diffuse><texture texture="s" texcoord="UV"/></diffuse>)");
  const std::string technique = "<technique sid";
  text.insert(text.find(technique), R"(<newparam sid="f"><surface type="2D"><init_from>i</init_from></surface></newparam>
<newparam sid="s"><sampler2D><source>f</source></sampler2D></newparam>)");
  text.insert(text.find("<library_effects>"),
              R"(<library_images><image id="i"><init_from>../secret.png</init_from></image></library_images>)");
  const Model m = model(folder.write("inner/p.dae", text));
  ASSERT_EQ(m.error, "");
  EXPECT_TRUE(std::ranges::any_of(m.notes, [](const std::string& n) { return n.find("--allow-path") != std::string::npos; }))
      << (m.notes.empty() ? "nothing was told" : m.notes[0]);
}

TEST(ForeignModels, UsdNeedsItsLibraryAndSaysSo) {
  const TemporaryFolder folder;
  const std::string path = folder.write("p.usda", usd);
  const Model m = model(path);
  if (!m.error.empty()) {
    EXPECT_NE(m.error.find("pip install usd-core"), std::string::npos) << m.error;
    GTEST_SKIP() << "usd-core is not installed";
  }
  expect_pyramid(m);
}

TEST(ForeignModels, ImportedInADescriptionAsOnTheirOwn) {
  const TemporaryFolder folder;
  folder.write("p.x", direct_x);
  const auto seen = [&](const std::string& object) {
    return test::measure(load_job_text(test::job_text("AmbientOcclusionRenderer { samples: 16, rays: 1 }",
                                                      "PerspectiveCamera { from: [0, 1, 9], to: [0, 0, 1] }", 16, object),
                                       "t.etd", folder.path()));
  };
  const std::string list =
      "TriangleMesh { positions: [-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0, 0, 0, 2] m, triangles: [0, 1, 4, 1, 2, 4, "
      "2, 3, 4, 3, 0, 4], shader: Lambertian {} }";
  const double model_mean = seen("Import { file: \"p.x\" }").mean.y;
  EXPECT_GT(model_mean, 0.01);
  // These files have z pointing away from the viewer (x to the right, y upwards): the top is behind, and the inside of the
  // pyramid is seen.
  const double turned = seen("Instance { scene: EmbreeScene { objects: [" + list + "] }, transform: scale(1, 1, -1) }").mean.y;
  EXPECT_NEAR(model_mean, turned, 0.01);
  EXPECT_GT(seen(list).mean.y, turned + 0.02) << "nothing is hidden from the outside of a pyramid";
}

// ---- the validation data --------------------------------------------------------------------------------------------------

TEST(ForeignModels, HaveTheTrianglesThatTheirFilesHold) {
  if (!fs::exists(data() / "expected.csv")) GTEST_SKIP() << "no validation data";
  // The program that made the table joined meshes of the same shape and left out faces with a corner twice before it counted:
  // the files hold more.
  const std::map<std::string, size_t> held = {
      {"3ds/test1.3ds", 108},                           // nine boxes (nine objects of 12 faces), of which five shapes differ
      {"ase/MotionCaptureROM.ase", 2016},               // the sum of its *MESH_NUMFACES; two feet and two toes are alike
      {"fbx/cubes_with_mirroring_and_pivot.fbx", 420},  // four geometries: three cubes and one of 192 squares
      {"fbx/cubes_with_names.fbx", 420},
      {"fbx/cubes_with_outofrange_float.fbx", 420},
      {"fbx/spider.fbx", 1368}};
  std::ifstream table(data() / "expected.csv");
  const std::set<std::string> formats = {"3ds", "ase", "dae", "fbx", "lwo", "lws"};  // the others have importers of our own
  int compared = 0;
  for (std::string line; std::getline(table, line);) {
    std::istringstream fields(line);
    std::string file, meshes, count;
    if (line.starts_with("#") || !std::getline(fields, file, ',') || !std::getline(fields, meshes, ',') ||
        !std::getline(fields, count, ',') || count == "0" || !formats.contains(file.substr(0, file.find('/'))))
      continue;
    const auto own = held.find(file);
    const Model m = model((data() / file).string());
    if (line.find("5.2.5") != std::string::npos && (!m.error.empty() || triangles(*m.scene) == 0))
      continue;  // the library here fails as that version did
    ASSERT_EQ(m.error, "") << file;
    EXPECT_EQ(triangles(*m.scene), own != held.end() ? own->second : std::stoul(count)) << file;
    ++compared;
  }
  EXPECT_GT(compared, 30);
}

TEST(ForeignModels, BrokenOnesAreRefusedByName) {
  if (!fs::exists(data() / "broken")) GTEST_SKIP() << "no validation data";
  for (const auto& entry : fs::directory_iterator(data() / "broken")) {
    if (entry.path().extension() == ".bin") continue;  // referred to by a .gltf
    const TemporaryFolder folder;
    Process check(ETENDUE_BINARY_DIR "/etendue", {"check", entry.path().string()}, folder);
    EXPECT_EQ(check.wait(), 2) << entry.path();
    EXPECT_NE(check.err().find(entry.path().filename().string()), std::string::npos) << check.err();
  }
}

}  // namespace
}  // namespace etendue
