// Errors of which version 3 of pbrt only warns: they are read as it reads them, and reported; version 4 stops at them.

#include "pbrt_support.h"

namespace etendue::pbrt_test {
namespace {

/// A scene of version 3 whose third line begins with `world`.
Imported lenient(const std::string& world) {
  return import_text("Film \"image\" \"integer xresolution\" 1 \"integer yresolution\" 1\nWorldBegin\n" + world +
                     "\nWorldEnd\n");
}
testing::AssertionResult tells(const Imported& i, const std::string& words) {
  if (!i.job) return testing::AssertionFailure() << "refused: " << i.told();
  return (i.told().find(words) != std::string::npos ? testing::AssertionSuccess() : testing::AssertionFailure()) << i.told();
}
size_t objects(const Imported& i) { return i.job ? i.job->scene->objects.size() : 99; }

const std::string sphere = "Shape \"sphere\"\n";

TEST(PbrtLenient, WhatStandsBehindNumbers) {
  const Imported i = import_text(
      "LookAt 0, 1, 4  0, 0, 0  0 1 0\nCamera \"perspective\"\nFilm \"image\"\nWorldBegin\n"
      "Material \"matte\" \"rgb Kd\" [0.43, 0.2, 0.1]\nShape \"sphere\" \"float radius\" [2.5f]\n");
  EXPECT_TRUE(tells(i, "1:8: a comma behind a number says nothing, as in version 3 of pbrt (and at 5 more places)"));
  EXPECT_TRUE(tells(i, "6:32: what stands behind a number without a blank is not read"));
  EXPECT_EQ(number(object(i, 0), "radius"), 2.5);
  const Imported strict = import_text("Film \"rgb\"\nWorldBegin\nShape \"sphere\" \"float radius\" [2,]\n");
  EXPECT_FALSE(strict.job);
  EXPECT_NE(strict.told().find("3:32: \"float radius\" needs a finite number, not '2,'"), std::string::npos) << strict.told();
  EXPECT_FALSE(import_text("Film \"image\"\nWorldBegin\nShape \"sphere\" \"float radius\" [1 , 2]\n").job);  // nor in version 3
}

TEST(PbrtLenient, UnknownThings) {
  const Imported material = lenient("Material \"iridescence\" \"rgb Kd\" [.2 .2 .2]\n" + sphere);
  EXPECT_TRUE(tells(material, "3:1: there is no material 'iridescence'"));
  EXPECT_TRUE(tells(material, "it is 'matte', as by version 3 of pbrt"));
  EXPECT_EQ(part(object(material, 0), "shader").class_info().name, "Lambertian");
  const Imported shape = lenient("Shape \"teapot\" \"float size\" 2\n" + sphere);
  EXPECT_TRUE(tells(shape, "3:1: there is no shape 'teapot': it is left out, as by version 3 of pbrt"));
  EXPECT_EQ(objects(shape), 1u);
  const Imported light = lenient("LightSource \"laser\" \"rgb I\" [1 1 1]\n" + sphere);
  EXPECT_TRUE(tells(light, "3:1: there is no light 'laser'"));
  EXPECT_EQ(objects(light), 1u);
  const Imported area = lenient("AreaLightSource \"diffuse\"\nAreaLightSource \"neon\"\n" + sphere);
  EXPECT_TRUE(tells(area, "4:1: there is no area light 'neon'"));
  EXPECT_FALSE(area.job->scene->objects.at(0)->emission);
  EXPECT_TRUE(
      tells(lenient("NamedMaterial \"gold\"\n" + sphere), "3:1: there is no material named 'gold': the one before stays"));
  EXPECT_TRUE(tells(lenient("Material \"mix\" \"string namedmaterial1\" \"a\" \"string namedmaterial2\" \"b\"\n" + sphere),
                    "3:1: there is no material named 'b': it is 'matte'"));
  EXPECT_TRUE(tells(lenient("ObjectInstance \"tree\"\n" + sphere), "3:1: there is no object named 'tree'"));
  EXPECT_TRUE(tells(lenient("AttributeEnd\n" + sphere), "3:1: AttributeEnd without AttributeBegin"));
  EXPECT_TRUE(tells(lenient("Sampler \"halton\" \"integer pixelsamples\" 4\n" + sphere), "3:1: Sampler must stand before"));
  EXPECT_TRUE(tells(lenient("Shape \"sphere\" \"flaot radius\" 2"), "3:16: there is no parameter type 'flaot'"));
  EXPECT_TRUE(
      tells(lenient("Shape \"sphere\" \"float radious\" 2"), "3:16: the parameter 'radious' of Shape \"sphere\" is not used"));
}

TEST(PbrtLenient, Textures) {
  const Imported late = lenient(
      "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [0 0 0 1 0 0 0 1 0] \"texture alpha\" "
      "\"holes\"\nTexture \"holes\" \"float\" \"constant\" \"float value\" 0\n");
  EXPECT_TRUE(tells(late, "there is no float texture 'holes': 'alpha' is 1, as by version 3 of pbrt"));
  const Imported kd = lenient("Material \"matte\" \"texture Kd\" \"wood\"\n" + sphere);
  EXPECT_TRUE(tells(kd, "3:18: there is no spectrum texture 'wood': 'Kd' is 0.5"));
  const Imported unknown = lenient("Texture \"t\" \"spectrum\" \"plaid\"\nTexture \"t\" \"vector\" \"constant\"\n" + sphere);
  EXPECT_TRUE(tells(unknown, "3:1: there is no texture 'plaid'"));
  EXPECT_TRUE(tells(unknown, "4:1: a texture is of float or spectrum, not of 'vector'"));
}

TEST(PbrtLenient, ValuesThatDoNotFit) {
  EXPECT_TRUE(tells(lenient("Shape \"sphere\" \"float radius\" []"), "3:16: \"float radius\" holds nothing: it is left out"));
  EXPECT_TRUE(
      tells(lenient("Shape \"sphere\" \"float radius\" [1 2]"), "must be one number, not 2: it is as if it were not given"));
  EXPECT_TRUE(tells(lenient("Shape \"sphere\" \"float radius\" \"big\""), "3:16: \"float radius\" needs numbers, not texts"));
  EXPECT_TRUE(tells(lenient("Material \"matte\" \"rgb Kd\" [.1 .2 .3 .4]\n" + sphere), "3:18: \"rgb Kd\" takes numbers by 3"));
  EXPECT_TRUE(tells(lenient("Material \"matte\" \"float sigma\" [20 30]\n" + sphere), "the first counts"));
  EXPECT_TRUE(
      tells(lenient("Material \"glass\" \"bool remaproughness\" \"yes\"\n" + sphere), "'yes' is neither true nor false"));
  EXPECT_TRUE(
      tells(lenient("Shape \"loopsubdiv\" \"integer nlevels\" 1.5 \"integer indices\" [0 1 2] \"point P\" [0 0 0 1 0 0 0 1 0]"),
            "must be a whole number, not 1.5: what is behind the point is left out"));
  const std::string mesh = "Shape \"trianglemesh\" \"point P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" ";
  const Imported beyond = lenient(mesh + "[0 1 3]\n" + sphere);
  EXPECT_TRUE(tells(beyond, "names the vertex 3, but there are 3, counted from 0: it is left out"));
  EXPECT_EQ(objects(beyond), 1u);
}

// Missing files; version 4 stops at them.
TEST(PbrtLenient, MissingFiles) {
  const std::string mesh = "Shape \"plymesh\" \"string filename\" \"gone.ply\"\n";
  const Imported i = lenient(mesh + "LightSource \"point\" \"spectrum I\" \"gone.spd\"\n" + sphere);
  EXPECT_TRUE(tells(i, "there is no file 'gone.ply': it is left out, as by version 3 of pbrt"));
  EXPECT_TRUE(tells(i, "4:21: there is no file 'gone.spd': 'I' is black, as by version 3 of pbrt"));
  EXPECT_GE(objects(i), 1u);
  // An index of 0 would be meaningless: a metal without its files is copper.
  const Imported metal =
      lenient("Material \"metal\" \"spectrum eta\" \"gone.eta.spd\" \"spectrum k\" \"gone.k.spd\"\n" + sphere);
  EXPECT_TRUE(tells(metal, "there is no file 'gone.eta.spd': that of copper is taken"));
  const Imported strict = import_text("Film \"rgb\"\nWorldBegin\n" + mesh);
  EXPECT_FALSE(strict.job);
  EXPECT_NE(strict.told().find("there is no file 'gone.ply'"), std::string::npos) << strict.told();
}

// A lamp whose diffuse Kd holds its emission.
TEST(PbrtLenient, SpectraThatReflectMoreThanArrives) {
  const Imported i = lenient("Material \"matte\" \"spectrum Kd\" [400 0 500 8 600 15.6 700 18.4]\n" + sphere);
  EXPECT_TRUE(tells(i, "3:18: 'Kd' is at most 1 here: more light would leave than arrives"));
  const Value inner = get(**get(part(object(i, 0), "shader"), "color").as<Ref<Component>>(), "value");
  EXPECT_NEAR((*inner.as<Color>())->at(410, ColorUse::reflectance), 0.8f, 1e-3f);
  EXPECT_EQ((*inner.as<Color>())->at(600, ColorUse::reflectance), 1);
}

// A last value without a partner is left out, and wavelengths may be in any order.
TEST(PbrtLenient, OddSpectra) {
  const auto kd = [](const Imported& i, float nm) {
    const Value v = get(part(object(i, 0), "shader"), "color");
    const Value inner = get(**v.as<Ref<Component>>(), "value");
    return (*inner.as<Color>())->at(nm, ColorUse::reflectance);
  };
  const Imported odd = lenient("Material \"matte\" \"spectrum Kd\" [400 .2 700 .8 900]\n" + sphere);
  EXPECT_TRUE(tells(odd, "3:18: \"spectrum Kd\" takes numbers by 2: the last are left out"));
  EXPECT_NEAR(kd(odd, 550), 0.5f, 1e-3f);
  const Imported unsorted = lenient("Material \"matte\" \"spectrum Kd\" [700 .8 400 .2]\n" + sphere);
  ASSERT_TRUE(unsorted.job) << unsorted.told();
  EXPECT_NEAR(kd(unsorted, 550), 0.5f, 1e-3f);
  EXPECT_NEAR(kd(unsorted, 370), 0.2f, 1e-3f);
}

// A shape's parameters override those of its material, for this shape alone.
TEST(PbrtLenient, ShapesChangeTheirMaterial) {
  const Imported i = lenient("Material \"matte\" \"rgb Kd\" [.2 .2 .2]\nShape \"sphere\" \"rgb Kd\" [.6 .6 .6]\n" + sphere +
                             "Shape \"sphere\" \"rgb Kd\" [.6 .6 .6]\nTexture \"t\" \"float\" \"constant\" \"float value\" 20\n"
                             "Shape \"sphere\" \"float radius\" 2 \"texture sigma\" \"t\"\n");
  ASSERT_TRUE(i.job) << i.told();
  const auto color = [&](size_t of) { return number(part(object(i, of), "shader"), "color"); };
  EXPECT_NEAR(color(0), 0.6, 0.01);
  EXPECT_NEAR(color(1), 0.2, 0.01);
  EXPECT_EQ(&part(object(i, 0), "shader"), &part(object(i, 2), "shader"));
  EXPECT_EQ(part(object(i, 3), "shader").class_info().name, "OrenNayar");
  EXPECT_NEAR(color(3), 0.2, 0.01);
  EXPECT_EQ(i.told().find("not used"), std::string::npos) << i.told();
}

}  // namespace
}  // namespace etendue::pbrt_test
