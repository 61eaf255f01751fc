// Textures and colours of the formats that Assimp reads (src/assimp/materials.cpp), and what differs from format to format.

#include <gtest/gtest.h>

#include <filesystem>

#include "blend_support.h"
#include "components/objects/meshes/mesh_data.h"
#include "etendue/importer.h"
#include "etendue/render/job.h"
#include "etendue/scene.h"
#include "support/image_file.h"
#include "support/process.h"
#include "support/render_support.h"

namespace etendue {
namespace {

struct Model {
  Ref<Scene> scene;
  std::string told, written;
};
Model model(const std::string& path) {
  Model result;
  Importing importing(path, {});
  const Ref<Component> read = importer_of(path)->import(importing);
  const Ref<Job> job = ref_cast<Job>(read);
  result.scene = job ? job->scene : ref_cast<Scene>(read);
  for (const Error& note : importing.notes()) result.told += std::string(note.what()) + "\n";
  result.written = write_description(*result.scene);
  return result;
}

/// The part of a description from the first place of a word on.
std::string from(const std::string& text, const std::string& word) {
  const size_t at = text.find(word);
  return at == std::string::npos ? "" : text.substr(at);
}

// A triangle with an image.

std::string direct_x(const std::string& emission) {
  return "xof 0303txt 0032\nFrame Root { FrameTransformMatrix { 1.0,0.0,0.0,0.0, 0.0,1.0,0.0,0.0, 0.0,0.0,1.0,0.0, "
         "0.0,0.0,0.0,1.0;; }\n Mesh p { 3; 0.0;0.0;0.0;, 1.0;0.0;0.0;, 0.0;1.0;0.0;; 1; 3;0,1,2;;\n  MeshMaterialList { 1; 1; "
         "0;; Material { 0.5;0.5;0.5;1.0;; 0.0; 0.0;0.0;0.0;; " +
         emission + ";; TextureFilename { \"c.png\"; } } }\n  MeshTextureCoords { 3; 0.0;0.0;, 1.0;0.0;, 0.0;1.0;; } } }\n";
}
std::string ase(const std::string& color, const std::string& amount) {
  return "*3DSMAX_ASCIIEXPORT 200\n*MATERIAL_LIST {\n *MATERIAL_COUNT 1\n *MATERIAL 0 {\n  *MATERIAL_NAME \"m\"\n"
         "  *MATERIAL_DIFFUSE " +
         color + "\n  *MAP_DIFFUSE {\n   *MAP_AMOUNT " + amount +
         "\n   *BITMAP \"c.png\"\n  }\n }\n}\n*GEOMOBJECT {\n *NODE_NAME \"p\"\n *MESH {\n  *MESH_NUMVERTEX 3\n"
         "  *MESH_NUMFACES 1\n  *MESH_VERTEX_LIST {\n   *MESH_VERTEX 0 0 0 0\n   *MESH_VERTEX 1 1 0 0\n   *MESH_VERTEX 2 0 1 "
         "0\n"
         "  }\n  *MESH_FACE_LIST {\n   *MESH_FACE 0: A: 0 B: 1 C: 2 AB: 1 BC: 1 CA: 1 *MESH_SMOOTHING 1 *MESH_MTLID 0\n  }\n"
         " }\n *MATERIAL_REF 0\n}\n";
}
/// FBX with an embedded Targa image of one texel.
std::string fbx(const std::string& color) {
  return "; FBX 7.4.0 project file\nFBXHeaderExtension:  {\n\tFBXHeaderVersion: 1003\n\tFBXVersion: 7400\n}\nObjects:  {\n"
         "\tGeometry: 1, \"Geometry::\", \"Mesh\" {\n\t\tVertices: *9 {\n\t\t\ta: 0,0,0,1,0,0,0,1,0\n\t\t}\n"
         "\t\tPolygonVertexIndex: *3 {\n\t\t\ta: 0,1,-3\n\t\t}\n\t\tGeometryVersion: 124\n\t\tLayerElementMaterial: 0 {\n"
         "\t\t\tVersion: 101\n\t\t\tName: \"\"\n\t\t\tMappingInformationType: \"AllSame\"\n"
         "\t\t\tReferenceInformationType: \"IndexToDirect\"\n\t\t\tMaterials: *1 {\n\t\t\t\ta: 0\n\t\t\t}\n\t\t}\n"
         "\t\tLayer: 0 {\n\t\t\tVersion: 100\n\t\t\tLayerElement:  {\n\t\t\t\tType: \"LayerElementMaterial\"\n"
         "\t\t\t\tTypedIndex: 0\n\t\t\t}\n\t\t}\n\t}\n\tModel: 2, \"Model::p\", \"Mesh\" {\n\t\tVersion: 232\n\t}\n"
         "\tMaterial: 3, \"Material::m\", \"\" {\n\t\tVersion: 102\n\t\tShadingModel: \"lambert\"\n\t\tMultiLayer: 0\n"
         "\t\tProperties70:  {\n\t\t\tP: \"DiffuseColor\", \"Color\", \"\", \"A\"," +
         color +
         "\n\t\t}\n\t}\n\tVideo: 4, \"Video::v\", \"Clip\" {\n\t\tType: \"Clip\"\n\t\tFilename: \"c.tga\"\n"
         "\t\tRelativeFilename: \"c.tga\"\n\t\tContent: , \"AAACAAAAAAAAAAAAAQABABgAEBAQ\"\n\t}\n"
         "\tTexture: 5, \"Texture::t\", \"\" {\n\t\tType: \"TextureVideoClip\"\n\t\tVersion: 202\n"
         "\t\tTextureName: \"Texture::t\"\n\t\tFileName: \"c.tga\"\n\t\tRelativeFilename: \"c.tga\"\n\t}\n}\n"
         "Connections:  {\n\tC: \"OO\",2,0\n\tC: \"OO\",1,2\n\tC: \"OO\",3,2\n\tC: \"OP\",5,3, \"DiffuseColor\"\n"
         "\tC: \"OO\",4,5\n}\n";
}
std::string collada(const std::string& channel) {
  return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1"/><up_axis>Y_UP</up_axis></asset>
<library_images><image id="i"><init_from>c.png</init_from></image></library_images>
<library_effects><effect id="e"><profile_COMMON><newparam sid="f"><surface type="2D"><init_from>i</init_from></surface></newparam>
<newparam sid="s"><sampler2D><source>f</source></sampler2D></newparam><technique sid="c"><lambert><diffuse><texture texture="s"
texcoord=")" +
         channel + R"("/></diffuse></lambert></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="9">0 0 0 1 0 0 0 1 0</float_array>
<technique_common><accessor source="#a" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source><source id="t"><float_array id="b" count="6">0 0 1 0 0 1
</float_array><technique_common><accessor source="#b" count="3" stride="2"><param name="S" type="float"/>
<param name="T" type="float"/></accessor></technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/>
</vertices><triangles count="1" material="m"><input semantic="VERTEX" source="#v" offset="0"/><input semantic="TEXCOORD"
source="#t" offset="0" set="0"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="w"><node><instance_geometry url="#g"><bind_material><technique_common>
<instance_material symbol="m" target="#m"/></technique_common></bind_material></instance_geometry></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#w"/></scene></COLLADA>)";
}

class AssimpMaterials : public testing::Test {
 protected:
  void SetUp() override { test::write_image(folder_ / "c.png", {1, 1, 3, NumberType::uint8}, {0.2f, 0.4f, 0.6f}); }
  const TemporaryFolder folder_;
};

// 3ds Max writes the number of its map channel, which counts from 1, whatever set of coordinates the meshes have.
TEST_F(AssimpMaterials, SetsOfCoordinatesThatNoMeshHasAreTheFirst) {
  for (const char* channel : {"CHANNEL0", "CHANNEL1", "TEX1", "UVSET7"}) {
    const Model m = model(folder_.write("c.dae", collada(channel)));
    EXPECT_NE(m.written.find("c.png"), std::string::npos) << channel;
    EXPECT_EQ(m.written.find("TEXCOORD_"), std::string::npos) << m.written;
  }
}

// The fixed functions of Direct3D multiply emitted light by the texture too.
TEST_F(AssimpMaterials, EmissionHasTheTextureOfTheColor) {
  const Model shining = model(folder_.write("c.x", direct_x("0.3;0.3;0.3")));
  EXPECT_NE(from(shining.written, "emission: DiffuseEmission").find("c.png"), std::string::npos) << shining.written;
  const Model dark = model(folder_.write("d.x", direct_x("0.0;0.0;0.0")));
  EXPECT_EQ(dark.written.find("emission: DiffuseEmission"), std::string::npos) << dark.written;
}

// In 3ds Max and FBX the colour beside a texture has no effect; it is used where the image cannot be read.
TEST_F(AssimpMaterials, TexturesReplaceTheColorOf3dsMax) {
  const auto written = [&](const std::string& name, const std::string& text) {
    return model(folder_.write(name, text)).written;
  };
  const std::string white = written("a.ase", ase("1 1 1", "1.0"));
  EXPECT_NE(white.find("c.png"), std::string::npos) << white;
  EXPECT_EQ(written("a.ase", ase("0.5 0.25 0.125", "1.0")), white);
  EXPECT_EQ(written("a.fbx", fbx("0.5,0.25,0.125")), written("a.fbx", fbx("1,1,1")));
  EXPECT_NE(model(folder_.write("a.ase", ase("1 1 1", "0.8"))).told.find("by an amount below 100 %"), std::string::npos);
  std::filesystem::remove(folder_ / "c.png");
  const std::string without = written("a.ase", ase("0.5 0.25 0.125", "1.0"));
  EXPECT_NE(without.find("base_color: rgb(0.5, 0.25, 0.125)"), std::string::npos) << without;
}

// Targa files begin with no bytes of their own, so that the name's ending decides.
TEST_F(AssimpMaterials, EmbeddedTargaImagesAreRead) {
  const Model m = model(folder_.write("t.fbx", fbx("1,1,1")));
  EXPECT_NE(m.written.find("images[0].tga"), std::string::npos) << m.written << m.told;
  EXPECT_EQ(m.told.find("image"), std::string::npos) << m.told;
}

// Assimp leaves Blender's z upwards, and takes the bytes of its colours, which its own renderer does not use, for signed ones.
TEST_F(AssimpMaterials, BlendersUpwardsAxisAndColors) {
  const Model m = model(folder_.write("t.blend", blend_test::triangle({0, 0, 0, 1, 0, 0, 0, 0, 2})));
  EXPECT_NE(m.told.find("colours of vertices of Blender are left out"), std::string::npos) << m.told;
  EXPECT_EQ(m.written.find("AttributeMap"), std::string::npos) << m.written;
  Bounds3 box;
  for (const Ref<SceneObject>& object : m.scene->objects) {
    prepare_tree(*object);
    if (!object->infinite()) box.add(object->bounds());
  }
  EXPECT_NEAR(box.high.y, 2, 1e-5);
  EXPECT_NEAR(box.high.z, 0, 1e-5);
}

}  // namespace
}  // namespace etendue
