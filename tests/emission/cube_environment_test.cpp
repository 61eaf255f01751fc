// OpenEXR files whose attribute `envmap` says that they hold a cube map.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "etendue/exporter.h"
#include "support/process.h"
#include "support/render_support.h"

namespace etendue {
namespace {

template <class T>
void put(std::string& to, T value) {
  to.append(reinterpret_cast<const char*>(&value), sizeof value);
}
void put_attribute(std::string& to, const char* name, const char* type, const std::string& value) {
  to.append(name).push_back('\0');
  to.append(type).push_back('\0');
  put(to, std::int32_t(value.size()));
  to += value;
}

/// A grey image of floats in uncompressed scanlines ("OpenEXR File Layout"); without the attribute if `envmap` is below 0.
std::string exr(int width, int height, int envmap, const std::function<float(int, int)>& pixel) {
  std::string file, channels, window, corner;
  put(file, std::int32_t(20000630));
  put(file, std::int32_t(2));
  for (const char* name : {"B", "G", "R"}) {
    channels.append(name).push_back('\0');
    for (const std::int32_t number : {2, 0, 1, 1}) put(channels, number);
  }
  channels.push_back('\0');
  for (const std::int32_t number : {0, 0, width - 1, height - 1}) put(window, number);
  put_attribute(file, "channels", "chlist", channels);
  put_attribute(file, "compression", "compression", std::string(1, '\0'));
  put_attribute(file, "dataWindow", "box2i", window);
  put_attribute(file, "displayWindow", "box2i", window);
  if (envmap >= 0) put_attribute(file, "envmap", "envmap", std::string(1, char(envmap)));
  put_attribute(file, "lineOrder", "lineOrder", std::string(1, '\0'));
  std::string one;
  put(one, 1.0f);
  put_attribute(file, "pixelAspectRatio", "float", one);
  put_attribute(file, "screenWindowCenter", "v2f", std::string(8, '\0'));
  put_attribute(file, "screenWindowWidth", "float", one);
  file.push_back('\0');
  const size_t row = 12 * size_t(width), begin = file.size() + 8 * size_t(height);
  for (size_t y = 0; y < size_t(height); ++y) put(file, std::uint64_t(begin + y * (row + 8)));
  for (int y = 0; y < height; ++y) {
    put(file, std::int32_t(y));
    put(file, std::int32_t(row));
    for (int c = 0; c < 3; ++c)
      for (int x = 0; x < width; ++x) put(file, pixel(x, y));
  }
  return file;
}

double radiance(const Vector3& d) {
  return 1 + 0.4 * double(d.x) + 0.25 * double(d.y) - 0.3 * double(d.z) + 0.2 * double(d.x) * double(d.y);
}

/// The direction of a pixel, from the cube's corners that the figure in ImfEnvmap.h shows at a face's upper left, upper right
/// and lower left; corner n lies at x, y, z = +1 where bit 0, 1, 2 of n is set. The centres of a face's outermost pixels lie on
/// its edges.
Vector3 direction(int side, int x, int row) {
  constexpr int corners[6][3] = {{3, 7, 1}, {6, 2, 4}, {6, 7, 2}, {0, 1, 4}, {7, 6, 5}, {2, 3, 0}};
  const auto at = [](int n) { return Vector3{n & 1 ? 1.0f : -1.0f, n & 2 ? 1.0f : -1.0f, n & 4 ? 1.0f : -1.0f}; };
  const int* face = corners[row / side];
  const float right = float(x) / float(side - 1), down = float(row % side) / float(side - 1);
  return normalize(at(face[0]) + right * (at(face[1]) - at(face[0])) + down * (at(face[2]) - at(face[0])));
}

double seen(const std::string& emission, const Vector3& d) {
  const std::string up = std::abs(d.y) > 0.9f ? "[0, 0, 1]" : "[0, 1, 0]";
  return double(test::measure(test::job_text("PathTracer { samples: 64, max_depth: 2 }",
                                             fmt::format("PerspectiveCamera {{ from: [0, 0, 0], to: [{}, {}, {}], up: {}, fov: "
                                                         "0.01 deg }}",
                                                         d.x, d.y, d.z, up),
                                             1, "Environment { emission: " + emission + " }"))
                    .mean.y);
}

TEST(CubeEnvironment, IsSeenWhereOpenExrPutsIt) {
  const TemporaryFolder folder;
  constexpr int side = 48;
  const std::string path =
      folder.write("cube.exr", exr(side, 6 * side, 1, [](int x, int y) { return float(radiance(direction(side, x, y))); }));
  for (const std::string& emission :
       {"EnvironmentEmission { file: \"" + path + "\" }", "DiffuseEmission { radiance: ImageMap { file: \"" + path + "\" } }",
        "EnvironmentEmission { radiance: ImageMap { file: \"" + path + "\" } }"})
    for (const Vector3& d : {Vector3{1, 0, 0}, Vector3{-1, 0, 0}, Vector3{0, 1, 0}, Vector3{0, -1, 0}, Vector3{0, 0, 1},
                             Vector3{0, 0, -1}, Vector3{1, 0.6f, -0.3f}, Vector3{-1, 0.5f, 0.8f}, Vector3{0.4f, 1, -0.7f},
                             Vector3{0.7f, -1, 0.2f}, Vector3{0.5f, -0.6f, 1}, Vector3{-0.9f, 0.3f, -1}})
      EXPECT_NEAR(seen(emission, d), radiance(normalize(d)), 4e-3) << emission << d.x << " " << d.y << " " << d.z;
}

TEST(CubeEnvironment, LongitudeAndLatitudeStayAsTheyAre) {
  const TemporaryFolder folder;
  const auto pixel = [](int x, int y) { return float(x + 8 * y); };
  const std::string silent = folder.write("a.exr", exr(8, 4, -1, pixel)), said = folder.write("b.exr", exr(8, 4, 0, pixel));
  for (const Vector3& d : {Vector3{1, 0.3f, 0.2f}, Vector3{-0.3f, -0.8f, 0.4f}})
    EXPECT_EQ(seen("EnvironmentEmission { file: \"" + said + "\" }", d),
              seen("EnvironmentEmission { file: \"" + silent + "\" }", d));
}

// Mitsuba has no cube maps: the image is exported in longitude and latitude.
TEST(CubeEnvironment, IsExportedAsWhatOthersRead) {
  const TemporaryFolder folder;
  const std::string cube =
      folder.write("cube.exr", exr(8, 48, 1, [](int x, int y) { return float(radiance(direction(8, x, y))); }));
  const Ref<Job> job = load_job_text(test::job_text("PathTracer {}", "PerspectiveCamera { from: [0, 0, 1], to: [0, 0, 0] }", 4,
                                                    "Environment { emission: EnvironmentEmission { file: \"" + cube + "\" } }"),
                                     "t.etd");
  Exporting exporting(folder / "out.xml");
  const std::string text = exporter_of(folder / "out.xml")->write(*job, exporting);
  EXPECT_EQ(text.find("cube.exr"), std::string::npos) << text;
  EXPECT_NE(text.find(".pfm"), std::string::npos) << text;
}

TEST(CubeEnvironment, WhatCannotBeOneIsRefused) {
  const TemporaryFolder folder;
  const auto message = [&](const std::string& emission) -> std::string {
    try {
      seen(emission, {1, 0, 0});
    } catch (const Errors& errors) {
      return errors.what();
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  const auto one = [](int, int) { return 1.0f; };
  const std::string wide = folder.write("w.exr", exr(8, 4, 1, one)), cube = folder.write("c.exr", exr(2, 12, 1, one));
  EXPECT_NE(message("EnvironmentEmission { file: \"" + wide + "\" }").find("8 x 4 pixels"), std::string::npos);
  for (const char* other : {"layout: equal_area", "rows: poles"})
    EXPECT_NE(message("EnvironmentEmission { file: \"" + cube + "\", " + other + " }").find("envmap"), std::string::npos);
  EXPECT_EQ(message("EnvironmentEmission { file: \"" + cube + "\" }"), "");
}

}  // namespace
}  // namespace etendue
