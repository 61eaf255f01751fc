// A factor times a texture: red, green and blue are multiplied separately, as glTF 2.0 (3.9.2), MTL and UsdPreviewSurface
// define it. The picture is compared with the product of the numbers; and images embedded in a model are exported with it.

#include <array>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "etendue/exporter.h"
#include "files/regular_file.h"
#include "mitsuba_support.h"
#include "support/image_file.h"

namespace etendue::mitsuba_test {
namespace {

using Json = nlohmann::json;
using Rgb = std::array<double, 3>;

constexpr Rgb texel{0.8, 0.4, 0.9}, factor{1, 0.5, 0.2}, vertex{0.5, 1, 0.75};

/// A square that faces +z, with a texture of one texel and the given material, in a .glb.
std::string model(const TemporaryFolder& folder, const Json& material, bool colored) {
  const test::ImageFile picture("texel.png", {1, 1, 3, NumberType::uint16}, {0.9063f, 0.6655f, 0.9547f});  // encoded sRGB
  const std::string image = read_regular_file(picture.path);
  std::string bytes;
  const auto put = [&](std::initializer_list<float> list) {
    for (const float x : list) bytes.append(reinterpret_cast<const char*>(&x), 4);
  };
  put({-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0});
  put({0, 1, 1, 1, 1, 0, 0, 0});
  for (int i = 0; i < 4; ++i) put({float(vertex[0]), float(vertex[1]), float(vertex[2])});
  const size_t indices = bytes.size();
  for (const std::uint16_t i : std::initializer_list<std::uint16_t>{0, 1, 2, 0, 2, 3})
    bytes.append(reinterpret_cast<const char*>(&i), 2);
  const size_t at = bytes.size();
  bytes += image;
  const auto view = [](size_t offset, size_t length) {
    return Json{{"buffer", 0}, {"byteOffset", offset}, {"byteLength", length}};
  };
  const auto accessor = [](int view, int type, const char* kind, int count) {
    return Json{{"bufferView", view}, {"componentType", type}, {"type", kind}, {"count", count}};
  };
  Json attributes = {{"POSITION", 0}, {"TEXCOORD_0", 1}};
  if (colored) attributes["COLOR_0"] = 2;
  const Json json = {{"asset", {{"version", "2.0"}}},
                     {"buffers", {{{"byteLength", bytes.size()}}}},
                     {"bufferViews", {view(0, 48), view(48, 32), view(80, 48), view(indices, 12), view(at, image.size())}},
                     {"accessors",
                      {accessor(0, 5126, "VEC3", 4), accessor(1, 5126, "VEC2", 4), accessor(2, 5126, "VEC3", 4),
                       accessor(3, 5123, "SCALAR", 6)}},
                     {"images", {{{"bufferView", 4}, {"mimeType", "image/png"}}}},
                     {"textures", {{{"source", 0}}}},
                     {"materials", {material}},
                     {"meshes", {{{"primitives", {{{"attributes", attributes}, {"indices", 3}, {"material", 0}}}}}}},
                     {"nodes", {{{"mesh", 0}}}},
                     {"scenes", {{{"nodes", {0}}}}}};
  std::string text = json.dump(), all = "glTF";
  text.resize((text.size() + 3) / 4 * 4, ' ');
  bytes.resize((bytes.size() + 3) / 4 * 4);
  const auto word = [&](std::uint32_t x) { all.append(reinterpret_cast<const char*>(&x), 4); };
  word(2);
  word(std::uint32_t(28 + text.size() + bytes.size()));
  word(std::uint32_t(text.size()));
  all += "JSON" + text;
  word(std::uint32_t(bytes.size()));
  return folder.write("model.glb", all + std::string("BIN\0", 4) + bytes);
}

/// The mean colour of a file's square in a uniform white environment, in linear sRGB.
Rgb seen(const std::string& path, bool dark) {
  const Ref<Job> job =
      load_job_text(test::job_text("PathTracer { samples: 256, max_depth: 2 }",
                                   "OrthographicCamera { from: [0, 0, 3], to: [0, 0, 0], width: 1 }", 4,
                                   std::string("Import { file: \"") + path + "\" }" +
                                       (dark ? "" : ", Environment { emission: DiffuseEmission { radiance: rgb(1, 1, 1) } }")),
                    "t.etd");
  const Xyz m = test::measure(job).mean;
  const double x = double(m.x), y = double(m.y), z = double(m.z);
  return {3.2404542 * x - 1.5371385 * y - 0.4985314 * z, -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
          0.0556434 * x - 0.2040259 * y + 1.0572252 * z};
}
void expect_near(const Rgb& is, const Rgb& wanted, double within) {
  for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(is[i], wanted[i], within) << "channel " << i;
}
Rgb times(const Rgb& a, const Rgb& b) { return {a[0] * b[0], a[1] * b[1], a[2] * b[2]}; }

TEST(RgbProducts, OfGltf) {
  const TemporaryFolder folder;
  const Json glows = {
      {"emissiveFactor", factor},
      {"emissiveTexture", {{"index", 0}}},
      {"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 0, 1}}}},
      {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 3}}}, {"KHR_materials_ior", {{"ior", 1}}}}}};
  expect_near(seen(model(folder, glows, false), true), times({3 * texel[0], 3 * texel[1], 3 * texel[2]}, factor), 0.03);
  const TemporaryFolder other;
  const Json scatters = {
      {"pbrMetallicRoughness",
       {{"baseColorFactor", {factor[0], factor[1], factor[2], 1}},
        {"baseColorTexture", {{"index", 0}}},
        {"metallicFactor", 0}}},
      {"extensions", {{"KHR_materials_ior", {{"ior", 1}}}, {"KHR_materials_specular", {{"specularFactor", 0}}}}}};
  expect_near(seen(model(other, scatters, true), false), times(times(texel, factor), vertex), 0.012);
}

