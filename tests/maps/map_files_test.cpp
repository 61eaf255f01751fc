// Maps that come from files: parts of images, images in tiles, means over ellipses, and attributes of meshes.

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "components/maps/footprint.h"
#include "etendue/describe/color.h"
#include "etendue/object_map.h"
#include "support/component_test_support.h"
#include "support/image_file.h"

namespace etendue {
namespace {

using test::create;
using test::Setting;
using test::write_image;

/// A folder for one test, removed by the destructor.
struct Folder {
  std::filesystem::path path;
  explicit Folder(const std::string& name)
      : path(std::filesystem::temp_directory_path() / ("etendue-map-files-" + std::to_string(getpid()) + "-" + name)) {
    std::filesystem::create_directories(path);
  }
  ~Folder() { std::filesystem::remove_all(path); }
  std::string operator/(const std::string& name) const { return (path / name).string(); }
};

SurfacePoint at(float u, float v) {
  SurfacePoint p = test::surface_point({0, 0, 1});
  p.uv = {u, v};
  return p;
}

std::string error_of(const std::string& name, const std::vector<Setting>& settings) {
  try {
    create<Component>(name, settings);
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}

TEST(ImageMap, UdimFilesCoverUnitSquares) {
  const Folder folder("udim");
  for (const auto& [number, value] : {std::pair(1001, 0.1f), {1003, 0.3f}, {1011, 0.5f}})
    write_image(folder / ("wood." + std::to_string(number) + ".exr"), {2, 2, 1, NumberType::single},
                {value, value, value, value});
  write_image(folder / "wood.10x1.exr", {1, 1, 1, NumberType::single}, {1});  // no UDIM number
  for (const char* interpolation : {"nearest", "bilinear"}) {
    const Ref<ObjectMap> map =
        create<ObjectMap>("ImageMap", {{"file", folder / "wood.<UDIM>.exr"}, {"interpolation", interpolation}});
    EXPECT_NEAR(map->scalar(at(0.5f, 0.5f)), 0.1f, 1e-6f);
    EXPECT_NEAR(map->scalar(at(2.99f, 0.01f)), 0.3f, 1e-6f);
    EXPECT_NEAR(map->scalar(at(0.01f, 1.5f)), 0.5f, 1e-6f);
    EXPECT_EQ(map->scalar(at(1.5f, 0.5f)), 0);  // no such file
    EXPECT_EQ(map->scalar(at(0.5f, 7.5f)), 0);  // beyond all tiles
    EXPECT_EQ(map->scalar(at(-0.5f, 0.5f)), 0);
    EXPECT_EQ(map->scalar(at(10.5f, 0.5f)), 0);          // 1011 is above 1001, not right of 1010
    EXPECT_NEAR(map->scalar(at(1, 0.5f)), 0.1f, 1e-6f);  // the border belongs to the existing tile
    EXPECT_NEAR(map->scalar(at(0, 2)), 0.5f, 1e-6f);
    EXPECT_NEAR(map->scalar(at(3, 1)), 0.3f, 1e-6f);
    EXPECT_EQ(map->scalar(at(NAN, 0)), 0);
  }
  EXPECT_NE(error_of("ImageMap", {{"file", folder / "none.<UDIM>.exr"}}).find("<UDIM>"), std::string::npos);
  std::ofstream(folder / "wood.1002.exr") << "no image";
  EXPECT_NE(error_of("ImageMap", {{"file", folder / "wood.<UDIM>.exr"}}).find("wood.1002.exr"), std::string::npos);
}

TEST(ImageMap, ChannelsByName) {
  const Folder folder("channels");
  const std::string file = folder / "layers.exr", bits = folder / "bits.png";
  std::vector<ImageHeader::Channel> channels;
  for (const char* name : {"R", "G", "B", "A", "coat.B", "coat.G", "coat.R", "depth.Z"})
    channels.push_back({name, NumberType::single});
  write_image(file, {1, 1, channels}, {0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f, 0.7f, 8});
  write_image(bits, {1, 1, 4, NumberType::uint8}, {0.2f, 0.2f, 0.2f, 0.6f});
  const auto map = [](const std::string& path, const char* channel) {
    return create<ObjectMap>("ImageMap", {{"file", path}, {"channel", channel}});
  };
  EXPECT_NEAR(map(file, "")->scalar(at(0, 0)), 0.2f, 1e-6f);
  EXPECT_NEAR(map(file, "A")->scalar(at(0, 0)), 0.4f, 1e-6f);
  EXPECT_NEAR(map(file, "g")->scalar(at(0, 0)), 0.2f, 1e-6f);
  EXPECT_NEAR(map(file, "depth.Z")->scalar(at(0, 0)), 8, 1e-5f);
  const Wavelengths w = test::wavelengths();
  const Spectrum coat = map(file, "coat")->reflectance(at(0, 0), w),
                 wanted = rgb_spectrum(rgb_space("srgb"), 0.7f, 0.6f, 0.5f, ColorUse::reflectance, w);
  for (int i = 0; i < spectrum_size; ++i) EXPECT_NEAR(coat[i], wanted[i], 1e-5f);
  EXPECT_NEAR(map(bits, "A")->scalar(at(0, 0)), 0.6f, 1e-5f);  // alpha is never sRGB-encoded
  EXPECT_NEAR(map(bits, "G")->scalar(at(0, 0)), decode_transfer("srgb", 0.2), 1e-4);
  const std::string message = error_of("ImageMap", {{"file", file}, {"channel", "coat.S"}});
  EXPECT_NE(message.find("ImageMap.channel"), std::string::npos) << message;
  EXPECT_NE(message.find("depth.Z"), std::string::npos) << message;
}

// A nearly transparent texel has the colour in the file: opacity is applied by another map.
TEST(ImageMap, AlphaWeighsNoColours) {
  const Folder folder("alpha");
  for (const char* name : {"clear.png", "clear.tga", "clear.tif"}) {
    write_image(folder / name, {1, 1, 4, NumberType::uint8}, {200 / 255.0f, 100 / 255.0f, 50 / 255.0f, 51 / 255.0f});
    const Ref<ObjectMap> map = create<ObjectMap>("ImageMap", {{"file", folder / name}});
    const double expected =
        (decode_transfer("srgb", 200 / 255.0) + decode_transfer("srgb", 100 / 255.0) + decode_transfer("srgb", 50 / 255.0)) / 3;
    EXPECT_NEAR(map->scalar(at(0.5f, 0.5f)), expected, 1e-4) << name;
    EXPECT_NEAR(create<ObjectMap>("ImageMap", {{"file", folder / name}, {"channel", "A"}})->scalar(at(0.5f, 0.5f)), 0.2, 1e-4)
        << name;
  }
}

TEST(ImageMap, AveragesOverTheEllipse) {
  // Stripes and blobs of 1/16 of the image, seen at 75 degrees to the normal along four directions.
  constexpr int size = 256;
  std::vector<float> values;
  const auto value = [](float u, float v) {
    return 0.5f + 0.25f * std::sin(32 * pi * u) + 0.25f * std::sin(20 * pi * (u + v));
  };
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) values.push_back(value((float(x) + 0.5f) / size, 1 - (float(y) + 0.5f) / size));
  const Folder folder("aniso");
  write_image(folder / "waves.exr", {size, size, 1, NumberType::single}, values);
  const Ref<ObjectMap> map = create<ObjectMap>("ImageMap", {{"file", folder / "waves.exr"}});
  test::TestSquare square(2);
  square.reference();
  test::Random random(1);
  double wrong = 0, wrong_turned = 0;
  for (int i = 0; i < 64; ++i) {
    SurfacePoint p = at(random(), random());
    p.object = &square;
    p.footprint = 0.012f * 2;
    const float angle = pi / 4 * float(i % 4), slant = radians(75);
    const Vector3 along{std::cos(angle), std::sin(angle), 0};
    p.ray_direction = std::sin(slant) * along + Vector3{0, 0, -std::cos(slant)};
    p.footprint_cosine = std::abs(dot(p.normal, p.ray_direction));
    const Footprint f = footprint_of(p);
    EXPECT_NEAR(length(f.longer), p.footprint / std::cos(slant), 1e-4f);
    EXPECT_NEAR(std::abs(dot(f.longer, along)), length(f.longer), 1e-4f);
    EXPECT_NEAR(dot(f.longer, f.shorter), 0, 1e-6f);
    // The mean over the ellipse with the footprint's axes; and over the ellipse rotated by a right angle.
    double mean = 0, turned = 0;
    constexpr int n = 2000;
    for (int k = 0; k < n; ++k) {
      const float r = 0.5f * std::sqrt((float(k) + 0.5f) / n), phi = 2.399963f * float(k);  // on Vogel's spiral (sunflower)
      const Vector3 s = r * std::cos(phi) * f.longer + r * std::sin(phi) * f.shorter;
      mean += double(value(p.uv.x + s.x / 2, p.uv.y + s.y / 2)) / n;
      turned += double(value(p.uv.x - s.y / 2, p.uv.y + s.x / 2)) / n;
    }
    wrong += std::pow(double(map->scalar(p)) - mean, 2) / 64;
    wrong_turned += std::pow(double(map->scalar(p)) - turned, 2) / 64;
  }
  EXPECT_LT(std::sqrt(wrong), 0.012);
  EXPECT_GT(std::sqrt(wrong_turned), 0.05);  // the direction matters
}

/// A triangle with its right angle at the origin.
std::string ply(const std::string& properties, const std::vector<std::string>& numbers) {
  return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n" + properties +
         "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 " + numbers[0] + "\n1 0 0 " + numbers[1] +
         "\n0 1 0 " + numbers[2] + "\n3 0 1 2\n";
}

SurfacePoint point_of(const SceneObject& mesh, float x, float y, float time = 0) {
  Ray ray;
  ray.origin = {x, y, 1};
  ray.direction = {0, 0, -1};
  ray.time = time;
  Hit hit;
  SurfacePoint p;
  EXPECT_TRUE(mesh.intersect(ray, hit));
  if (hit) mesh.surface_point(ray, hit, p);
  return p;
}

TEST(AttributeMap, InterpolatesWhatVerticesHave) {
  const Folder folder("attributes");
  std::ofstream(folder / "a.ply") << ply(
      "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\nproperty float quality\nproperty "
      "uchar "
      "label\n",
      {"255 0 0 255 2.5 7", "0 188 0 0 0.5 7", "0 0 128 0 0.5 9"});
  std::ofstream(folder / "b.ply") << ply("property float red\nproperty float green\nproperty float blue\n",
                                         {"0.1 0.2 0.3", "0.1 0.2 0.3", "0.1 0.2 0.3"});
  const Ref<SceneObject> a = create<SceneObject>("TriangleMesh", {{"file", folder / "a.ply"}});
  const Ref<SceneObject> b = create<SceneObject>("TriangleMesh", {{"file", folder / "b.ply"}});
  const auto map = [](const char* name) { return create<ObjectMap>("AttributeMap", {{"name", name}, {"otherwise", 0.125}}); };
  const SurfacePoint p = point_of(*a, 0.25f, 0.5f);  // barycentric weights 1/4, 1/4, 1/2
  const float green = float(decode_transfer("srgb", 188 / 255.0)), blue = float(decode_transfer("srgb", 128 / 255.0));
  const Wavelengths w = test::wavelengths();
  const Spectrum got = map("color")->reflectance(p, w),
                 wanted = rgb_spectrum(rgb_space("srgb"), 0.25f, 0.25f * green, 0.5f * blue, ColorUse::reflectance, w);
  for (int i = 0; i < spectrum_size; ++i) EXPECT_NEAR(got[i], wanted[i], 1e-4f);
  EXPECT_NEAR(map("color")->scalar(p), (0.25f + 0.25f * green + 0.5f * blue) / 3, 1e-5f);
  EXPECT_NEAR(map("alpha")->scalar(p), 0.25f, 1e-5f);
  EXPECT_NEAR(map("quality")->scalar(p), 1, 1e-5f);
  EXPECT_NEAR(map("label")->scalar(p), 8, 1e-5f);
  EXPECT_EQ(map("red")->scalar(p), 0.125f);
  EXPECT_NEAR(map("color")->scalar(point_of(*b, 0.2f, 0.2f)), 0.2f, 1e-5f);  // floats are linear
  EXPECT_EQ(map("quality")->scalar(point_of(*b, 0.2f, 0.2f)), 0.125f);
  EXPECT_EQ(map("quality")->scalar(at(0, 0)), 0.125f);  // no object
}

TEST(AttributeMap, ListedColoursStayWithTheirCornersWhateverTheTransform) {
  const std::vector<double> positions{0, 0, 0, 1, 0, 0, 0, 1, 0}, triangle{0, 1, 2},
      colors{0.9, 0.9, 0.9, 0.3, 0.3, 0.3, 0, 0, 0};
  const Ref<ObjectMap> map = create<ObjectMap>("AttributeMap");
  const std::vector<Setting> lists{{"positions", positions}, {"triangles", triangle}, {"colors", colors}};
  const Transform mirror = Transform::scale({-1, 1, 1});
  const AnimatedTransform moving({{0, mirror}, {1, Transform::translate({1, 0, 0}) * mirror}});
  for (const Value& transform : {Value(Transform()), Value(mirror), Value(moving)}) {
    const Ref<SceneObject> mesh = create<SceneObject>("TriangleMesh", lists);
    set(*mesh, "transform", transform);
    prepare_tree(*mesh);
    const float side = transform.as<Transform>() && transform.as<Transform>()->identity() ? 1 : -1;
    EXPECT_NEAR(map->scalar(point_of(*mesh, side * 0.25f, 0.5f)), 0.25f * 0.9f + 0.25f * 0.3f, 1e-5f);
  }
  std::vector<Setting> short_list = lists;
  short_list.back() = {"colors", std::vector<double>{0, 0, 0}};
  EXPECT_NE(error_of("TriangleMesh", short_list).find("colors"), std::string::npos);
}

TEST(AttributeMap, FacesHaveTheirOwn) {
  // A quad, which becomes two triangles, beside a triangle; before both a triangle without area, which is left out. The
  // properties NAME_0, NAME_1, ... form one attribute.
  const Folder folder("faces");
  std::ofstream(folder / "f.ply")
      << "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
         "property float tint_0\nproperty float tint_1\nproperty float tint_2\nelement face 3\n"
         "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty list uchar int vertex_indices\n"
         "property float weight_0\nproperty float color_0\nend_header\n"
         "0 0 0 0.1 0.2 0.6\n1 0 0 0.1 0.2 0.6\n1 1 0 0.1 0.2 0.6\n0 1 0 0.1 0.2 0.6\n2 0 0 1 1 1\n2 1 0 1 1 1\n"
         "9 9 9 3 0 1 1 7 7\n255 0 0 4 0 1 2 3 0.25 8\n0 128 0 3 1 4 5 0.75 9\n";
  const Ref<SceneObject> mesh = create<SceneObject>("TriangleMesh", {{"file", folder / "f.ply"}});
  const auto map = [](const char* name) { return create<ObjectMap>("AttributeMap", {{"name", name}, {"otherwise", 0.125}}); };
  for (const auto& [x, y] : {std::pair{0.8f, 0.1f}, {0.1f, 0.8f}}) {
    EXPECT_EQ(map("face_weight")->scalar(point_of(*mesh, x, y)), 0.25f);
    EXPECT_NEAR(map("face_color")->scalar(point_of(*mesh, x, y)), 1 / 3.0f, 1e-6f);
    EXPECT_NEAR(map("tint")->scalar(point_of(*mesh, x, y)), 0.3f, 1e-6f);
    EXPECT_EQ(map("weight")->scalar(point_of(*mesh, x, y)), 0.125f);
  }
  EXPECT_EQ(map("face_weight")->scalar(point_of(*mesh, 1.7f, 0.2f)), 0.75f);
  EXPECT_NEAR(map("face_color")->scalar(point_of(*mesh, 1.7f, 0.2f)), float(decode_transfer("srgb", 128 / 255.0)) / 3, 1e-6f);

  const std::vector<double> positions{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, triangles{0, 1, 2, 1, 3, 2};
  const Ref<SceneObject> listed = create<SceneObject>(
      "TriangleMesh",
      {{"positions", positions}, {"triangles", triangles}, {"face_colors", std::vector<double>{0.1, 0.1, 0.1, 0.9, 0.9, 0.9}}});
  EXPECT_NEAR(map("face_color")->scalar(point_of(*listed, 0.2f, 0.2f)), 0.1f, 1e-6f);
  EXPECT_NEAR(map("face_color")->scalar(point_of(*listed, 0.8f, 0.8f)), 0.9f, 1e-6f);
  EXPECT_NE(error_of("TriangleMesh",
                     {{"positions", positions}, {"triangles", triangles}, {"face_colors", std::vector<double>{0.1, 0.1, 0.1}}})
                .find("face_colors"),
            std::string::npos);
}

TEST(AttributeMap, BinaryFilesOfBothByteOrders) {
  const Folder folder("binary");
  for (const bool big : {false, true}) {
    std::ofstream out(folder / "c.ply", std::ios::binary);
    out << "ply\nformat binary_" << (big ? "big" : "little")
        << "_endian 1.0\nelement vertex 3\nproperty ushort red\nproperty float x\n"
        << "property float y\nproperty float z\nproperty ushort green\nproperty ushort blue\nproperty double heat\nelement "
           "face 1\n"
        << "property list uchar int vertex_indices\nend_header\n";
    const auto put = [&](auto value) {
      char bytes[sizeof value];
      std::memcpy(bytes, &value, sizeof value);
      if (big) std::reverse(bytes, bytes + sizeof value);
      out.write(bytes, sizeof value);
    };
    for (int i = 0; i < 3; ++i) {
      put(std::uint16_t(65535));
      for (const float x : {i == 1 ? 1.0f : 0.0f, i == 2 ? 1.0f : 0.0f, 0.0f}) put(x);
      put(std::uint16_t(0));
      put(std::uint16_t(13107));  // a fifth
      put(double(i));
    }
    put(std::uint8_t(3));
    for (int i = 0; i < 3; ++i) put(std::int32_t(i));
    out.close();
    const Ref<SceneObject> mesh = create<SceneObject>("TriangleMesh", {{"file", folder / "c.ply"}});
    const SurfacePoint p = point_of(*mesh, 0.25f, 0.5f);
    EXPECT_NEAR(create<ObjectMap>("AttributeMap")->scalar(p), (1 + decode_transfer("srgb", 0.2)) / 3, 1e-4);
    EXPECT_NEAR(create<ObjectMap>("AttributeMap", {{"name", "heat"}})->scalar(p), 1.25f, 1e-5f);
  }
}

}  // namespace
}  // namespace etendue
