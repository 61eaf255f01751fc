// Which side of a shape is its front in pbrt: it determines the inside of a body, the side that emits, and the effect of holes
// (alpha).

#include "pbrt_support.h"
#include "support/image_file.h"

namespace etendue::pbrt_test {
namespace {

const std::string sky = "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";

// A bubble: with reversed orientation the glass is outside, and its index relative to the other side is the inverse.
TEST(PbrtFront, ReversedQuadricsHaveTheirIndexOutside) {
  const auto shader = [](const std::string& world) -> const Component& {
    static Imported i;
    i = import_text(v4(world));
    EXPECT_EQ(i.told(), "");
    return part(object(i, 0), "shader");
  };
  const std::string glass = "Material \"dielectric\" \"float eta\" 1.7\n";
  const Component& plain = shader(glass + "Shape \"sphere\"");
  EXPECT_EQ(number(plain, "exterior"), 1);
  EXPECT_NEAR(number(plain, "ior"), 1.7, 1e-6);
  const Component& turned = shader(glass + "ReverseOrientation Shape \"cylinder\"");
  EXPECT_EQ(number(turned, "ior"), 1);
  EXPECT_NEAR(number(turned, "exterior"), 1.7, 1e-6);
  // Two shapes of one material, one of them through a mixture.
  const Imported both = import_text(
      v4("MakeNamedMaterial \"g\" \"string type\" \"dielectric\"\nMakeNamedMaterial \"m\" \"string type\" \"mix\" \"string "
         "materials\" [\"g\" \"g\"]\nNamedMaterial \"m\" Shape \"sphere\" ReverseOrientation Shape \"sphere\"\n"));
  ASSERT_TRUE(both.job) << both.told();
  EXPECT_NEAR(number(part(part(object(both, 0), "shader"), "first"), "ior"), 1.5, 1e-6);
  EXPECT_NEAR(number(part(part(object(both, 1), "shader"), "first"), "exterior"), 1.5, 1e-6);
}

// The boundary of glass and water within a glass: its index is the quotient, which is kept.
TEST(PbrtFront, IndicesAreAgainstTheOtherSide) {
  // Light at normal incidence through boundaries of 1.5 and 1.2: at each only (n - 1)^2 / (n + 1)^2 is lost.
  const auto disk = [](double z, double eta, const char* more = "") {
    char text[200];
    std::snprintf(text, sizeof text,
                  "AttributeBegin Material \"dielectric\" \"float eta\" %g Translate 0 0 %g %s Shape \"disk\" \"float radius\" "
                  "90 AttributeEnd\n",
                  eta, z, more);
    return std::string(text);
  };
  const auto passes = [](double n) { return 1 - std::pow((n - 1) / (n + 1), 2); };
  // The camera looks along +z; the disks are rotated so that their front faces it.
  const char* facing = "Rotate 180 0 1 0";
  const std::string lamp =
      "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"bool twosided\" true Translate 0 0 90 Shape \"disk\" \"float radius\" "
      "50";
  const Imported i =
      import_text("Integrator \"volpath\" \"integer maxdepth\" 2\n" + v4(disk(1, 1.5, facing) + disk(2, 1.2, facing) + lamp));
  // Paths with internal reflections are too long for maxdepth, so the radiance is the product of the transmittances, divided by
  // the square of the last medium's index.
  EXPECT_NEAR(seen(i, 16384).y, passes(1.5) * passes(1.2) / std::pow(1.5 * 1.2, 2), 0.01);
}

TEST(PbrtFront, ReversedQuadricsExchangeTheirMedia) {
  const std::string media =
      "MakeNamedMedium \"a\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [.5 .5 .5] \"rgb sigma_s\" [0 0 0]\n"
      "MakeNamedMedium \"b\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [.25 .25 .25] \"rgb sigma_s\" [0 0 0]\n";
  const auto through = [&](const std::string& interface) {
    return seen(import_text(v4(sky + media + "Material \"interface\" MediumInterface " + interface +
                               " Translate 0 0 5 Shape \"sphere\"")),
                65536)
        .y;
  };
  EXPECT_NEAR(through("\"a\" \"\""), std::exp(-1.0), 0.01);
  EXPECT_NEAR(through("\"\" \"a\" ReverseOrientation"), std::exp(-1.0), 0.01);
}

TEST(PbrtFront, MeshesWithAMediumAreTurnedRound) {
  const std::string medium =
      "MakeNamedMedium \"a\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [.5 .5 .5] \"rgb sigma_s\" [0 0 0]\n"
      "Material \"interface\" MediumInterface \"a\" \"\" Translate 0 0 5 ";
  const std::string points = "[-1 -1 -1 -1 -1 1 -1 1 -1 -1 1 1 1 -1 -1 1 -1 1 1 1 -1 1 1 1]",
                    inwards = "[2 3 1 2 1 0 5 7 6 5 6 4 1 5 4 1 4 0 6 7 3 6 3 2 4 6 2 4 2 0 3 7 5 3 5 1]";
  const auto cube = [&](const std::string& more) {
    return import_text(
        v4(sky + medium + more + "Shape \"trianglemesh\" \"point3 P\" " + points + " \"integer indices\" " + inwards));
  };
  const Imported i = cube("");
  EXPECT_NE(i.told().find("point inwards"), std::string::npos) << i.told();
  EXPECT_NEAR(seen(i, 65536).y, std::exp(-1.0), 0.01);
  const Imported reversed = cube("ReverseOrientation ");
  EXPECT_EQ(reversed.told(), "");
  EXPECT_NEAR(seen(reversed, 65536).y, std::exp(-1.0), 0.01);
  const Imported subdivided =
      import_text(v4(sky + medium + "Shape \"loopsubdiv\" \"point3 P\" " + points + " \"integer indices\" " + inwards));
  EXPECT_NE(subdivided.told().find("point inwards"), std::string::npos) << subdivided.told();
}

// A file whose triangles are oriented against its normals: the front of glass is where the normals point.
TEST(PbrtFront, NormalsOfFilesSayWhereGlassIs) {
  const TemporaryFolder folder;
  folder.write("a.ply",
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float "
               "nx\nproperty float ny\nproperty float nz\nelement face 1\nproperty list uchar int vertex_indices\n"
               "end_header\n0 0 0 0 0 -1\n1 0 0 0 0 -1\n0 1 0 0 0 -1\n3 0 1 2\n");
  const auto triangles = [&](const char* material) {
    const Imported i =
        import_text(folder, v4(std::string("Material \"") + material + "\" Shape \"plymesh\" \"string filename\" \"a.ply\"\n"));
    EXPECT_EQ(i.told(), "");
    const Value list = get(object(i, 0), "triangles");
    return write_value(list);
  };
  EXPECT_NE(triangles("dielectric").find("0, 2, 1"), std::string::npos) << triangles("dielectric");
  EXPECT_EQ(triangles("diffuse").find("0, 2, 1"), std::string::npos);
}

TEST(PbrtFront, MirroredQuadricsAreTold) {
  const std::string mirrored = "Scale -1 1 1 Shape \"sphere\"\n";
  EXPECT_NE(import_text(v4("Material \"dielectric\" " + mirrored)).told().find("a mirroring transform leaves the front"),
            std::string::npos);
  EXPECT_EQ(import_text(v4(mirrored)).told(), "");
}

TEST(PbrtNotes, WhatPbrtWarnsOf) {
  EXPECT_NE(import_text(v4("CoordSysTransform \"lamp\" Shape \"sphere\"")).told().find("no coordinate system 'lamp'"),
            std::string::npos);
  const Imported open = import_text(v3("AttributeBegin Shape \"sphere\""));
  EXPECT_TRUE(open.job) << open.told();
  EXPECT_NE(open.told().find("this AttributeBegin has no end"), std::string::npos) << open.told();
}

TEST(PbrtFront, ReversedBumpsAreHollows) {
  const std::string texture = "Texture \"h\" \"float\" \"constant\" \"float value\" 0.25\n";
  const std::string bumped = "Material \"diffuse\" \"texture displacement\" \"h\"\n";
  const Imported i = import_text(v4(texture + bumped + "Shape \"sphere\" ReverseOrientation Shape \"sphere\""));
  ASSERT_TRUE(i.job) << i.told();
  EXPECT_EQ(number(part(object(i, 0), "shader"), "height"), 0.25);
  EXPECT_EQ(part(part(object(i, 1), "shader"), "height").class_info().name, "FormulaMap");
}

/// The radiance seen of a light of 1 before the camera.
double lamp(const TemporaryFolder& folder, bool v4_file, const std::string& before, const std::string& more,
            Imported* told = {}) {
  const std::string world =
      before +
      "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\nMaterial \"matte\" \"rgb Kd\" [0 0 0] Shape \"trianglemesh\" "
      "\"point P\" [-9 9 5 9 9 5 0 -19 5] " +
      more;
  std::string as_v4 = world;
  as_v4.replace(as_v4.find("\"point P\""), 9, "\"point3 P\"")
      .replace(as_v4.find("\"matte\""), 7, "\"diffuse\"")
      .replace(as_v4.find("Kd"), 2, "reflectance");
  const Imported i = import_text(folder, v4_file ? v4(as_v4) : v3(world));
  if (told) *told = i;
  return seen(i, 1024).y;
}

TEST(PbrtAlpha, HolesOfLightsAreDark) {
  const TemporaryFolder folder;
  EXPECT_NEAR(lamp(folder, true, "", ""), 1, 0.01);
  EXPECT_NEAR(lamp(folder, true, "", "\"float alpha\" 0.25"), 0.25, 0.01);
  const std::string texture = "Texture \"a\" \"float\" \"constant\" \"float value\" 0.5\n";
  EXPECT_NEAR(lamp(folder, true, texture, "\"texture alpha\" \"a\""), 0.5, 0.01);
}

TEST(PbrtAlpha, LightsOfZeroLightAndAreNotSeen) {
  const TemporaryFolder folder;
  Imported told;
  EXPECT_EQ(lamp(folder, true, "", "\"float alpha\" 0", &told), 0);
  EXPECT_NE(told.told().find("a light whose alpha is 0 is left out of what the camera sees"), std::string::npos) << told.told();
  // A square lamp before a diffuse wall of 0.5: the wall is lit, and seen through the lamp, whatever its material. If half its
  // width is the distance, a radiance of 1 gives the wall's middle the irradiance 4 s atan(s), s = 1 / sqrt(2): pi times four
  // quarters, each seen from below its corner (Howell, A catalog of radiation heat transfer configuration factors, B-3).
  const auto ceiling = [&](const std::string& alpha) {
    const std::string wall =
        "Material \"diffuse\" \"rgb reflectance\" [.5 .5 .5] Shape \"trianglemesh\" \"point3 P\" [-9 -9 5 9 -9 5 9 9 5 -9 9 5] "
        "\"integer indices\" [0 1 2 0 2 3]\n";
    const std::string light =
        "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] Material \"dielectric\" Shape \"trianglemesh\" \"point3 P\" "
        "[-1 -1 4 1 -1 4 1 1 4 -1 1 4] \"integer indices\" [0 1 2 0 2 3] ";
    return seen(import_text(folder, v4(wall + light + alpha)), 4096).y;
  };
  const double s = 1 / std::sqrt(2.0);
  EXPECT_NEAR(ceiling("\"float alpha\" 0"), 0.5 / M_PI * 4 * s * std::atan(s), 0.01);
}

TEST(PbrtAlpha, Version3HasHolesWhereItIsZeroAlone) {
  const auto opacity = [](const std::string& alpha) {
    return number(
        part(object(import_text(v3("Shape \"trianglemesh\" \"point P\" [-9 9 5 9 9 5 0 -19 5] " + alpha)), 0), "shader"),
        "opacity");
  };
  EXPECT_EQ(opacity("\"float alpha\" 0.25"), 1);
  EXPECT_EQ(opacity("\"float alpha\" 0"), 0);
}

// The search for glass in mixtures takes time proportional to the number of materials, and terminates for mixtures that contain
// themselves.
TEST(PbrtFront, MixturesOfOneAnother) {
  const std::string turned = "ReverseOrientation Shape \"sphere\"";
  const Imported itself =
      import_text(v4("MakeNamedMaterial \"a\" \"string type\" \"mix\" \"string materials\" [\"a\" \"a\"] "
                     "NamedMaterial \"a\" " +
                     turned));
  EXPECT_NE(itself.told().find("is a mixture of itself"), std::string::npos) << itself.told();
  std::string many = "MakeNamedMaterial \"m0\" \"string type\" \"diffuse\" ";
  for (int i = 1; i <= 60; ++i)
    many += "MakeNamedMaterial \"m" + std::to_string(i) + "\" \"string type\" \"mix\" \"string materials\" [\"m" +
            std::to_string(i - 1) + "\" \"m" + std::to_string(i - 1) + "\"] ";
  const Imported deep = import_text(v4(many + "NamedMaterial \"m60\" " + turned));
  EXPECT_TRUE(deep.job) << deep.told();
}

TEST(PbrtObjects, LightsInDefinitionsStandInTheWorld) {
  const Imported i =
      import_text(v4("ObjectBegin \"o\" Translate 1 2 3 LightSource \"point\" Shape \"sphere\" ObjectEnd ObjectInstance \"o\" "
                     "ObjectInstance \"o\""));
  EXPECT_EQ(i.told(), "");
  ASSERT_EQ(i.job->scene->objects.size(), 3u);
  EXPECT_EQ(object(i, 0).class_info().name, "Point");
}

}  // namespace
}  // namespace etendue::pbrt_test
