// Media, textures and shapes of pbrt, each tested with a number.

#include "pbrt_support.h"
#include "support/image_file.h"

namespace etendue::pbrt_test {
namespace {

const std::string sky = "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";

TEST(PbrtMedium, AbsorbsByBeer) {
  // 2 m through the middle of a sphere.
  const std::string sphere =
      "AttributeBegin\nMaterial \"interface\" MediumInterface \"m\" \"\" Translate 0 0 5 Shape \"sphere\"\nAttributeEnd\n";
  const auto through = [&](const std::string& medium) {
    return seen(import_text(v4(sky + "MakeNamedMedium \"m\" " + medium + "\n" + sphere)), 65536).y;
  };
  EXPECT_NEAR(
      through("\"string type\" \"homogeneous\" \"rgb sigma_a\" [.25 .25 .25] \"rgb sigma_s\" [0 0 0] \"float scale\" 2"),
      std::exp(-1.0), 0.01);
  // A grid of 4 cells across the same 2 m: its density falls to a half at its borders, 1/16 of it is missing.
  std::string ones;
  for (int i = 0; i < 64; ++i) ones += " 1";
  EXPECT_NEAR(
      through("\"string type\" \"uniformgrid\" \"integer nx\" 4 \"integer ny\" 4 \"integer nz\" 4 \"point3 p0\" [-1 -1 4] "
              "\"point3 p1\" [1 1 6] \"spectrum sigma_a\" [300 .5 900 .5] \"spectrum sigma_s\" [300 0 900 0] \"float "
              "density\" [" +
              ones + "]"),
      std::exp(-0.9375), 0.01);
}

TEST(PbrtMedium, ShinesByItsAbsorption) {
  // A medium that only absorbs and emits has the radiance Le (1 - exp(-absorption x distance)): here over 2 m.
  const std::string sphere =
      "AttributeBegin\nMaterial \"interface\" MediumInterface \"m\" \"\" Translate 0 0 5 Shape \"sphere\"\nAttributeEnd\n";
  const std::string medium =
      "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [.25 .25 .25] \"rgb sigma_s\" [0 0 0] \"float "
      "scale\" 2 "
      "\"rgb Le\" [1 1 1] \"float Lescale\" 3\n";
  EXPECT_NEAR(seen(import_text(v4(medium + sphere)), 65536).y, 3 * (1 - std::exp(-1.0)), 0.02);
}

/// The colour of a diffuse rectangle from (-1, -1) to (1, 1) at a point, in a uniform environment of radiance 1.
Xyz at(const TemporaryFolder& folder, const std::string& before, const std::string& texture, double x, double y) {
  char place[100];
  std::snprintf(place, sizeof place, "Translate %g %g 0\n", -x, -y);
  return seen(
      import_text(folder, v4(sky + before + "\nTexture \"t\" \"spectrum\" " + texture +
                             "\nMaterial \"diffuse\" \"texture reflectance\" \"t\"\n" + place +
                             "Shape \"trianglemesh\" \"point3 P\" [-1 -1 5.3 1 -1 5.3 1 1 5.3 -1 1 5.3] \"integer indices\" "
                             "[0 1 2 0 2 3] \"point2 uv\" [0 0 1 0 1 1 0 1]\n")),
      8192);
}

TEST(PbrtTexture, ImagesStandWithTheirTopAtVOne) {
  const TemporaryFolder folder;
  // Rows from the top: 0.1 0.2 / 0.3 0.4.
  test::write_image(folder / "map.exr", {2, 2, 3, NumberType::single},
                    {.1f, .1f, .1f, .2f, .2f, .2f, .3f, .3f, .3f, .4f, .4f, .4f});
  const std::string image = "\"imagemap\" \"string filename\" \"map.exr\" \"string filter\" \"point\"";
  EXPECT_NEAR(at(folder, "", image, -0.5, 0.5).y, 0.1, 0.002);
  EXPECT_NEAR(at(folder, "", image, 0.5, 0.5).y, 0.2, 0.002);
  EXPECT_NEAR(at(folder, "", image, -0.5, -0.5).y, 0.3, 0.002);
  EXPECT_NEAR(at(folder, "", image + " \"float scale\" 2", 0.5, -0.5).y, 0.8, 0.004);
  EXPECT_NEAR(at(folder, "", image + " \"bool invert\" true", 0.5, -0.5).y, 0.6, 0.004);
  // Repeated twice and shifted by half of u: u = 0.25 looks up 2 * 0.25 + 0.5 = 1.
  EXPECT_NEAR(at(folder, "", image + " \"float uscale\" 2 \"float udelta\" 0.5", -0.4, 0.5).y, 0.1, 0.002);
  EXPECT_NEAR(at(folder, "", image + " \"float uscale\" 2 \"float udelta\" 0.5", -0.6, 0.5).y, 0.2, 0.002);
}

TEST(PbrtTexture, Patterns) {
  const TemporaryFolder folder;
  const std::string checks =
      "\"checkerboard\" \"float uscale\" 2 \"float vscale\" 2 \"rgb tex1\" [.2 .2 .2] \"rgb tex2\" [.7 .7 .7]";
  EXPECT_NEAR(at(folder, "", checks, -0.5, -0.5).y, 0.2, 0.002);
  EXPECT_NEAR(at(folder, "", checks, 0.5, -0.5).y, 0.7, 0.002);
  const std::string cubes = "\"checkerboard\" \"integer dimension\" 3 \"rgb tex1\" [.2 .2 .2] \"rgb tex2\" [.7 .7 .7]";
  // The rectangle moves together with the texture: the point seen is (-0.5, -0.5, 5.3) in texture space, then (0.5, -0.5, 5.3).
  EXPECT_NEAR(at(folder, "Translate 0.5 0.5 0.5", cubes, 0, 0).y, 0.7, 0.002);
  EXPECT_NEAR(at(folder, "Translate -0.5 0.5 0.5", cubes, 0, 0).y, 0.2, 0.002);
  const std::string ramp =
      "\"bilerp\" \"rgb v00\" [0 0 0] \"rgb v01\" [.2 .2 .2] \"rgb v10\" [.4 .4 .4] \"rgb v11\" [.8 .8 .8]";
  EXPECT_NEAR(at(folder, "", ramp, 0.5, -0.5).y, 0.75 * 0.75 * 0.4 + 0.25 * 0.25 * 0.2 + 0.75 * 0.25 * 0.8, 0.003);
  const std::string two = "Texture \"a\" \"spectrum\" \"constant\" \"rgb value\" [.4 .4 .4]\n";
  EXPECT_NEAR(at(folder, two, "\"scale\" \"texture tex\" \"a\" \"float scale\" 0.5", 0, 0).y, 0.2, 0.002);
  EXPECT_NEAR(at(folder, two, "\"mix\" \"texture tex1\" \"a\" \"rgb tex2\" [.8 .8 .8] \"float amount\" 0.25", 0, 0).y, 0.5,
              0.002);
  const std::string plane =
      "\"checkerboard\" \"string mapping\" \"planar\" \"vector3 v1\" [1 0 0] \"vector3 v2\" [0 1 0] \"float "
      "udelta\" 0.5 \"float vdelta\" 0.5 \"rgb tex1\" [.2 .2 .2] \"rgb tex2\" [.7 .7 .7]";
  EXPECT_NEAR(at(folder, "", plane, 0, 0).y, 0.2, 0.002);
  EXPECT_NEAR(at(folder, "Translate 0.7 0 0", plane, 0, 0).y, 0.7, 0.002);
}

TEST(PbrtShape, AreaOfPartsOfQuadrics) {
  // Seen from far along z, a light of radiance 1 that fills a part of one pixel: the pixel is its area perpendicular to the
  // view over the pixel's area.
  const auto share = [](const std::string& shape) {
    const Imported i = import_text(
        "Camera \"orthographic\" \"float screenwindow\" [-2 2 -2 2]\nFilm \"rgb\" \"integer xresolution\" 1 \"integer "
        "yresolution\" "
        "1\nPixelFilter \"box\"\nWorldBegin\nMaterial \"diffuse\" \"rgb reflectance\" [0 0 0] AreaLightSource \"diffuse\" "
        "\"rgb L\" [1 1 1] \"bool twosided\" true\nTranslate 0 "
        "0 "
        "5\n" +
        shape);
    return seen(i, 16384).y * 16;
  };
  EXPECT_NEAR(share("Shape \"disk\" \"float radius\" 1.5 \"float innerradius\" 0.5"), M_PI * 2, 0.05);
  EXPECT_NEAR(share("Shape \"disk\" \"float radius\" 1.5 \"float phimax\" 90"), M_PI * 2.25 / 4, 0.05);
  EXPECT_NEAR(share("Shape \"sphere\" \"float radius\" 1.5 \"float zmin\" 0"), M_PI * 2.25, 0.05);
  EXPECT_NEAR(share("Shape \"sphere\" \"float phimax\" 180"), M_PI / 2, 0.05);
  EXPECT_NEAR(share("Rotate 90 1 0 0 Shape \"cylinder\" \"float radius\" 0.5 \"float zmin\" -1 \"float zmax\" 0.5"), 1.5, 0.05);
  EXPECT_NEAR(share("Shape \"bilinearmesh\" \"point3 P\" [-1 -1 0 1 -1 0 -1 0.5 0 1 0.5 0]"), 3, 0.05);
  EXPECT_NEAR(share("Shape \"bilinearmesh\" \"point3 P\" [-1 -1 0 1 -1 0 -0.5 0.5 0 0.5 0.5 1]"), 1.5 * 1.5, 0.05);
  EXPECT_NEAR(
      share("Shape \"curve\" \"string type\" \"cylinder\" \"point3 P\" [-1 0 0 0 0 0 0.5 0 0 1 0 0] \"float width0\" 0.2 "
            "\"float width1\" 0.6"),
      0.8, 0.06);
}

}  // namespace
}  // namespace etendue::pbrt_test