// KHR_lights_punctual: ((cos a - cos outer) / (cos inner - cos outer))^2 of the intensity at the angle a from the axis.
TEST(GltfLights, ASpotsEdgeFallsAsTheSquare) {
  const TemporaryFolder folder;
  const double inner = 0.2, outer = 0.6, angle = 0.4;
  const Json json = {
      {"asset", {{"version", "2.0"}}},
      {"extensions",
       {{"KHR_lights_punctual",
         {{"lights",
           {{{"type", "spot"}, {"intensity", 3}, {"spot", {{"innerConeAngle", inner}, {"outerConeAngle", outer}}}}}}}}}},
      {"nodes", {{{"translation", {0, 0, 1}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}}},
      {"scenes", {{{"nodes", {0}}}}}};
  const std::string path = folder.write("spot.gltf", json.dump());
  const auto lit = [&](double x) {
    const std::string place = std::to_string(x);
    return double(
        test::measure(
            load_job_text(
                test::job_text("PathTracer { samples: 16, max_depth: 2 }",
                               "OrthographicCamera { from: [" + place + ", 0, 0.5], to: [" + place + ", 0, 0], width: 0.001 }",
                               4,
                               "Import { file: \"" + path +
                                   "\" }, Rectangle { corner: [-1, -1, 0] m, edge_u: [2, 0, 0] m, edge_v: [0, 2, 0] m, shader: "
                                   "Lambertian { color: 1 } }"),
                "t.etd"))
            .mean.y);
  };
  constexpr double pi = 3.14159265358979323846;
  EXPECT_NEAR(lit(0), 3 / pi, 0.002);
  const double t = (std::cos(angle) - std::cos(outer)) / (std::cos(inner) - std::cos(outer));
  EXPECT_NEAR(lit(std::tan(angle)), 3 / pi * t * t * std::pow(std::cos(angle), 3), 0.002);
}

TEST(RgbProducts, OfMtl) {
  const TemporaryFolder folder;
  const test::ImageFile picture("texel.png", {1, 1, 3, NumberType::uint16}, {0.9063f, 0.6655f, 0.9547f});
  std::filesystem::copy_file(picture.path, folder / "t.png");
  folder.write("m.mtl", "newmtl a\nKd 1 0.5 0.2\nmap_Kd t.png\nillum 1\n");
  const std::string path =
      folder.write("m.obj",
                   "mtllib m.mtl\nusemtl a\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                   "f 1/1 2/2 3/3 4/4\n");
  expect_near(seen(path, false), times(texel, factor), 0.012);
  // -mm: base + gain * texel.
  folder.write("m.mtl", "newmtl a\nKd 1 0.5 0.2\nmap_Kd -mm 0.1 0.5 t.png\nillum 1\n");
  expect_near(seen(path, false), times({0.1 + 0.5 * texel[0], 0.1 + 0.5 * texel[1], 0.1 + 0.5 * texel[2]}, factor), 0.012);
}

// An image embedded in a model is written beside the exported file, and so is a product that the other program cannot express.
TEST(RgbProducts, AreExportedWithTheirPictures) {
  for (const char* name : {"out.xml", "out.pbrt", "out.gltf", "out.glb"}) {
    SCOPED_TRACE(name);
    const TemporaryFolder folder;
    const Json material = {{"pbrMetallicRoughness",
                            {{"baseColorFactor", {factor[0], factor[1], factor[2], 1}},
                             {"baseColorTexture", {{"index", 0}}},
                             {"metallicFactor", 0}}}};
    const std::string path = model(folder, material, false);
    const Ref<Job> job = load_job_text(test::job_text("PathTracer { samples: 256, max_depth: 2 }",
                                                      "OrthographicCamera { from: [0, 0, 3], to: [0, 0, 0], width: 1 }", 4,
                                                      "Environment { emission: DiffuseEmission { radiance: rgb(1, 1, 1) } }"),
                                       "t.etd");
    Importing importing(path, {});
    const Ref<Scene> scene = ref_cast<Scene>(importer_of(path)->import(importing));
    ASSERT_TRUE(scene);
    // The diffuse part alone, which all formats have.
    for (const Ref<SceneObject>& object : scene->objects) {
      const Ref<Component> matte = importing.make("Lambertian", importing.at());
      const Value shader = get(*object, "shader");
      set(*matte, "color", get(**shader.as<Ref<Component>>(), "base_color"));
      set(*object, "shader", Value(matte));
      job->scene->objects.push_back(object);
    }
    const TemporaryFolder target;
    Exporting exporting(target / name);
    const std::string text = exporter_of(name)->write(*job, exporting);
    exporting.write_files();
    target.write(name, text);
    EXPECT_EQ(text.find("model.glb"), std::string::npos);
    if (std::string_view(name) == "out.gltf") {
      EXPECT_TRUE(std::filesystem::exists(target / "out-model-images_0.png"));
      EXPECT_EQ(read_regular_file(target / "out-model-images_0.png"), read_regular_file(path + "#images[0].png"));
    }
    Imported back = import_file(target / name);
    const bool is_model = std::string_view(name).starts_with("out.g");
    ASSERT_TRUE(back.job) << back.told();
    back.job->outputs.clear();
    back.job->image = job->image;
    if (is_model)  // which has no environment
      for (const Ref<SceneObject>& object : job->scene->objects)
        if (object->infinite()) back.job->scene->objects.push_back(object);
    const Xyz a = test::measure(job).mean, b = test::measure(back.job).mean;
    EXPECT_NEAR(b.x / a.x, 1, 0.02) << text.substr(0, 2000);
    EXPECT_NEAR(b.y / a.y, 1, 0.02);
    EXPECT_NEAR(b.z / a.z, 1, 0.03);
  }
}

}  // namespace
}  // namespace etendue::mitsuba_test
