// Surfaces as metallic and rough materials with their extensions: the inverse of what the importer makes of those.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "files/regular_file.h"
#include "writer.h"

namespace etendue::gltf_export {

namespace {

/// What a metal reflects of light straight on.
std::array<double, 3> reflected(const Color& ior) {
  std::vector<float> wavelengths, values;
  const Color absorbed = ior->imaginary();
  for (int nm = 360; nm <= 830; nm += 5) {
    const double n = double(ior->at(float(nm), ColorUse::coefficient)),
                 k = absorbed ? double(absorbed->at(float(nm), ColorUse::coefficient)) : 0;
    wavelengths.push_back(float(nm));
    values.push_back(float((std::pow(n - 1, 2) + k * k) / (std::pow(n + 1, 2) + k * k)));
  }
  return rgb_of(table_spectrum(std::move(wavelengths), std::move(values)), ColorUse::reflectance);
}

}  // namespace

Json& child(Json& of, const char* name) {
  Json& inner = of[name];
  if (inner.is_null()) inner = Json::object();
  return inner;
}
Json& metal(Json& m) { return child(m, "pbrMetallicRoughness"); }

std::array<double, 3> clamped(std::array<double, 3> rgb) {
  for (double& x : rgb) x = std::clamp(x, 0.0, 1.0);
  return rgb;
}
Json with_alpha(const std::array<double, 3>& rgb) { return {rgb[0], rgb[1], rgb[2], 1.0}; }

bool colored(const Component& of, const char* member) {
  const Ref<Component> map = part_of(of, member);
  const Color c = map ? constant_of(*map) : nullptr;
  if (!map || !c) return bool(map);
  return std::ranges::any_of(rgb_of(c, ColorUse::reflectance), [](double x) { return std::abs(x - 1) > 1e-3; });
}

void Writer::extend(Json& m, const char* extension, Json content) {
  child(m, "extensions");
  Json& place = m["extensions"][extension];
  if (place.is_null()) place = Json::object();
  place.update(content.is_null() ? Json::object() : content);
  document_["extensionsUsed"][extension] = true;
}

double Writer::scalar(const Component& of, const char* member, double otherwise) {
  const Value value = value_of(of, member);
  if (const Number* n = value.as<Number>()) return n->value;
  const Ref<Component> map = part_of(of, member);
  const Color c = map ? constant_of(*map) : color_of(of, member);
  if (c) return double(c->at(at_d_line, ColorUse::coefficient));
  if (map) exporting.inexact(fmt::format("'{}' differs from place to place: it is {}", member, otherwise), &of);
  return otherwise;
}

Writer::Look Writer::look(const Component& of, const char* member, ColorUse use) {
  const Ref<Component> map = part_of(of, member);
  if (map) return look_of(*map, use);
  const Color c = color_of(of, member);
  return {c ? rgb_of(c, use) : std::array<double, 3>{1, 1, 1}, std::nullopt};
}

Writer::Look Writer::look_of(const Component& map, ColorUse use) {
  const std::string& type = class_of(map);
  if (const Color c = constant_of(map)) return {rgb_of(c, use), std::nullopt};
  if (type == "ImageMap") {
    Look made{{1, 1, 1}, texture(map, 1, 1, 0, 0, 0)};
    if (!made.texture) made.factor = {0.5, 0.5, 0.5};
    return made;
  }
  if (type == "UvTransformMap") {
    const Ref<Component> inner = part_of(map, "map");
    const std::vector<double> scale = numbers_of(map, "scale"), shift = numbers_of(map, "shift");
    if (inner && constant_of(*inner)) return look_of(*inner, use);
    if (inner && class_of(*inner) == "ImageMap")
      if (auto t = texture(*inner, scale[0], scale[1], number_of(map, "angle") * std::numbers::pi / 180, shift[0], shift[1]))
        return {{1, 1, 1}, std::move(t)};
  }
  if (type == "RgbProductMap" && numbers_of(map, "offset") == std::vector<double>{0, 0, 0}) {
    const Ref<Component> first = part_of(map, "first"), second = part_of(map, "second");
    const Color other = second ? constant_of(*second) : nullptr;
    if (first && other) {
      Look made = look_of(*first, use);
      const std::array<double, 3> more = rgb_of(other, use);
      const std::vector<double> factor = numbers_of(map, "factor");
      for (size_t i = 0; i < 3; ++i) made.factor[i] *= factor[i] * more[i];
      return made;
    }
  }
  if (type == "MultiplyMap" && !part_of(map, "third")) {
    const Ref<Component> first = part_of(map, "first"), second = part_of(map, "second");
    if (first && second) {
      Look a = look_of(*first, use);
      const Look b = look_of(*second, use);
      if (!a.texture || !b.texture) {
        for (size_t i = 0; i < 3; ++i) a.factor[i] *= b.factor[i];
        if (b.texture) a.texture = b.texture;
        return a;
      }
    }
  }
  exporting.inexact(fmt::format("a map like {} is a grey of 0.5", type), &map);
  return {{0.5, 0.5, 0.5}, std::nullopt};
}

Json Writer::image_entry(const std::string& file, const std::string& ending) {
  if (!binary_) return {{"uri", as_uri(exporting.copy_beside(file))}};
  std::string bytes;
  try {
    bytes = read_regular_file(file);
  } catch (const Error& reason) {
    throw Error(fmt::format("cannot read '{}': {}", file, reason.what()));
  }
  document_["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", bytes.size()}});
  buffer_ += bytes;
  buffer_.resize((buffer_.size() + 3) / 4 * 4);  // the numbers that follow stay aligned
  return {{"bufferView", document_["bufferViews"].size() - 1}, {"mimeType", ending == ".png" ? "image/png" : "image/jpeg"}};
}

