// pbrt's goniometric lights: intensities as its books define them.

#include "pbrt_support.h"
#include "support/component_test_support.h"
#include "support/image_file.h"

namespace etendue::pbrt_test {
namespace {

constexpr int size = 16;

/// Grey values, different everywhere.
std::vector<float> values(int width, int height) {
  std::vector<float> rgb;
  for (int i = 0; i < width * height; ++i)
    for (int c = 0; c < 3; ++c) rgb.push_back(1 + 0.5f * std::sin(0.7f * float(i % width)) + float(i / width) / float(height));
  return rgb;
}

struct Light {
  Ref<Job> job;
  SurfacePoint point;
  const EmissionShader& emission() const { return *job->scene->objects.at(0)->emission; }
  /// Its intensity over that of another light, which is the same in all directions.
  double over(const Light& other, const Vector3& direction) const {
    const Wavelengths w = test::wavelengths();
    return double(emission().radiance(point, direction, w)[1] / other.emission().radiance(other.point, direction, w)[1]);
  }
};
Light light(const TemporaryFolder& folder, const std::string& source, bool v3) {
  const Imported i = import_text(folder, v3 ? pbrt_test::v3(source) : v4(source));
  EXPECT_EQ(i.told(), "");
  Light l{i.job, {}};
  i.job->scene->prepare();
  for (const auto& object : i.job->scene->objects) {
    object->emission->prepare();
    object->prepare();
  }
  l.point = i.job->scene->objects.at(0)->sample_area({0.5f, 0.5f}, 0).point;
  return l;
}

const std::string turned = "Translate 1 2 3 Rotate 50 1 2 3 ";
Vector3 world(const DoubleVector3& d, bool mirrored) {
  const Transform t = Transform::rotate(50 * M_PI / 180, {1, 2, 3}) * Transform::scale({mirrored ? -1.0 : 1.0, 1, 1});
  return normalize(t(Vector3(d)));
}

// The square's third axis is the light's y, its second the light's z: section 12.2.3. Texels are not interpolated.
TEST(PbrtGoniometric, SquaresOfVersion4) {
  const TemporaryFolder folder;
  const std::vector<float> rgb = values(size, size);
  test::write_image(folder / "map.exr", {size, size, 3, NumberType::single}, rgb);
  for (const bool mirrored : {false, true}) {
    const std::string before = turned + (mirrored ? "Scale -1 1 1 " : "");
    const Light gonio = light(
        folder, before + "LightSource \"goniometric\" \"rgb I\" [3 2 1] \"float scale\" 2 \"string filename\" \"map.exr\"",
        false);
    const Light even = light(folder, "LightSource \"point\" \"rgb I\" [3 2 1] \"float scale\" 2", false);
    for (int i = 0; i < size * size; ++i) {
      const double a = (i % size + 0.3) / size * 2 - 1, b = (i / size + 0.8) / size * 2 - 1,
                   distance = 1 - (std::abs(a) + std::abs(b)), r = 1 - std::abs(distance);
      const double phi = (r == 0 ? 1 : (std::abs(b) - std::abs(a)) / r + 1) * M_PI / 4, ring = r * std::sqrt(2 - r * r);
      const DoubleVector3 d{std::copysign(std::cos(phi), a) * ring, std::copysign(1 - r * r, distance),
                            std::copysign(std::sin(phi), b) * ring};
      EXPECT_NEAR(gonio.over(even, world(d, mirrored)), double(rgb[size_t(3 * i)]), 1e-4) << i;
    }
  }
}

// phi from +x towards +z, theta from +y (12.3.3 of the third edition); at the middles of texels.
TEST(PbrtGoniometric, LongitudeAndLatitudeOfVersion3) {
  const TemporaryFolder folder;
  const std::vector<float> rgb = values(2 * size, size);
  test::write_image(folder / "map.exr", {2 * size, size, 3, NumberType::single}, rgb);
  const Light gonio =
      light(folder, turned + "LightSource \"goniometric\" \"rgb I\" [3 2 1] \"string mapname\" \"map.exr\"", true);
  const Light even = light(folder, "LightSource \"point\" \"rgb I\" [3 2 1]", true);
  for (int i = 0; i < 2 * size * size; ++i) {
    const double phi = M_PI * (i % (2 * size) + 0.5) / size, theta = M_PI * (i / (2 * size) + 0.5) / size;
    const DoubleVector3 d{std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
    EXPECT_NEAR(gonio.over(even, world(d, false)), double(rgb[size_t(3 * i)]), 1e-3) << i;
  }
}

// "power" is that of the light with its image, times "scale"; without an image the light is a point light.
TEST(PbrtGoniometric, PowerIsThatOfTheImage) {
  const TemporaryFolder folder;
  test::write_image(folder / "map.exr", {size, size, 3, NumberType::single}, values(size, size));
  const std::string power = " \"float power\" 400 \"float scale\" 0.5";
  const Light gonio = light(folder, "LightSource \"goniometric\" \"string filename\" \"map.exr\"" + power, false);
  const Light even = light(folder, "LightSource \"point\"" + power, false),
              none = light(folder, "LightSource \"goniometric\"" + power, false);
  const Wavelengths w = test::wavelengths();
  const float expected = even.emission().power(*even.job->scene->objects[0], w)[1];
  EXPECT_NEAR(gonio.emission().power(*gonio.job->scene->objects[0], w)[1] / expected, 1, 1e-3);
  EXPECT_NEAR(none.emission().power(*none.job->scene->objects[0], w)[1] / expected, 1, 1e-5);
}

// Between cos 20 and cos 30 version 3 falls as t^4, version 4 as t^2 (3 - 2 t): 12.3.1 and 12.2.1 of the editions.
TEST(PbrtSpot, FallsOffAsInItsVersion) {
  const TemporaryFolder folder;
  const std::string spot = "LightSource \"spot\" \"rgb I\" [3 2 1] \"float coneangle\" 30 \"float conedeltaangle\" 10";
  for (const bool version3 : {false, true}) {
    const Light lamp = light(folder, spot, version3), even = light(folder, "LightSource \"point\" \"rgb I\" [3 2 1]", version3);
    for (const double t : {0.1, 0.5, 0.8}) {
      const double c = std::cos(M_PI / 6) + t * (std::cos(M_PI / 9) - std::cos(M_PI / 6));
      EXPECT_NEAR(lamp.over(even, {float(std::sqrt(1 - c * c)), 0, float(c)}), version3 ? std::pow(t, 4) : t * t * (3 - 2 * t),
                  1e-4);
    }
  }
}

// Uniform over directions, the image's right towards +x and its top towards -y; "power" is the integral over directions:
// 12.2.2. An image, 60 degrees across, of a white half and a grey one, at its middle: I = power / (mean * solid angle).
TEST(PbrtProjection, IsEvenOverDirections) {
  const TemporaryFolder folder;
  std::vector<float> rgb;
  for (int i = 0; i < size * size; ++i)
    for (int c = 0; c < 3; ++c) rgb.push_back(i % size < size / 2 ? 0.5f : 1.0f);
  test::write_image(folder / "map.exr", {size, size, 3, NumberType::single}, rgb);
  const Imported i =
      import_text(folder, v4("LightSource \"projection\" \"string filename\" \"map.exr\" \"float fov\" 60 \"float power\" 40"));
  EXPECT_NE(i.told().find("squares in pbrt"), std::string::npos);
  Light lamp{i.job, {}};
  i.job->scene->prepare();
  const Ref<SceneObject>& object = i.job->scene->objects.at(0);
  object->emission->prepare();
  object->prepare();
  lamp.point = object->sample_area({0.5f, 0.5f}, 0).point;
  const Light even = light(folder, "LightSource \"point\" \"rgb I\" [1 1 1]", false);
  const double a2 = std::pow(std::tan(M_PI / 6), 2), solid_angle = 4 * std::atan(a2 / std::sqrt(1 + 2 * a2));
  for (const double x : {-0.5, -0.2, 0.2, 0.5})
    EXPECT_NEAR(lamp.over(even, normalize(Vector3{float(x), 0.1f, 1})), (x > 0 ? 1 : 0.5) * 40 / (0.75 * solid_angle), 0.1)
        << x;
}

TEST(PbrtGoniometric, WhatIsNotThereIsTold) {
  const TemporaryFolder folder;
  test::write_image(folder / "red.exr", {2, 1, 3, NumberType::single}, {1, 0, 0, 1, 1, 1});
  EXPECT_NE(import_text(folder, v4("LightSource \"goniometric\" \"string filename\" \"none.exr\"")).told().find("none.exr"),
            std::string::npos);
  const std::string red = import_text(folder, v3("LightSource \"goniometric\" \"string mapname\" \"red.exr\"")).told();
  EXPECT_NE(red.find("the mean of red, green and blue"), std::string::npos) << red;
}

}  // namespace
}  // namespace etendue::pbrt_test
