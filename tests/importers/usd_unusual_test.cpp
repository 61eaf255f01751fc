// USD files with parts that are not read: layers of other formats, values of unexpected types; and a reader with limited
// memory.

#include <fstream>
#include <sstream>

#include "support/image_file.h"
#include "usd_support.h"

namespace etendue {
namespace {

using test::y_up;
using UsdUnusual = test::UsdTest;

TEST_F(UsdUnusual, LayersThatCannotBeReadAreLeftOut) {
  folder_.write("m.mtlx", "<?xml version=\"1.0\"?><materialx version=\"1.38\"></materialx>");
  folder_.write("x.abc", "none");
  folder_.write("broken.usda", "#usda 1.0\ndef Sphere {\n");
  // As sublayers, references, payloads, and in a selected and an unselected variant; for the selected one USD itself would
  // report the layer again when it composes the stage.
  std::string sublayers, rest;
  for (const std::string name : {"m.mtlx", "x.abc", "broken.usda"}) {
    const std::string layer = "@" + name + "@", prim = std::string(1, name[0]);
    sublayers += (sublayers.empty() ? "" : ", ") + layer;
    rest += "def Scope \"" + prim + "1\" ( references = " + layer + "</M> ) {\n}\ndef Scope \"" + prim +
            "2\" ( payload = " + layer + "</M> ) {\n}\ndef Scope \"" + prim +
            "3\" (\nvariants = { string v = \"a\" }\nprepend variantSets = \"v\"\n) {\nvariantSet \"v\" = {\n\"a\" ( prepend "
            "references = " +
            layer + "</M> ) {\n}\n\"b\" ( prepend references = " + layer + "</N> ) {\n}\n}\n}\n";
  }
  const Ref<Scene> s = scene("#usda 1.0\n( upAxis = \"Y\"\nsubLayers = [" + sublayers + "] )\ndef Sphere \"s\" {\n}\n" + rest);
  ASSERT_TRUE(s) << error_;
  EXPECT_EQ(s->objects.size(), 1u);
  for (const char* words : {"'m.mtlx' has no material </M>", "'m.mtlx' has no material </N>", "'x.abc' is no USD file",
                            "'broken.usda' cannot be read"})
    EXPECT_TRUE(told(words)) << words;
  EXPECT_EQ(notes_.size(), 4u) << notes_.back();
}

TEST_F(UsdUnusual, ValuesOfOtherTypesAreReadAsWhatTheyStandFor) {
  test::write_image(folder_ / "a.png", {1, 1, 3, NumberType::uint8}, {1, 0, 0});
  const Ref<Scene> s = scene(
      y_up +
      "def Cube \"c\" ( prepend apiSchemas = [\"MaterialBindingAPI\"] ) {\nrel material:binding = </m>\n}\ndef Material \"m\" "
      "{\ntoken outputs:surface.connect = </m/s.outputs:surface>\ndef Shader \"s\" {\nuniform token info:id = "
      "\"UsdPreviewSurface\"\ncolor3f inputs:diffuseColor.connect = </m/t.outputs:rgb>\nfloat[] inputs:roughness = [0.25, "
      "1]\ncolor3f inputs:metallic = (0.5, 0, 0)\nstring inputs:clearcoat = \"much\"\nfloat inputs:emissiveColor = "
      "0.125\ntoken "
      "outputs:surface\n}\ndef Shader \"t\" {\nuniform token info:id = \"UsdUVTexture\"\nasset[] inputs:file = [@a.png@, "
      "@b.png@]\nfloat3 outputs:rgb\n}\n}\ndef Sphere \"round\" {\nfloat[] radius = [3]\n}\ndef Mesh \"none\" {\nint[] "
      "faceVertexCounts = [3]\nint[] faceVertexIndices = [0, 1, 2]\nstring[] points = [\"a\"]\n}\ndef RectLight \"l\" "
      "{\nfloat[] inputs:intensity = [2]\nfloat inputs:color = 0.5\n}\n");
  ASSERT_TRUE(s) << error_;
  for (const char* words : {"'file' of /m/t", "'roughness' of /m/s", "'metallic' of /m/s", "'clearcoat' of /m/s",
                            "'emissiveColor' of /m/s", "'radius' of /round", "/none", "'intensity' of /l", "'color' of /l"})
    EXPECT_TRUE(told(words)) << words;
  const std::string text = written(s);
  for (const char* there :
       {"a.png", "base_metalness: 0.5", "specular_roughness: 0.25", "radius: 3", "rgb(0.125, 0.125, 0.125)"})
    EXPECT_NE(text.find(there), std::string::npos) << there << " is missing in\n" << text;
}

const std::string script = std::string(ETENDUE_SOURCE_DIR) + "/src/components/importers/usd/etendue_usd.py";

std::string text_of(const std::string& path) {
  std::ostringstream all;
  all << std::ifstream(path).rdbuf();
  return all.str();
}

// With limits as on clusters: the process's limits cannot be raised.
TEST_F(UsdUnusual, ALimitOfMemoryIsKept) {
  const char* chosen = std::getenv("ETENDUE_PYTHON");
  const std::string python = chosen && *chosen ? chosen : "python3";
  const std::string file = folder_.write("s.usda", y_up + "def Sphere \"s\" {\n}\n"), out = folder_ / "s.glb",
                    said = folder_ / "said";
  EXPECT_EQ(std::system(("ulimit -v 3500000; ulimit -t 100; " + python + " '" + script + "' '" + file + "' > '" + out +
                         "' 2> '" + said + "'")
                            .c_str()),
            0)
      << text_of(said);
  EXPECT_EQ(text_of(out).substr(0, 4), "glTF");
}

// Whichever of the two packages is missing, the message names both.
TEST(UsdPackages, AreBothNamed) {
  const TemporaryFolder folder;
  const std::string file = folder.write("s.usda", y_up), said = folder / "said";
  for (const std::string missing : {"numpy", "pxr"}) {
    const TemporaryFolder without;
    without.write(missing + ".py", "raise ImportError('none', name='" + missing + "')\n");
    if (missing == "pxr") without.write("numpy.py", "");
    EXPECT_NE(
        std::system(("PYTHONPATH='" + without.path() + "' python3 '" + script + "' '" + file + "' 2> '" + said + "'").c_str()),
        0);
    EXPECT_NE(text_of(said).find("(" + missing + "): pip install usd-core numpy"), std::string::npos) << text_of(said);
  }
}

}  // namespace
}  // namespace etendue
