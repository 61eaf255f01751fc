// The meaning of pbrt's numbers: each convention is tested with a number that follows from its documentation.

#include "etendue/describe/color.h"
#include "pbrt_support.h"

namespace etendue::pbrt_test {
namespace {

/// A light that fills the view; the camera sees its front (+z of a disk rotated towards it).
std::string lamp(const std::string& light) {
  return "AreaLightSource \"diffuse\" " + light + "\nTranslate 0 0 5 Rotate 180 0 1 0 Shape \"disk\" \"float radius\" 10\n";
}

TEST(PbrtLight, RgbTimesScaleTimesIsoTimesShutter) {
  const Xyz c = seen(import_text(v4(lamp("\"rgb L\" [2 2 2] \"float scale\" 3"), "\"float iso\" 200",
                                    "\"float fov\" 1 \"float shutteropen\" 0.25 \"float shutterclose\" 0.75")),
                     4096);
  // 2 * 3 * (200 / 100) * 0.5 s, of the white of sRGB.
  EXPECT_NEAR(c.y, 6, 0.02);
  EXPECT_NEAR(c.x / c.y, 0.9505, 0.005);
  EXPECT_NEAR(c.z / c.y, 1.0888, 0.01);
}

TEST(PbrtLight, SpectraOfVersion4HaveLuminanceOne) {
  for (const char* light : {"\"blackbody L\" 4000", "\"spectrum L\" [400 7 700 1]", "\"spectrum L\" \"stdillum-A\"", ""})
    EXPECT_NEAR(seen(import_text(v4(lamp(light))), 8192).y, 1, 0.01) << light;
}

TEST(PbrtLight, BlackBodyOfVersion3HasAPeakOfOne) {
  // Planck's law in steps of 1 nm: the mean of B / B_max, weighted by the observer's ybar.
  const auto planck = [](double nm) { return 1 / (std::pow(nm, 5) * (std::exp(1.438777e7 / (nm * 5000)) - 1)); };
  double sum = 0, weights = 0;
  for (int nm = 360; nm <= 830; ++nm) {
    sum += observer(float(nm)).y * planck(nm) / planck(2.8977721e6 / 5000);
    weights += observer(float(nm)).y;
  }
  EXPECT_NEAR(seen(import_text(v3(lamp("\"blackbody L\" [5000 2]"))), 8192).y, 2 * sum / weights, 0.02);
}

TEST(PbrtLight, ASpectrumOfVersion3IsAsItIs) {
  EXPECT_NEAR(seen(import_text(v3(lamp("\"spectrum L\" [300 2 900 2]"))), 4096).y, 2, 0.02);
  EXPECT_NEAR(seen(import_text(v3(lamp("\"rgb L\" [1 1 1] \"rgb scale\" [3 3 3]"))), 4096).y, 3, 0.03);
}

TEST(PbrtLight, PowerIsSharedOverArea) {
  // L = power / (area pi); a luminance of 1 gives a pixel of 1.
  EXPECT_NEAR(seen(import_text(v4(lamp("\"float power\" 1000"))), 4096).y, 1000 / (100 * M_PI * M_PI), 0.02);
}

/// A diffuse floor of reflectance 0.5 seen from above, 2 m below the light: its radiance is E / (2 pi).
std::string floor_under(const std::string& light) {
  return light +
         "\nMaterial \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5] Translate 0 0 5 Shape \"disk\" \"float radius\" 50\n";
}

TEST(PbrtLight, PointSpotAndDistant) {
  const double half = 0.5 / M_PI;
  EXPECT_NEAR(seen(import_text(v4(floor_under("LightSource \"point\" \"rgb I\" [8 8 8] \"point3 from\" [0 0 3]"))), 1024).y,
              half * 8 / 4, 0.01);
  EXPECT_NEAR(seen(import_text(v4(floor_under("LightSource \"point\" \"float power\" 400 \"point3 from\" [0 0 3]"))), 1024).y,
              half * 400 / (4 * M_PI) / 4, 0.05);
  EXPECT_NEAR(seen(import_text(v4(floor_under("LightSource \"spot\" \"rgb I\" [8 8 8] \"point3 from\" [0 0 3] \"point3 to\" [0 "
                                              "0 4] \"float coneangle\" 30"))),
                   1024)
                  .y,
              half * 8 / 4, 0.01);
  EXPECT_NEAR(seen(import_text(v4(floor_under("LightSource \"distant\" \"rgb L\" [3 3 3] \"point3 from\" [0 0 0] \"point3 to\" "
                                              "[0 0 1]"))),
                   1024)
                  .y,
              half * 3, 0.01);
  EXPECT_NEAR(seen(import_text(v4(floor_under("LightSource \"distant\" \"float illuminance\" 5"))), 1024).y, half * 5, 0.02);
}

TEST(PbrtLight, TheFrontIsWhereNormalsPoint) {
  // Both triangles are oriented so that +z is in front, but the normals of the second point to -z, at the camera.
  const auto mesh = [](const std::string& more) {
    return v4("AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\nShape \"trianglemesh\" \"point3 P\" [-9 -9 5 9 -9 5 0 9 5] " +
              more);
  };
  const auto bright = [&](const std::string& more) { return seen(import_text(mesh(more)), 64).y > 0.5; };
  EXPECT_FALSE(bright(""));
  EXPECT_TRUE(bright("\"normal N\" [0 0 -1 0 0 -1 0 0 -1]"));
  const auto reversed =
      v4("AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\nReverseOrientation Shape \"trianglemesh\" \"point3 P\" [-9 -9 5 9 -9 "
         "5 0 9 5]");
  EXPECT_GT(seen(import_text(reversed), 64).y, 0.5);
  // A mirroring transform does not flip the front.
  const auto mirrored = v4(
      "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\nScale -1 1 1 Shape \"trianglemesh\" \"point3 P\" [-9 -9 5 9 -9 5 0 9 5]");
  EXPECT_LT(seen(import_text(mirrored), 64).y, 0.5);
}

TEST(PbrtMaterial, RoughnessBecomesAlpha) {
  const auto alpha = [](const std::string& scene, const char* member = "roughness") {
    const Imported i = import_text(scene + " Shape \"sphere\" \"float radius\" 1");
    return i.job ? number(part(object(i, 0), "shader"), member) : (ADD_FAILURE() << i.told(), 0.0);
  };
  EXPECT_NEAR(alpha(v4("Material \"conductor\" \"float roughness\" 0.25")), 0.5, 1e-6);
  EXPECT_NEAR(alpha(v4("Material \"conductor\" \"float roughness\" 0.25 \"bool remaproughness\" false")), 0.25, 1e-6);
  EXPECT_NEAR(alpha(v4("Material \"dielectric\" \"float uroughness\" 0.09 \"float vroughness\" 0.04")), 0.3, 1e-6);
  EXPECT_NEAR(alpha(v4("Material \"dielectric\" \"float uroughness\" 0.09 \"float vroughness\" 0.04"), "roughness_v"), 0.2,
              1e-6);
  // RoughnessToAlpha of v3's TrowbridgeReitzDistribution at 0.1 and 0.3, computed separately.
  const std::string metal = v3("");
  const auto v3_scene = [](const std::string& material) {
    return "Camera \"perspective\" Film \"image\" WorldBegin\n" + material;
  };
  EXPECT_NEAR(alpha(v3_scene("Material \"metal\" \"float roughness\" 0.1")), 0.46176003, 1e-5);
  EXPECT_NEAR(alpha(v3_scene("Material \"metal\" \"float roughness\" 0.3")), 0.85703647, 1e-5);
}

TEST(PbrtMaterial, DiffuseAndPlastic) {
  // In a uniform environment of radiance 1 a diffuse surface has the radiance of its reflectance; v3's default plastic has Kd
  // plus Ks times the dielectric's reflectance at normal incidence, ((n - 1) / (n + 1))^2 = 0.04, at a roughness of nearly
  // nothing.
  const std::string sky = "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";
  const std::string disk = "Translate 0 0 5 Shape \"disk\" \"float radius\" 50\n";
  EXPECT_NEAR(seen(import_text(v4(sky + "Material \"diffuse\" \"rgb reflectance\" [0.3 0.3 0.3]\n" + disk)), 1024).y, 0.3,
              0.005);
  EXPECT_NEAR(seen(import_text(v3(sky +
                                  "Material \"plastic\" \"rgb Kd\" [0.4 0.4 0.4] \"rgb Ks\" [0.5 0.5 0.5] \"float "
                                  "roughness\" 0.01 \"bool remaproughness\" \"false\"\n" +
                                  disk)),
                   4096)
                  .y,
              0.4 + 0.5 * 0.04, 0.01);
}

// v3's plastic uses the Fresnel reflectance of light from inside: beyond asin(1 / 1.5), which is 42 degrees, all of it is
// reflected.
TEST(PbrtMaterial, PlasticIsSeenFromWithin) {
  EXPECT_NEAR(seen(import_text(v3("LightSource \"infinite\" \"rgb L\" [1 1 1]\nMaterial \"plastic\" \"rgb Kd\" [0.4 0.4 0.4] "
                                  "\"rgb Ks\" [0.5 0.5 0.5] \"float roughness\" 0.01 \"bool remaproughness\" "
                                  "\"false\"\nTranslate 0 0 5 Rotate 60 1 0 0 Shape \"disk\" \"float radius\" 50\n")),
                   4096)
                  .y,
              0.9, 0.01);
}

TEST(PbrtCamera, RightIsPlusXAndTheFieldOfViewIsOfTheShorterSide) {
  // A light at x = 1 of a picture of 2 x 1 pixels that sees from -2 to 2: the right pixel.
  const std::string text =
      "Camera \"perspective\" \"float fov\" 90\nFilm \"rgb\" \"integer xresolution\" 2 \"integer yresolution\" 1\n"
      "PixelFilter \"box\"\nWorldBegin\nAreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\nTranslate 1 0 1 Rotate 180 0 1 0 Shape "
      "\"disk\" \"float radius\" 0.2\n";
  const Imported i = import_text(text);
  ASSERT_TRUE(i.job) << i.told();
  i.job->outputs.clear();
  i.job->renderer->samples = 256;
  const Image image = test::rendered(i.job)->picture();
  EXPECT_EQ(image.at(0, 0, 1), 0);
  // The light's share of a pixel that is 2 x 2 m at that distance.
  EXPECT_NEAR(image.at(1, 0, 1), M_PI * 0.04 / 4, 0.01);
}

TEST(PbrtCamera, LookAtAndScaleMinusOne) {
  const std::string rest =
      "Camera \"perspective\" \"float fov\" 90\nFilm \"rgb\" \"integer xresolution\" 2 \"integer yresolution\" 1\n"
      "PixelFilter \"box\"\nWorldBegin\nAreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"bool twosided\" true\nTranslate 4 0 5 "
      "Shape \"disk\" \"float radius\" 0.2\n";
  // From (3, 0, 4) towards +z: the light is at x = +1 from the axis.
  for (const bool mirrored : {false, true}) {
    const Imported i = import_text(std::string(mirrored ? "Scale -1 1 1 " : "") + "LookAt 3 0 4 3 0 5 0 1 0\n" + rest);
    ASSERT_TRUE(i.job) << i.told();
    i.job->outputs.clear();
    i.job->renderer->samples = 256;
    const Image image = test::rendered(i.job)->picture();
    EXPECT_GT(image.at(mirrored ? 0 : 1, 0, 1), 0.01);
    EXPECT_EQ(image.at(mirrored ? 1 : 0, 0, 1), 0);
  }
}

TEST(PbrtIntegrator, DepthCountsScattering) {
  for (const auto& [type, name] :
       {std::pair("path", "PathTracer"), std::pair("volpath", "PathTracer"), std::pair("bdpt", "BidirectionalPathTracer")}) {
    const Imported i = import_text("Integrator \"" + std::string(type) +
                                   "\" \"integer maxdepth\" 7\nFilm \"rgb\"\nWorldBegin\nShape \"sphere\"");
    ASSERT_TRUE(i.job) << i.told();
    EXPECT_EQ(i.job->renderer->class_info().name, name);
    EXPECT_EQ(number(*i.job->renderer, "max_depth"), 8);
  }
}

TEST(PbrtMotion, ATransformAtTwoTimes) {
  // From x = -6 at 0 to x = +6 at 1: it is in the middle of the view (1 pixel of nearly no size) half of the time.
  const std::string world =
      "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"bool twosided\" true\nTranslate 0 0 5\n"
      "ActiveTransform StartTime Translate -6 0 0 ActiveTransform EndTime Translate 6 0 0 ActiveTransform "
      "All\nShape \"disk\" \"float radius\" 3\n";
  // It covers the middle while |12 t - 6| < 3: half of the time.
  EXPECT_NEAR(seen(import_text(v4(world)), 4096).y, 0.5, 0.03);
}

}  // namespace
}  // namespace etendue::pbrt_test