// Our coordinates of a texel are shift + R(angle) (scale * uv), glTF's the same of coordinates that count v downwards, where a
// turn has the other sense; what the two shifts differ by follows.
std::optional<Json> Writer::texture(const Component& image, double scale_u, double scale_v, double angle, double shift_u,
                                    double shift_v) {
  const std::string file = word_of(image, "file");
  std::string ending = std::filesystem::path(file).extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  if (ending != ".png" && ending != ".jpg" && ending != ".jpeg") {
    exporting.inexact("images are PNG or JPEG files in glTF: another becomes a grey of 0.5", &image);
    return std::nullopt;
  }
  if (!word_of(image, "channel").empty()) exporting.inexact("the choice of an image's channels is left out", &image);
  if (class_of(image) == "ImageMap" && word_of(image, "transfer") == "linear")
    exporting.inexact("the colours of an image are encoded as sRGB in glTF", &image);
  const std::string wrap = word_of(image, "wrap"), above = word_of(image, "wrap_v");
  const std::string wrap_v = above.empty() || above == "same" ? wrap : above;
  if (wrap == "black" || wrap_v == "black") exporting.inexact("an image that is black outside is clamped in glTF", &image);
  const bool nearest = word_of(image, "interpolation") == "nearest";
  size_t& known = textures_[{file, wrap + " " + wrap_v + (nearest ? " nearest" : "")}];
  if (known == 0) {
    constexpr int clamp = 33071, mirror = 33648, repeated = 10497, filter_nearest = 9728, filter_linear = 9729;
    const auto code = [](const std::string& w) {
      return w == "mirror" ? mirror : (w == "clamp" || w == "black" ? clamp : repeated);
    };
    document_["images"].push_back(image_entry(file, ending));
    document_["samplers"].push_back(
        {{"wrapS", code(wrap)}, {"wrapT", code(wrap_v)}, {"magFilter", nearest ? filter_nearest : filter_linear}});
    document_["textures"].push_back(
        {{"source", document_["images"].size() - 1}, {"sampler", document_["samplers"].size() - 1}});
    known = document_["textures"].size();
  }
  Json used{{"index", known - 1}};
  const std::vector<double> repeat = numbers_of(image, "repeat");
  // The image's own repetition comes behind the turn: an even one, or none, is the same before it.
  if (angle != 0 && repeat[0] != repeat[1])
    exporting.inexact("an image that is turned is laid along u and v equally often", &image);
  const double c = std::cos(angle), s = std::sin(angle);
  const double u = scale_u * repeat[0], v = scale_v * repeat[1];
  shift_u *= repeat[0];
  shift_v *= repeat[1];
  if (u != 1 || v != 1 || angle != 0 || shift_u != 0 || shift_v != 0) {
    Json t{{"scale", {u, v}}, {"offset", {shift_u - s * v, 1 - c * v - shift_v}}};
    if (angle != 0) t["rotation"] = angle;
    extend(used, "KHR_texture_transform", std::move(t));
  }
  return used;
}

