// Faulty files: the messages and their locations.

#include "pbrt_support.h"

namespace etendue::pbrt_test {
namespace {

void expect_error(const std::string& text, const std::string& told) {
  const Imported i = import_text(text);
  EXPECT_FALSE(i.job) << text.substr(0, 200);
  EXPECT_NE(i.told().find(told), std::string::npos) << text.substr(0, 200) << "\n" << i.told();
}

TEST(PbrtErrors, AreLocated) {
  expect_error("WorldBegin\n  Shape \"spheer\"\n", "2:3: there is no shape 'spheer' (did you mean 'sphere'?)");
  expect_error("WorldBegin\nMateriel \"diffuse\"\n", "2:1: there is no directive 'Materiel' (did you mean 'Material'?)");
  expect_error("WorldBegin\nShape \"sphere\" \"float radius\" [1 2]\n",
               "2:16: 'radius' of Shape \"sphere\" must be one number, not 2");
  expect_error("WorldBegin\nShape \"sphere\" \"float radius\" \"big\"\n", "needs a finite number, not 'big'");
  expect_error("WorldBegin\nShape \"sphere\" \"flaot radius\" 1\n",
               "2:16: there is no parameter type 'flaot' (did you mean 'float'?)");
  expect_error("WorldBegin\nShape \"sphere\" \"float radius\" -1\n", "must be more than 0, not -1");
  expect_error("WorldBegin\nShape \"sphere\" \"float radius\" nan\n", "needs a finite number, not 'nan'");
  expect_error("WorldBegin\nShape \"sphere\" \"float radius\" 1e999\n", "needs a finite number, not '1e999'");
  expect_error("WorldBegin\nTranslate 1 2\nShape \"sphere\"\n", "Translate needs 3 numbers");
  expect_error("Scale 1 0 1\nCamera \"perspective\"\nWorldBegin\n", "2:1: the camera cannot be placed");
  expect_error("WorldBegin\nNamedMaterial \"gold\"\nShape \"sphere\"\n", "3:1: there is no material named 'gold'");
  expect_error("WorldBegin\nMaterial \"diffuse\" \"texture reflectance\" \"t\"\nShape \"sphere\"\n",
               "there is no spectrum texture 't'");
  expect_error("WorldBegin\nAttributeBegin\nTransformEnd\n", "TransformEnd ends the AttributeBegin of line 2");
  expect_error("WorldBegin\nAttributeEnd\n", "AttributeEnd without AttributeBegin");
  expect_error("WorldBegin\nAttributeBegin\n", "2:1: this AttributeBegin has no end");
  expect_error("WorldBegin\nObjectInstance \"tree\"\n", "there is no object named 'tree'");
  expect_error("Shape \"sphere\"\n", "Shape must stand after WorldBegin");
  expect_error("Camera \"perspective\"\n", "there is no WorldBegin");
  expect_error("", "there is no WorldBegin");
  expect_error("WorldBegin\nShape \"sph", "2:7: the string that begins here has no closing '\"'");
  expect_error("WorldBegin\nShape \"sphere\" \"float radius\" [ 1", "2:31: this list has no closing ']'");
}

TEST(PbrtErrors, AllAreTold) {
  const Imported i = import_text("WorldBegin\nShape \"a\"\nShape \"sphere\"\nMateriel \"b\"\nShape \"c\"\n");
  EXPECT_EQ(i.errors.size(), 3u) << i.told();
}

// pbrt searches parameters backwards, from the last one given.
TEST(PbrtErrors, TheLastOfTwoParametersCounts) {
  const Imported i = import_text("Film \"rgb\"\nWorldBegin\nShape \"sphere\" \"float radius\" 2\n\"float radius\" 3\n");
  ASSERT_TRUE(i.job) << i.told();
  EXPECT_EQ(number(object(i, 0), "radius"), 3);
  EXPECT_EQ(i.told(), "3:16: the parameter 'radius' of Shape \"sphere\" is given again: the last one counts, as in pbrt\n");
}

TEST(PbrtErrors, MeshesOfImpossibleIndices) {
  const auto mesh = [](const std::string& indices) {
    return "WorldBegin\nShape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [" + indices + "]\n";
  };
  expect_error(mesh("0 1 3"), "names the vertex 3, but there are 3");
  expect_error(mesh("0 1 -1"), "names the vertex -1");
  expect_error(mesh("0 1 0.5"), "names the vertex 0.5");
  expect_error(mesh("0 1"), "has no triangles");
  expect_error("WorldBegin\nShape \"trianglemesh\" \"point3 P\" [0 0 0 1]\n", "has 4 numbers, which are no multiple of 3");
}

TEST(PbrtErrors, MixturesOfThemselves) {
  expect_error(
      "WorldBegin\nMakeNamedMaterial \"a\" \"string type\" \"mix\" \"string materials\" [\"b\" \"b\"]\n"
      "MakeNamedMaterial \"b\" \"string type\" \"mix\" \"string materials\" [\"a\" \"a\"]\nNamedMaterial \"a\"\nShape "
      "\"sphere\"\n",
      "is a mixture of itself");
}

TEST(PbrtErrors, FilesThatIncludeThemselves) {
  const TemporaryFolder folder;
  folder.write("b.pbrt", "Include \"scene.pbrt\"\n");
  const Imported i = import_text(folder, "WorldBegin\nInclude \"b.pbrt\"\n");
  EXPECT_NE(i.told().find("1:9: 'scene.pbrt' includes itself"), std::string::npos) << i.told();
}

TEST(PbrtErrors, FilesThatIncludeMoreAndMore) {
  const TemporaryFolder folder;
  for (int n = 0; n < 40; ++n) {
    const std::string next = "Include \"" + std::to_string(n + 1) + ".pbrt\"\n";
    folder.write(std::to_string(n) + ".pbrt", next + next);
  }
  folder.write("40.pbrt", "Identity\n");
  const Imported i = import_text(folder, "WorldBegin\nInclude \"0.pbrt\"\n");
  EXPECT_NE(i.told().find("more than 10000 files are included"), std::string::npos) << i.told().substr(0, 2000);
}

TEST(PbrtErrors, FilesOutsideOfTheFolder) {
  const TemporaryFolder outside, folder;
  outside.write("secret.pbrt", "Identity\n");
  const Imported i = import_text(folder, "WorldBegin\nInclude \"" + (outside / "secret.pbrt") + "\"\n");
  EXPECT_NE(i.told().find("--allow-path"), std::string::npos) << i.told();
}

TEST(PbrtErrors, DeepNests) {
  std::string text = "WorldBegin\n";
  for (int i = 0; i < 1'000'000; ++i) text += "AttributeBegin\n";
  expect_error(text, "states nest more than 100000 deep");
}

TEST(PbrtNotes, WhatIsNotUsedIsTold) {
  const Imported i =
      import_text("Film \"rgb\"\nWorldBegin\nShape \"sphere\" \"float radious\" 2\nShape \"sphere\" \"float x\" 1\n");
  EXPECT_NE(i.told().find("3:16: the parameter 'radious' of Shape \"sphere\" is not used (did you mean 'radius'?)"),
            std::string::npos)
      << i.told();
  EXPECT_NE(i.told().find("4:16: the parameter 'x'"), std::string::npos) << i.told();
}

TEST(PbrtNotes, APlainSceneNeedsNone) {
  const Imported i = import_text(
      "LookAt 0 0 -5 0 0 0 0 1 0\nCamera \"perspective\" \"float fov\" 40\nSampler \"zsobol\" \"integer pixelsamples\" 8\n"
      "Integrator \"volpath\"\nFilm \"rgb\" \"string filename\" \"a.exr\"\nWorldBegin\nLightSource \"infinite\"\n"
      "MakeNamedMaterial \"m\" \"string type\" \"coateddiffuse\"\nNamedMaterial \"m\"\nAttributeBegin\nShape \"sphere\"\n"
      "AttributeEnd\nObjectBegin \"o\"\nShape \"sphere\"\nObjectEnd\nTranslate 1 0 0\nObjectInstance \"o\"\nObjectInstance "
      "\"o\"\n");
  EXPECT_EQ(i.told(), "");
  ASSERT_TRUE(i.job);
  EXPECT_EQ(i.job->scene->objects.size(), 4u);
}

}  // namespace
}  // namespace etendue::pbrt_test
