#pragma once
// A small glTF file and the result of its import.

#include <cstring>
#include <nlohmann/json.hpp>

#include "etendue/describe/color.h"
#include "mitsuba_support.h"

namespace etendue::gltf_test {

using Json = nlohmann::json;
using mitsuba_test::number;
using mitsuba_test::part;

/// A square of two triangles with a material; more accessors can be added.
class Square {
 public:
  Square() {
    json_ = {{"asset", {{"version", "2.0"}}},
             {"buffers", Json::array()},
             {"bufferViews", Json::array()},
             {"accessors", Json::array()},
             {"images", {{{"uri", "n.ppm"}}}},
             {"textures", {{{"source", 0}}}},
             {"materials", {{{"pbrMetallicRoughness", {{"metallicFactor", 0}}}}}},
             {"nodes", {{{"mesh", 0}}}},
             {"scenes", {{{"nodes", {0}}}}},
             {"scene", 0}};
    json_["meshes"] = {{{"primitives", {{{"material", 0}, {"attributes", Json::object()}}}}}};
    json_["meshes"][0]["primitives"][0]["indices"] = add<std::uint16_t>({0, 1, 2, 0, 2, 3}, "SCALAR", 1, 5123);
    vertices("POSITION", {0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0}, 3);
    vertices("NORMAL", {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);
    vertices("TEXCOORD_0", {0, 1, 1, 1, 1, 0, 0, 0}, 2);  // v downwards
  }
  Json& primitive() { return json_["meshes"][0]["primitives"][0]; }
  Json& material() { return json_["materials"][0]; }
  Json& json() { return json_; }
  int floats(const std::vector<float>& values, int width) {
    return add<float>(values, "VEC" + std::to_string(width), size_t(width), 5126);
  }
  void vertices(const char* name, const std::vector<float>& values, int width) {
    primitive()["attributes"][name] = floats(values, width);
  }

  std::string write(const TemporaryFolder& folder) const {
    folder.write("n.ppm", "P6\n1 1\n255\n\x80\x80\xff");
    folder.write("s.bin", binary_);
    Json all = json_;
    all["buffers"] = {{{"uri", "s.bin"}, {"byteLength", binary_.size()}}};
    return folder.write("s.gltf", all.dump());
  }
  mitsuba_test::Imported import(const TemporaryFolder& folder, const mitsuba_test::Parameters& parameters = {}) const {
    mitsuba_test::Imported result;
    const std::string path = write(folder);
    Importing importing(path, {}, parameters);
    try {
      scene_ = ref_cast<Scene>(importer_of(path)->import(importing));
      result.notes = importing.notes();
    } catch (const Error& e) {
      scene_ = {};
      result.errors = {e};
    }
    return result;
  }
  /// The shader of the first object; `told` gets the messages of the import.
  const Component& shader(const TemporaryFolder& folder, std::string& told) const {
    told = import(folder).told();
    return part(object(), "shader");
  }
  /// Object i of the last import.
  const Component& object(size_t i = 0) const {
    if (!scene_) throw Error("it was refused");
    return *scene_->objects.at(i);
  }
  size_t objects() const { return scene_ ? scene_->objects.size() : 0; }

 private:
  template <class T>
  int add(const std::vector<T>& values, const std::string& type, size_t width, int component) {
    json_["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", values.size() * sizeof(T)}});
    binary_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    json_["accessors"].push_back({{"bufferView", int(json_["bufferViews"].size()) - 1},
                                  {"componentType", component},
                                  {"type", type},
                                  {"count", values.size() / width}});
    return int(json_["accessors"].size()) - 1;
  }
  Json json_;
  std::string binary_;
  mutable Ref<Scene> scene_;
};

/// The value of a constant map, as a number.
inline double constant(const Component& of, const std::string& member) {
  const Value value = get(part(of, member), "value");
  const Color* color = value.as<Color>();
  return color ? double((*color)->at(550, ColorUse::coefficient)) : value.as<Number>()->value;
}
inline std::array<double, 3> rgb_of(const SpectralFunction& reflectance) {
  const RgbSpace& space = rgb_space("srgb");
  const Xyz xyz = to_xyz(reflectance, ColorUse::reflectance, space.illuminant.get());
  std::array<double, 3> rgb{};
  for (size_t i = 0; i < 3; ++i)
    rgb[i] = space.from_xyz[3 * i] * double(xyz.x) + space.from_xyz[3 * i + 1] * double(xyz.y) +
             space.from_xyz[3 * i + 2] * double(xyz.z);
  return rgb;
}
/// The value of a constant map, as red, green and blue.
inline std::array<double, 3> color(const Component& of, const std::string& member) {
  const Value value = get(part(of, member), "value");
  const Color* said = value.as<Color>();
  return said ? rgb_of(**said) : std::array<double, 3>{constant(of, member), constant(of, member), constant(of, member)};
}
/// The class name of a member's value.
inline std::string class_of(const Component& of, const std::string& member) { return part(of, member).class_info().name; }

}  // namespace etendue::gltf_test
