// The directions of the texels of environment maps.

#include "etendue/describe/color.h"
#include "pbrt_support.h"
#include "support/image_file.h"

namespace etendue::pbrt_test {
namespace {

constexpr int size = 64;

/// Red grows to the right, green downwards, from 0 to 1.
std::vector<float> ramps(int width, int height) {
  std::vector<float> rgb;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (const float c : {(float(x) + 0.5f) / float(width), (float(y) + 0.5f) / float(height), 0.25f}) rgb.push_back(c);
  return rgb;
}

/// Red and green seen in a direction.
std::array<double, 2> towards(const TemporaryFolder& folder, bool v4, const std::array<double, 3>& d) {
  const std::string up = std::abs(d[1]) > 0.9 ? "1 0 0" : "0 1 0";
  char look[200];
  std::snprintf(look, sizeof look, "LookAt 0 0 0 %g %g %g %s\n", d[0], d[1], d[2], up.c_str());
  const std::string film = v4 ? "rgb" : "image";
  const Imported i = import_text(folder, std::string(look) + "Camera \"perspective\" \"float fov\" 0.1\nFilm \"" + film +
                                             "\" \"integer xresolution\" 1 \"integer yresolution\" 1\nWorldBegin\nLightSource "
                                             "\"infinite\" \"string " +
                                             (v4 ? "filename" : "mapname") + "\" \"map.exr\"\n");
  const Xyz c = seen(i, 8192);
  return {3.240479 * c.x - 1.53715 * c.y - 0.498535 * c.z, -0.969256 * c.x + 1.875991 * c.y + 0.041556 * c.z};
}

TEST(PbrtEnvironment, EqualAreasOfVersion4) {
  const TemporaryFolder folder;
  test::write_image(folder / "map.exr", {size, size, 3, NumberType::single}, ramps(size, size));
  // Clarberg's mapping, from the square to the sphere.
  for (const auto& [u, v] : {std::pair(0.5, 0.5), {0.3, 0.4}, {0.6, 0.35}, {0.8, 0.55}, {0.1, 0.2}, {0.85, 0.9}, {0.4, 0.9}}) {
    const double a = 2 * u - 1, b = 2 * v - 1, distance = 1 - (std::abs(a) + std::abs(b)), r = 1 - std::abs(distance);
    const double phi = (r == 0 ? 1 : (std::abs(b) - std::abs(a)) / r + 1) * M_PI / 4, ring = r * std::sqrt(2 - r * r);
    const std::array<double, 3> d{std::copysign(std::cos(phi), a) * ring, std::copysign(std::sin(phi), b) * ring,
                                  std::copysign(1 - r * r, distance)};
    const auto [red, green] = towards(folder, true, d);
    EXPECT_NEAR(red, u, 0.02) << u << " " << v;
    EXPECT_NEAR(green, v, 0.02) << u << " " << v;
  }
}

TEST(PbrtEnvironment, LongitudeAndLatitudeOfVersion3) {
  const TemporaryFolder folder;
  test::write_image(folder / "map.exr", {2 * size, size, 3, NumberType::single}, ramps(2 * size, size));
  // u = phi / (2 pi) from +x towards +y, v = theta / pi from +z.
  for (const auto& [u, v] : {std::pair(0.125, 0.5), {0.25, 0.4}, {0.5, 0.7}, {0.75, 0.25}, {0.9, 0.5}}) {
    const double phi = 2 * M_PI * u, theta = M_PI * v;
    const auto [red, green] =
        towards(folder, false, {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)});
    EXPECT_NEAR(red, u, 0.02) << u << " " << v;
    EXPECT_NEAR(green, v, 0.02) << u << " " << v;
  }
}

/// The radiance of a diffuse floor of reflectance 0.5 that faces +z, seen from above: E / (2 pi).
double floor_under(const TemporaryFolder& folder, const std::string& light) {
  return seen(import_text(folder,
                          "LookAt 0 0 5 0 0 0 0 1 0\n" + v4("LightSource \"infinite\" " + light +
                                                            "\nMaterial \"diffuse\" Shape \"disk\" \"float radius\" 50")),
              16384)
      .y;
}

// With a constant light pbrt gives the requested illuminance, with an image twice as much: it weights texels by 2 pi.
TEST(PbrtEnvironment, Illuminance) {
  const TemporaryFolder folder;
  test::write_image(folder / "map.exr", {size, size, 3, NumberType::single}, std::vector<float>(size * size * 3, 0.5f));
  EXPECT_NEAR(floor_under(folder, "\"float illuminance\" 5"), 5 / (2 * M_PI), 0.02);
  EXPECT_NEAR(floor_under(folder, "\"string filename\" \"map.exr\" \"float illuminance\" 5"), 10 / (2 * M_PI), 0.03);
}

// The light of a portal without an image is not divided by its luminance: a black body's maximum is 1.
TEST(PbrtEnvironment, LightOfPortals) {
  const TemporaryFolder folder;
  const std::string light = "\"blackbody L\" 3000 ";
  const auto planck = [](double nm) { return 1 / (std::pow(nm, 5) * (std::exp(1.438777e7 / (nm * 3000)) - 1)); };
  double sum = 0, weights = 0;
  for (int nm = 360; nm <= 830; ++nm) {
    sum += double(observer(float(nm)).y) * planck(nm) / planck(2.8977721e6 / 3000);
    weights += double(observer(float(nm)).y);
  }
  EXPECT_NEAR(floor_under(folder, light), 0.5, 0.01);
  EXPECT_NEAR(floor_under(folder, light + "\"point3 portal\" [-9 -9 9 9 -9 9 9 9 9 -9 9 9]"), 0.5 * sum / weights, 0.01);
}

}  // namespace
}  // namespace etendue::pbrt_test
