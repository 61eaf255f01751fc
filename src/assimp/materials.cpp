// Converts Assimp's materials to glTF.

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "convert.h"
#include "images.h"

namespace etendue::assimp_helper {
namespace {

double clamped(double x, double otherwise = 0) { return std::isfinite(x) ? std::clamp(x, 0.0, 1.0) : otherwise; }

constexpr int repeat_code = 10497, clamp_code = 33071, mirror_code = 33648;  // glTF's codes of wrap modes

class MaterialWriter {
 public:
  MaterialWriter(const aiScene& scene, Glb& glb, const std::string& ending)
      : scene_(scene), glb_(glb), ending_(ending), images_(scene, glb) {}

  /// Adds the scene's material with this index.
  void write(unsigned index) {
    const aiMaterial& m = *scene_.mMaterials[index];
    uv_sets_ = uv_sets_of(index);
    Json material = {{"name", clean(m.GetName().C_Str())}};
    Json pbr = Json::object();
    std::array<double, 3> base = color(m, AI_MATKEY_BASE_COLOR, color(m, AI_MATKEY_COLOR_DIFFUSE, {0.8, 0.8, 0.8}));
    Json base_texture = texture(m, {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE});
    const std::array<double, 3> stated = base;
    // Exporters often leave the colour black when a texture replaces it.
    const bool black = *std::ranges::max_element(base) <= 0;
    if (!base_texture.is_null() && (black || texture_replaces_color(m))) base = {1, 1, 1};
    double metalness = number(m, AI_MATKEY_METALLIC_FACTOR, -1), roughness = number(m, AI_MATKEY_ROUGHNESS_FACTOR, -1);
    Json metal_texture = texture(m, {aiTextureType_METALNESS}), rough_texture = texture(m, {aiTextureType_DIFFUSE_ROUGHNESS});
    Json extensions = Json::object();
    if (metalness < 0 && roughness < 0 && metal_texture.is_null() && rough_texture.is_null()) {
      phong(m, base, base_texture, metalness, roughness, extensions);
    } else {
      metalness = metalness < 0 ? (metal_texture.is_null() ? 0 : 1) : metalness;
      if (roughness < 0) roughness = rough_texture.is_null() ? roughness_of_exponent(m, 0.5) : 1;
      if (!metal_texture.is_null() && metal_texture == rough_texture) {
        pbr["metallicRoughnessTexture"] = metal_texture;
      } else {
        Json own = Json::object();  // separate images of one number, which glTF lacks (importers/gltf/described.h)
        if (!metal_texture.is_null()) own["metalness"] = image_of_numbers(metal_texture, metalness, 0);
        if (!rough_texture.is_null()) own["roughness"] = image_of_numbers(rough_texture, roughness, 0.5);
        if (!own.empty()) extensions["ETENDUE_surface"] = own;
      }
    }
    if (!base_texture.is_null() && base != stated && !black)
      extensions["ETENDUE_surface"]["base_color"] = {
          {"value", base}, {"without", stated}, {"texture", described(base_texture, "")}};
    const double opacity = opacity_of(m);
    pbr["baseColorFactor"] = {base[0], base[1], base[2], opacity};
    pbr["metallicFactor"] = clamped(metalness);
    pbr["roughnessFactor"] = clamped(roughness, 0.5);
    if (!base_texture.is_null()) pbr["baseColorTexture"] = base_texture;
    material["pbrMetallicRoughness"] = pbr;
    const Json holes = texture(m, {aiTextureType_OPACITY});
    if (opacity < 1 || (!holes.is_null() && holes == base_texture)) material["alphaMode"] = "BLEND";
    if (!holes.is_null() && holes != base_texture)
      glb_.note("textures of opacity are left out where they are not the colour's own");
    emission(m, base_texture, material, extensions);
    shape(m, material);
    coat(m, extensions);
    if (const double ior = number(m, AI_MATKEY_REFRACTI, 1.5); ior > 1 && ior <= 4 && ior != 1.5)
      extensions["KHR_materials_ior"] = {{"ior", ior}};
    if (!extensions.empty()) material["extensions"] = extensions;
    glb_.add("materials", material);
  }

 private:
  static double number(const aiMaterial& m, const char* key, unsigned type, unsigned index, double otherwise) {
    float value = 0;
    return m.Get(key, type, index, value) == aiReturn_SUCCESS && std::isfinite(value) ? double(value) : otherwise;
  }
  static std::array<double, 3> color(const aiMaterial& m, const char* key, unsigned type, unsigned index,
                                     const std::array<double, 3>& otherwise) {
    aiColor3D c;
    if (m.Get(key, type, index, c) != aiReturn_SUCCESS) return otherwise;
    const auto usable = [](float x) { return std::isfinite(x) && x > 0 ? double(x) : 0.0; };
    return {usable(c.r), usable(c.g), usable(c.b)};
  }