std::optional<size_t> Writer::material(const SceneObject& o) {
  const Ref<Component> shader = part_of(o, "shader"), light = part_of(o, "emission"), inside = part_of(o, "interior");
  const std::string sides = word_of(o, "sides"), light_sides = light ? word_of(*light, "sides") : "";
  // A luminaire of a given amount shines by its own area.
  const Component* amount = light && has_amount(*light) ? static_cast<const Component*>(&o) : nullptr;
  size_t& known =
      materials_[{shader.get(), light.get(), inside.get(), sides + (amount ? fmt::format("{}", fmt::ptr(amount)) : "")}];
  if (known > 0) return known - 1;
  Json m{{"name", exporting.name_for(shader ? *shader : static_cast<const Component&>(o))}};
  if (shader) {
    surface(m, *shader);
  } else {
    metal(m) = {{"baseColorFactor", with_alpha({0, 0, 0})}, {"metallicFactor", 0}};
    extend(m, "KHR_materials_specular", {{"specularFactor", 0}});
  }
  if (light) emission(m, o, *light);
  if (inside) absorption(m, *inside);
  if (sides == "back" || light_sides == "back") exporting.inexact("what is on the back alone is in front in glTF", &o);
  if (light ? light_sides == "both" : sides == "both") m["doubleSided"] = true;
  if (light && (light_sides == "both") != (sides == "both"))
    exporting.inexact("a luminaire has a surface on the sides that it shines from", &o);
  document_["materials"].push_back(std::move(m));
  known = document_["materials"].size();
  return known - 1;
}

void Writer::emission(Json& m, const SceneObject& o, const Component& e) {
  if (class_of(e) != "DiffuseEmission")
    exporting.inexact(fmt::format("{} shines alike in all directions in glTF", class_of(e)), &e);
  Look light = look(e, "radiance", ColorUse::radiance);
  double most = 0;
  for (double& x : light.factor) most = std::max(most, x = std::max(0.0, x * strength_of(o, e)));
  // The importer takes it for a lamp, not for a bright screen, by the extension, however weak it is.
  if (most > 0) {
    for (double& x : light.factor) x /= most;
    extend(m, "KHR_materials_emissive_strength", {{"emissiveStrength", most}});
  }
  m["emissiveFactor"] = light.factor;
  if (light.texture) m["emissiveTexture"] = *light.texture;
}

// After the distance d so much of light is left: exp(-d absorption). The distance is where the strongest leaves 1 / e.
void Writer::absorption(Json& m, const Component& v) {
  if (class_of(v) != "HomogeneousVolume" || color_of(v, "extinction")) {
    exporting.inexact(fmt::format("a medium like {} is left out", class_of(v)), &v);
    return;
  }
  const Color scattering = color_of(v, "scattering");
  if (scattering && (scattering->varies() || scattering->at(550, ColorUse::coefficient) > 0))
    exporting.inexact("media do not scatter in glTF", &v);
  const std::array<double, 3> a = rgb_of(color_of(v, "absorption"), ColorUse::coefficient);
  const double most = std::ranges::max(a);
  if (!(most > 0)) return;
  extend(m, "KHR_materials_volume",
         {{"thicknessFactor", 1},
          {"attenuationDistance", 1 / most},
          {"attenuationColor", {std::exp(-a[0] / most), std::exp(-a[1] / most), std::exp(-a[2] / most)}}});
}

