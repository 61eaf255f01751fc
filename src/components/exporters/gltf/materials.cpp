// Writes surfaces as metallic-roughness materials with their extensions: the inverse of the importer.

#include <algorithm>
#include <cmath>

#include "writer.h"

namespace etendue::gltf_export {

namespace {

/// The reflectance of a metal at normal incidence.
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

std::optional<size_t> Writer::material(const SceneObject& o) {
  const Ref<Component> shader = part_of(o, "shader"), light = part_of(o, "emission"), inside = part_of(o, "interior");
  const std::string sides = word_of(o, "sides"), light_sides = light ? word_of(*light, "sides") : "";
  // The radiance of an emission given as an amount depends on the object's area, so that the material is specific to the
  // object.
  const Component* amount = light && has_amount(*light) ? static_cast<const Component*>(&o) : nullptr;
  size_t& known =
      materials_[{shader.get(), light.get(), inside.get(), sides + (amount ? fmt::format("{}", fmt::ptr(amount)) : "")}];
  if (known > 0) return known - 1;
  of_this_ = {};
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
  if (of_this_.color || of_this_.alpha) from_vertices_[known - 1] = of_this_;
  return known - 1;
}

// The transmittance after the distance d is exp(-d sigma_a). The attenuation distance is chosen such that the strongest
// absorption leaves 1 / e.
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

void Writer::base_color(Json& m, const Look& l) {
  metal(m)["baseColorFactor"] = with_alpha(clamped(l.factor));
  if (l.texture) metal(m)["baseColorTexture"] = *l.texture;
  if (l.by_vertex) of_this_.color = l.by_vertex;
}

void Writer::normals(Json& m, const Component& s) {
  const Ref<Component> map = word_of(s, "file").empty() ? part_of(s, "map") : nullptr;
  const auto placed = map ? placed_of(*map) : Placed{&s};
  if (!placed) return exporting.inexact("normals by a map, not an image, are left out", &s);
  std::optional<Json> t = texture(*placed, false);
  if (!t) return;
  if (truth_of(s, "flip_y")) exporting.inexact("a map of normals whose green runs downwards is taken as if it ran upwards", &s);
  (*t)["scale"] = number_of(s, "strength");
  m["normalTexture"] = std::move(*t);
}

void Writer::surface(Json& m, const Component& s) {
  const std::string& type = class_of(s);
  const auto base = [&](const char* member) { base_color(m, look(s, member, ColorUse::reflectance, true)); };
  const auto root = [&](const char* member) { return std::sqrt(std::max(0.0, scalar(s, member, 0.1))); };
  if (type == "MaskShader" || type == "NormalMapShader" || type == "BumpShader") {
    if (const Ref<Component> inner = part_of(s, "shader")) surface(m, *inner);
    if (type == "MaskShader") holes(m, s, "opacity");
    if (type == "BumpShader") exporting.inexact("bumps by heights are left out: glTF has maps of normals", &s);
    if (type == "NormalMapShader") normals(m, s);
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