  /// The number of sets of surface coordinates: the most of any mesh with this material.
  unsigned uv_sets_of(unsigned material) const {
    unsigned most = 0;
    for (unsigned i = 0; i < scene_.mNumMeshes; ++i)
      if (scene_.mMeshes[i]->mMaterialIndex == material) most = std::max(most, scene_.mMeshes[i]->GetNumUVChannels());
    return most;
  }

  bool is_of(std::initializer_list<std::string_view> endings) const {
    return std::ranges::find(endings, ending_) != endings.end();
  }

  /// Whether a texture of the diffuse colour replaces it, as in Blender, 3ds Max and where a property of FBX has a connection.
  /// In the other formats it is multiplied by the colour, as in OpenGL.
  bool texture_replaces_color(const aiMaterial& m) {
    if (!is_of({"3ds", "ase", "blend", "fbx"})) return false;
    if (number(m, AI_MATKEY_TEXBLEND_DIFFUSE(0), 1) < 1)
      glb_.note("textures that 3ds Max mixes with the diffuse colour by an amount below 100 % replace it");
    return true;
  }

  /// A texture in the form of importers/gltf/described.h.
  Json described(const Json& texture, const char* transfer) const {
    const Json& t = glb_.json["textures"][texture["index"].get<size_t>()];
    const Json& sampler = glb_.json["samplers"][t["sampler"].get<size_t>()];
    const auto wrap = [&](const char* key) {
      return sampler[key] == clamp_code ? "clamp" : (sampler[key] == mirror_code ? "mirror" : "repeat");
    };
    return {{"image", t["source"]},
            {"uv_set", texture.value("texCoord", 0)},
            {"transfer", transfer},
            {"wrap", {wrap("wrapS"), wrap("wrapT")}}};
  }
  /// An image whose values are `factor` times its grey; `without` replaces it if the image cannot be read.
  Json image_of_numbers(const Json& texture, double factor, double without) const {
    return {{"value", clamped(factor, 1)}, {"without", without}, {"texture", described(texture, "linear")}};
  }

  // The roughness for a Phong exponent n: alpha^2 = 2 / (n + 2) (Walter et al. 2007), and alpha is the square of the roughness.
  static double roughness_of_exponent(const aiMaterial& m, double otherwise) {
    const double exponent = number(m, AI_MATKEY_SHININESS, -1);
    return exponent > 0 ? std::pow(2 / (exponent + 2), 0.25) : otherwise;
  }

  /// Whether a file states that a surface has no highlight, even if Assimp invents a specular colour.
  bool is_matt(const aiMaterial& m) const {
    int model = 0;
    return (ending_ == "dae" || ending_ == "fbx") && m.Get(AI_MATKEY_SHADING_MODEL, model) == aiReturn_SUCCESS &&
           model == aiShadingMode_Gouraud;
  }

  // Exporters write a strength of 0.5 for the reflectance of 4 % that most materials have.
  void phong(const aiMaterial& m, std::array<double, 3>& base, const Json& base_texture, double& metalness, double& roughness,
             Json& extensions) const {
    const std::array<double, 3> none{0, 0, 0};
    const bool matt = is_matt(m);
    const std::array<double, 3> reflected = matt ? none : color(m, AI_MATKEY_COLOR_SPECULAR, none);
    const double exponent = matt ? 0 : std::max(number(m, AI_MATKEY_SHININESS, 0), 0.0);
    const double strength = number(m, AI_MATKEY_SHININESS_STRENGTH, 1);
    const double most = *std::ranges::max_element(reflected) * (strength > 0 ? std::min(strength, 1.0) : 1);
    metalness = 0;
    roughness = matt ? 1 : roughness_of_exponent(m, 1);
    if (most > 0.3 && base_texture.is_null() && *std::ranges::max_element(base) < 0.05) {
      metalness = 1;
      base = reflected;
      return;
    }
    if (exponent <= 0 || most < 0.5)
      extensions["KHR_materials_specular"] = {{"specularFactor", exponent <= 0 ? 0 : std::min(2 * most, 1.0)}};
  }

  /// Many Collada exporters write 0 for opaque materials, contrary to the specification (1.4, "transparency").
  double opacity_of(const aiMaterial& m) const {
    const double opacity = clamped(number(m, AI_MATKEY_OPACITY, 1), 1);
    if (opacity > 0 || ending_ != "dae") return opacity;
    glb_.note("materials of Collada that are wholly transparent by the letter are opaque: others are not saved");
    return 1;
  }