void Writer::holes(Json& m, const Component& of, const char* member) {
  const double left = scalar(of, member, 1);
  Json& factor = metal(m)["baseColorFactor"];
  if (factor.is_null()) factor = with_alpha({1, 1, 1});
  factor[3] = factor[3].get<double>() * std::clamp(left, 0.0, 1.0);
  m["alphaMode"] = "BLEND";
}

void Writer::surface(Json& m, const Component& s) {
  const std::string& type = class_of(s);
  const auto base = [&](const char* member) {
    const Look l = look(s, member, ColorUse::reflectance);
    metal(m)["baseColorFactor"] = with_alpha(clamped(l.factor));
    if (l.texture) metal(m)["baseColorTexture"] = *l.texture;
  };
  const auto root = [&](const char* member) { return std::sqrt(std::max(0.0, scalar(s, member, 0.1))); };
  if (type == "MaskShader" || type == "NormalMapShader" || type == "BumpShader") {
    if (const Ref<Component> inner = part_of(s, "shader")) surface(m, *inner);
    if (type == "MaskShader") holes(m, s, "opacity");
    if (type == "BumpShader") exporting.inexact("bumps by heights are left out: glTF has maps of normals", &s);
    if (type == "NormalMapShader") {
      Json t;
      if (part_of(s, "map")) exporting.inexact("normals by a map, not an image, are left out", &s);
      if (const auto map = part_of(s, "map") ? std::nullopt : texture(s, 1, 1, 0, 0, 0)) t = *map;
      if (t.is_null()) return;
      if (truth_of(s, "flip_y"))
        exporting.inexact("a map of normals whose green runs downwards is taken as if it ran upwards", &s);
      t["scale"] = number_of(s, "strength");
      m["normalTexture"] = std::move(t);
    }
    return;
  }
  if (s.class_info().find("roughness_v") && part_of(s, "roughness_v"))
    exporting.inexact("a surface that is less rough along one direction is as rough as along u: 'roughness_v' is left out", &s);
  if (s.class_info().find("distribution") && word_of(s, "distribution") == "beckmann")
    exporting.inexact("the facets of a rough surface are GGX's in glTF", &s);
  metal(m)["metallicFactor"] = 0;
  if (type == "Lambertian" || type == "OrenNayar") {
    base("color");
    extend(m, "KHR_materials_specular", {{"specularFactor", 0}});
    if (type == "OrenNayar") exporting.inexact("a rough matt surface is a smooth matt one", &s);
  } else if (type == "PerfectSpecular") {
    base("color");
    metal(m)["metallicFactor"] = 1;
    metal(m)["roughnessFactor"] = 0;
  } else if (type == "Conductor") {
    metal(m) = {{"metallicFactor", 1}, {"roughnessFactor", root("roughness")}};
    std::array<double, 3> color = reflected(color_of(s, "ior"));
    metal(m)["baseColorFactor"] = with_alpha(clamped(color));
    if (colored(s, "color")) exporting.inexact("a metal has the colour of its index alone", &s);
    exporting.inexact("a metal's colour towards its edges follows from that straight on", &s);
  } else if (type == "Dielectric" || type == "ThinDielectric") {
    glass(m, s, type == "ThinDielectric");
  } else if (type == "Plastic" || type == "LossyPlastic") {
    base("color");
    metal(m)["roughnessFactor"] = root("roughness");
    extend(m, "KHR_materials_ior", {{"ior", scalar(s, "ior", 1.5)}});
    exporting.inexact("light between the layers of a plastic is as glTF's dielectrics have it", &s);
  } else if (type == "Principled") {
    principled(m, s);
  } else if (type == "DisneyPrincipled") {
    base("base_color");
    metal(m)["metallicFactor"] = scalar(s, "metallic", 0);
    metal(m)["roughnessFactor"] = scalar(s, "roughness", 0.5);
    exporting.inexact("of DisneyPrincipled colour, metal and roughness are kept", &s);
  } else {
    exporting.inexact(fmt::format("glTF has no surface like {}: a matt grey stands for it", type), &s);
    metal(m)["baseColorFactor"] = with_alpha({0.5, 0.5, 0.5});
  }
}

}  // namespace etendue::gltf_export
