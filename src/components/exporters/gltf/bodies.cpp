// Dielectrics and Principled: writes the members that glTF can express, and warns of the others.

#include <algorithm>
#include <cmath>

#include "writer.h"

namespace etendue::gltf_export {

void Writer::glass(Json& m, const Component& s, bool thin) {
  metal(m) = {{"metallicFactor", 0}, {"roughnessFactor", std::sqrt(std::max(0.0, thin ? 0.0 : scalar(s, "roughness", 0)))}};
  Look tint;
  for (const char* member : {"transmission_tint", "color"})
    if (s.class_info().find(member) && colored(s, member)) {
      const Look l = look(s, member, ColorUse::reflectance);
      for (size_t i = 0; i < 3; ++i) tint.factor[i] *= l.factor[i];
      if (l.texture && tint.texture) exporting.inexact("a second texture of a pane's colour is left out", &s);
      if (l.texture && !tint.texture) tint.texture = l.texture;
    }
  metal(m)["baseColorFactor"] = with_alpha(clamped(tint.factor));
  if (tint.texture) metal(m)["baseColorTexture"] = *tint.texture;
  if (colored(s, "reflection_tint")) exporting.inexact("the colour of a glass's reflections is left out", &s);
  extend(m, "KHR_materials_transmission", {{"transmissionFactor", 1}});
  const Color ior = color_of(s, "ior"), outside = thin ? nullptr : color_of(s, "exterior");
  const double index = double(ior->at(at_d_line, ColorUse::coefficient)) /
                       (outside ? double(outside->at(at_d_line, ColorUse::coefficient)) : 1.0);
  extend(m, "KHR_materials_ior", {{"ior", index}});
  if (index < 1) exporting.inexact("an index of refraction below that around is 1 in glTF", &s);
  if (thin) exporting.inexact("light between the two faces of a pane is as glTF's thin walls have it", &s);
  if (!thin) extend(m, "KHR_materials_volume", {{"thicknessFactor", 1}});
  if (!thin && ior->varies()) {
    // KHR_materials_dispersion: 20 / Abbe number, which is (n_d - 1) / (n_F - n_C).
    const double spread = double(ior->at(486.1f, ColorUse::coefficient)) - double(ior->at(656.3f, ColorUse::coefficient));
    if (spread > 0 && index > 1) extend(m, "KHR_materials_dispersion", {{"dispersion", 20 * spread / (index - 1)}});
  }
}

void Writer::note_left_out(const Component& s, std::initializer_list<const char*> members) {
  const Ref<Component> plain = s.class_info().create();
  for (const char* member : members) {
    const Ref<Component> map = part_of(s, member);
    const Color usual = color_of(*part_of(*plain, member), "value"), c = map ? constant_of(*map) : nullptr;
    if (!map || !usual || (c && rgb_of(c, ColorUse::reflectance) == rgb_of(usual, ColorUse::reflectance))) continue;
    exporting.inexact(fmt::format("'{}' of {} is left out", member, class_of(s)), &s);
  }
}

// The blue channel of a single texture multiplies the metalness, and its green channel the roughness.
void Writer::metal_and_roughness(Json& m, const Component& s) {
  const auto metalness = textured_amount(s, "base_metalness", "B"), roughness = textured_amount(s, "specular_roughness", "G");
  std::optional<Json> first = metalness ? texture(*metalness->image, false) : std::nullopt,
                      second = roughness ? texture(*roughness->image, false) : std::nullopt;
  const auto nothing = [&](const char* member) {
    const Ref<Component> map = part_of(s, member);
    const Color c = map ? constant_of(*map) : nullptr;
    return c && c->at(at_d_line, ColorUse::coefficient) == 0;
  };
  // A texture of only one of them also multiplies the other, unless that is 0; two different textures are not possible.
  const bool both = first && second && *first == *second;
  const bool only_first = first && !second && nothing("specular_roughness");
  const bool only_second = second && !first && nothing("base_metalness");
  if (!both && !only_first) first.reset();
  if (!both && !only_second) second.reset();
  metal(m)["metallicFactor"] = first ? metalness->factor : scalar(s, "base_metalness", 0);
  metal(m)["roughnessFactor"] = second ? roughness->factor : scalar(s, "specular_roughness", 0.5);
  if (first || second) metal(m)["metallicRoughnessTexture"] = first ? *first : *second;
}

// In glTF transmitted light is tinted by the base colour; for a fully transmissive surface transmission_color is written there.
void Writer::principled_base(Json& m, const Component& s, double clear) {
  const Ref<Component> metalness = part_of(s, "base_metalness");
  const Color same = metalness ? constant_of(*metalness) : nullptr;
  const bool all_clear = clear >= 1 && same && same->at(at_d_line, ColorUse::coefficient) <= 0;
  Look base = look(s, all_clear ? "transmission_color" : "base_color", ColorUse::reflectance, true);
  const double weight = all_clear ? 1 : scalar(s, "base_weight", 1);
  for (double& x : base.factor) x *= weight;
  metal_and_roughness(m, s);
  base_color(m, base);
  if (clear > 0 && !all_clear) {
    const Look through = look(s, "transmission_color", ColorUse::reflectance, true);
    if (through.factor != base.factor || through.texture != base.texture)
      exporting.inexact("'transmission_color' of Principled is left out: light has its base's colour", &s);
  }
}

void Writer::principled(Json& m, const Component& s) {
  Json transmission = Json::object(), clearcoat = Json::object();
  const double clear = number(s, "transmission_weight", 0, "R", transmission, "transmissionTexture");
  principled_base(m, s, clear);
  const double coat = number(s, "coat_weight", 0, "R", clearcoat, "clearcoatTexture");
  double ior = number_of(s, "specular_ior");
  if (coat > 0 && !(clear > 0)) {  // in glTF a coat does not change the relative index of what it covers
    ior *= 1 - coat + coat / number_of(s, "coat_ior");
    ior = std::max(ior, 1 / ior);
  }
  if (std::abs(ior - 1.5) > 1e-6) extend(m, "KHR_materials_ior", {{"ior", ior}});
  const Look tint = look(s, "specular_color", ColorUse::reflectance);
  Json shine{{"specularColorFactor", clamped(tint.factor)}};
  const double specular = number(s, "specular_weight", 1, "A", shine, "specularTexture");
  if (specular > 1) exporting.inexact("a 'specular_weight' above 1 is 1 in glTF", &s);
  shine["specularFactor"] = std::clamp(specular, 0.0, 1.0);
  if (tint.texture) shine["specularColorTexture"] = *tint.texture;
  extend(m, "KHR_materials_specular", std::move(shine));
  if (clear > 0) {
    const bool thin = truth_of(s, "thin_walled");
    transmission["transmissionFactor"] = clear;
    extend(m, "KHR_materials_transmission", std::move(transmission));
    if (!thin) extend(m, "KHR_materials_volume", {{"thicknessFactor", 1}});
    // KHR_materials_dispersion: 20 / Abbe number.
    if (const double amount = number_of(s, "transmission_dispersion_scale"); amount > 0 && !thin)
      extend(m, "KHR_materials_dispersion",
             {{"dispersion", 20 * amount / number_of(s, "transmission_dispersion_abbe_number")}});
  }
  if (coat > 0) {
    clearcoat["clearcoatFactor"] = coat;
    clearcoat["clearcoatRoughnessFactor"] = number(s, "coat_roughness", 0, "G", clearcoat, "clearcoatRoughnessTexture");
    extend(m, "KHR_materials_clearcoat", std::move(clearcoat));
    if (number_of(s, "coat_ior") != 1.5) exporting.inexact("the index of a clear coat is 1.5 in glTF", &s);
    note_left_out(s, {"coat_color", "coat_roughness_anisotropy"});
    if (number_of(s, "coat_darkening") > 0) exporting.inexact("a clear coat darkens nothing in glTF", &s);
  }
  if (const double weight = scalar(s, "fuzz_weight", 0); weight > 0) {
    Look fuzz = look(s, "fuzz_color", ColorUse::reflectance);
    for (double& x : fuzz.factor) x *= weight;
    Json sheen{{"sheenColorFactor", clamped(fuzz.factor)},
               {"sheenRoughnessFactor", std::sqrt(std::max(0.0, scalar(s, "fuzz_roughness", 0.5)))}};
    // In glTF the base below the fibres is scaled down by the largest component of their colour.
    if (fuzz.texture || std::ranges::max(fuzz.factor) < 0.999 * weight)
      exporting.inexact("fibres hide as much below them as their strongest colour says in glTF", &s);
    if (fuzz.texture) sheen["sheenColorTexture"] = *fuzz.texture;
    extend(m, "KHR_materials_sheen", std::move(sheen));
  }
  if (const double film = scalar(s, "thin_film_weight", 0); film > 0) {
    const double thickness = scalar(s, "thin_film_thickness", 500);  // [nm], as in glTF
    extend(m, "KHR_materials_iridescence",
           {{"iridescenceFactor", film},
            {"iridescenceIor", number_of(s, "thin_film_ior")},
            {"iridescenceThicknessMinimum", thickness},
            {"iridescenceThicknessMaximum", thickness}});
  }
  note_left_out(s, {"subsurface_weight", "base_diffuse_roughness", "specular_roughness_anisotropy"});
  const Ref<Component> opacity = part_of(s, "geometry_opacity");
  const Color there = opacity ? constant_of(*opacity) : nullptr;
  if (!there || there->at(at_d_line, ColorUse::coefficient) < 1) holes(m, s, "geometry_opacity");
}

}  // namespace etendue::gltf_export