  void emission(const aiMaterial& m, const Json& base_texture, Json& material, Json& extensions) {
    std::array<double, 3> light = color(m, AI_MATKEY_COLOR_EMISSIVE, {0, 0, 0});
    const Json map = texture(m, {aiTextureType_EMISSION_COLOR, aiTextureType_EMISSIVE});
    if (!map.is_null()) {
      material["emissiveTexture"] = map;
      if (*std::ranges::max_element(light) <= 0) light = {1, 1, 1};
    } else if (!base_texture.is_null() && *std::ranges::max_element(light) > 0 &&
               is_of({"3ds", "ac", "ase", "b3d", "blend", "ms3d", "x"})) {
      // OpenGL and Direct3D without shaders multiply the sum of emitted and reflected light by the texture; Blender and 3ds Max
      // multiply the diffuse colour, here the texture, by the strength of emission.
      material["emissiveTexture"] = base_texture;
      if (ending_ == "blend") light = strength_of_blender(m, light);
    }
    const double intensity = std::max(number(m, AI_MATKEY_EMISSIVE_INTENSITY, 1), 0.0);
    for (double& x : light) x *= intensity;
    const double most = *std::ranges::max_element(light);
    if (most > 1) {
      for (double& x : light) x /= most;
      extensions["KHR_materials_emissive_strength"] = {{"emissiveStrength", most}};
    }
    material["emissiveFactor"] = light;
  }

  /// Blender's strength of emission: Assimp returns its product with the diffuse colour.
  static std::array<double, 3> strength_of_blender(const aiMaterial& m, const std::array<double, 3>& light) {
    const std::array<double, 3> diffuse = color(m, AI_MATKEY_COLOR_DIFFUSE, {0, 0, 0});
    const double most = *std::ranges::max_element(diffuse);
    if (most <= 0) return light;
    const double strength = *std::ranges::max_element(light) / most;
    return {strength, strength, strength};
  }

  void shape(const aiMaterial& m, Json& material) {
    int sides = 0;
    if (m.Get(AI_MATKEY_TWOSIDED, sides) == aiReturn_SUCCESS && sides) material["doubleSided"] = true;
    const Json normals = texture(m, {aiTextureType_NORMALS, aiTextureType_NORMAL_CAMERA});
    if (!normals.is_null()) material["normalTexture"] = normals;
    for (const auto& [type, what] : {std::pair{aiTextureType_HEIGHT, "bumps"},
                                     {aiTextureType_DISPLACEMENT, "displacement"},
                                     {aiTextureType_REFLECTION, "reflections"},
                                     {aiTextureType_SPECULAR, "the strength of highlights"},
                                     {aiTextureType_SHININESS, "the exponent of highlights"}})
      if (m.GetTextureCount(type) > 0) glb_.note(std::string("textures of ") + what + " are left out");
  }

  void coat(const aiMaterial& m, Json& extensions) const {
    const double factor = clamped(number(m, AI_MATKEY_CLEARCOAT_FACTOR, 0));
    if (factor > 0)
      extensions["KHR_materials_clearcoat"] = {
          {"clearcoatFactor", factor},
          {"clearcoatRoughnessFactor", clamped(number(m, AI_MATKEY_CLEARCOAT_ROUGHNESS_FACTOR, 0))}};
    const double through = clamped(number(m, AI_MATKEY_TRANSMISSION_FACTOR, 0));
    if (through > 0) extensions["KHR_materials_transmission"] = {{"transmissionFactor", through}};
  }

  /// The first texture of the first of these types that the material has; null: none.
  Json texture(const aiMaterial& m, std::initializer_list<aiTextureType> types) {
    for (const aiTextureType type : types) {
      aiString path;
      aiTextureMapMode modes[3] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
      unsigned uv = 0;
      if (m.GetTexture(type, 0, &path, nullptr, &uv, nullptr, nullptr, modes) != aiReturn_SUCCESS || path.length == 0) continue;
      m.Get(AI_MATKEY_UVWSRC(type, 0), uv);
      // Exporters of Collada write the number of a channel that counts from 1 where the meshes have only set 0.
      if (uv >= uv_sets_) uv = 0;
      const auto wrap = [](aiTextureMapMode mode) {
        return mode == aiTextureMapMode_Mirror ? mirror_code : (mode == aiTextureMapMode_Wrap ? repeat_code : clamp_code);
      };
      const Json sampler = {{"wrapS", wrap(modes[0])}, {"wrapT", wrap(modes[1])}};
      const Json made = {{"source", images_.index(path.C_Str())}, {"sampler", same("samplers", sampler)}};
      Json info = {{"index", same("textures", made)}};
      if (uv > 0) info["texCoord"] = uv;
      return info;
    }
    return nullptr;
  }

  /// The index of an equal element in a list, or of a new one.
  size_t same(const char* list, const Json& element) {
    const Json& all = glb_.json[list];
    for (size_t i = 0; i < all.size(); ++i)
      if (all[i] == element) return i;
    return glb_.add(list, element);
  }

  const aiScene& scene_;
  Glb& glb_;
  const std::string& ending_;
  ImageWriter images_;
  unsigned uv_sets_ = 0;  // of the material being written
};

}  // namespace

void convert_materials(const aiScene& scene, Glb& glb, const std::string& ending) {
  MaterialWriter writer(scene, glb, ending);
  for (unsigned i = 0; i < scene.mNumMaterials; ++i) writer.write(i);
}

}  // namespace etendue::assimp_helper
