// The KHR_materials extensions of glTF.

#include <algorithm>
#include <numbers>

#include "materials.h"

namespace etendue::gltf {
namespace {

/// The highest index of Principled; in KHR_materials_ior 0 stands for an infinite index.
constexpr double highest_ior = 4;
/// F0, the reflectance of a dielectric at normal incidence.
double reflectance_of(double ior) { return ior == 0 ? 1 : std::pow((ior - 1) / (ior + 1), 2); }

}  // namespace

void Materials::read_extensions(const Json& extensions, Surface& s) {
  const auto named = [&](const char* name) -> const Json& { return object_in(extensions, name); };
  read_volume(extensions, s);
  s.ior = gltf::number(named("KHR_materials_ior"), "ior", s.ior);
  const double refracting = s.ior;
  if (!find(extensions, "KHR_materials_pbrSpecularGlossiness")) read_specular(named("KHR_materials_specular"), s);
  if (const Json& e = named("KHR_materials_clearcoat"); !e.empty()) {
    s.coat = number(e, "clearcoatFactor", 0, "clearcoatTexture", "R");
    s.coat_roughness = number(e, "clearcoatRoughnessFactor", 0, "clearcoatRoughnessTexture", "G");
    if (find(e, "clearcoatNormalTexture") && s.coat.value > 0)
      importing_.inexact("a clear coat has the normals of what it covers", at());
  }
  if (const Json& e = named("KHR_materials_sheen"); !e.empty()) {
    s.sheen_color = color(e, "sheenColorFactor", "sheenColorTexture", 0);
    s.sheen_roughness = number(e, "sheenRoughnessFactor", 0, "sheenRoughnessTexture", "A");
    s.sheen_roughness.squared = true;  // alpha_g = roughness^2
  }
  if (const Json& e = named("KHR_materials_iridescence"); !e.empty()) {
    s.film = number(e, "iridescenceFactor", 0, "iridescenceTexture", "R");
    s.film_ior = gltf::number(e, "iridescenceIor", 1.3);
    // mix(minimum, maximum, texture); without a texture the maximum.
    const double thickest = gltf::number(e, "iridescenceThicknessMaximum", 400);
    s.film_thickness = thickest;
    if (auto thickness = texture(e, "iridescenceThicknessTexture")) {
      const double thinnest = gltf::number(e, "iridescenceThicknessMinimum", 100);
      s.film_thickness.value = thickest - thinnest;
      s.film_thickness.offset = thinnest;
      s.film_thickness.texture = thickness;
      s.film_thickness.channel = "G";
      if (thickest == thinnest) s.film_thickness = thickest;
    }
  }
  if (const Json& e = named("KHR_materials_anisotropy"); !e.empty()) {
    // The ratio of the roughnesses alpha along and across is 1 / (1 - a) in Principled, and (alpha + (1 - alpha) s^2) / alpha
    // in glTF.
    const double strength = gltf::number(e, "anisotropyStrength", 0);
    const double alpha = std::max(s.roughness.value * s.roughness.value, 1e-3);
    const double along = alpha + (1 - alpha) * strength * strength;
    s.anisotropy = 1 - alpha / along;
    // glTF keeps the alpha across and increases the alpha along; Principled keeps the sum of their squares for any ratio.
    if (!s.roughness.texture)
      s.roughness.value = std::pow((along * along + alpha * alpha) / 2, 0.25);
    else if (strength != 0)
      importing_.inexact("stretched highlights whose roughness is an image's are as large as without stretching, not longer",
                         at());
    s.anisotropy_rotation = gltf::number(e, "anisotropyRotation", 0) / (2 * std::numbers::pi);
    if (find(e, "anisotropyTexture") && strength != 0)
      importing_.inexact("stretched highlights lie in one direction and are as long everywhere, whatever their texture says",
                         at());
  }
  const auto [least, most] = std::ranges::minmax(s.specular_color.value);
  if ((s.specular_color.texture || least < 0.95 * most) && (s.metalness.value < 1 || s.metalness.texture))
    importing_.inexact("coloured reflections are as coloured at grazing angles, where KHR_materials_specular has them white",
                       at());
  if (!s.thin && s.transmission.value > 0 && s.metalness.value < 1 && s.ior != refracting)
    importing_.inexact("light is refracted by the index that its reflection has, which KHR_materials_specular raises", at());
}

void Materials::read_specular(const Json& e, Surface& s) {
  const SurfaceNumber& metal = s.metalness;
  if (metal.value >= 1 && !metal.texture) {  // the extension and the index do not affect metals
    s.ior = 1.5;
    return;
  }
  s.specular = number(e, "specularFactor", 1, "specularTexture", "A");
  s.specular_color = color(e, "specularColorFactor", "specularColorTexture", 1);
  // A reflectance above or below that of the index is expressed by another index, so that F90 stays 1. If the material
  // refracts, a lower reflectance is expressed by the tint instead.
  const double most = std::ranges::max(s.specular_color.value);
  const bool refracts = s.transmission.value > 0 && !s.thin;
  if (most > 1 || (most < 1 && !refracts) || s.ior == 0 || s.ior > highest_ior) {
    const double f0 = reflectance_of(s.ior);
    SurfaceColor reflected = s.specular_color;
    for (double& x : reflected.value) x = std::min(x * f0, 1.0);
    reflect(reflected, s);
  }
  if (metal.value > 0) keep_metal(s);
}

/// Sets the reflectance at normal incidence. A dark surface that reflects more than insulators do is taken for metal (as in
/// Khronos' own conversion of KHR_materials_pbrSpecularGlossiness, without its blend between the two).
void Materials::reflect(const SurfaceColor& reflected, Surface& s) {
  const double strongest = std::ranges::max(reflected.value);
  const double diffuse = std::ranges::max(s.base_color.value) * (1 - strongest);  // the unreflected part reaches the base
  if (strongest > 0.25 && !(s.metalness.value > 0) && !(s.transmission.value > 0) && !s.base_color.texture && diffuse < 0.1) {
    s.metalness = 1;
    s.base_color = reflected;
    s.specular_color = 1.0;
    s.ior = 1.5;
    return;
  }
  const double f0 = std::clamp(strongest, 0.0, 0.9);
  s.ior = (1 + std::sqrt(f0)) / (1 - std::sqrt(f0));
  s.specular_color = reflected;
  if (strongest > 0)
    for (double& x : s.specular_color.value) x /= strongest;
}

// Principled's specular weight and tint also apply to metal. If metalness is 0 or 1 at each point, the weight can be
// mix(specular, 1, metalness).
void Materials::keep_metal(Surface& s) {
  if (s.specular_color.texture || s.specular_color.value != std::array<double, 3>{1, 1, 1})
    importing_.inexact("the edges of metal are tinted by KHR_materials_specular as those of what is not metal", at());
  if (s.specular.texture) {
    importing_.inexact("metal reflects less too where the image of KHR_materials_specular says it of what is not metal", at());
    return;
  }
  const double weight = s.specular.value;
  if (weight == 1) return;
  s.specular = s.metalness;
  s.specular.value *= 1 - weight;
  s.specular.offset = weight;
  if (s.metalness.texture) return;
  s.specular = weight + s.specular.value;
  importing_.inexact("of a mixture of metal and what is not metal both reflect as much less as KHR_materials_specular says",
                     at());
}

void Materials::read_volume(const Json& extensions, Surface& s) {
  const Json& e = object_in(extensions, "KHR_materials_transmission");
  s.transmission = number(e, "transmissionFactor", 0, "transmissionTexture", "R");
  s.transmission_color = s.base_color;
  if (const Json& diffuse = object_in(extensions, "KHR_materials_diffuse_transmission"); !diffuse.empty()) {
    s.translucence = number(diffuse, "diffuseTransmissionFactor", 0, "diffuseTransmissionTexture", "A");
    s.translucent_color = color(diffuse, "diffuseTransmissionColorFactor", "diffuseTransmissionColorTexture", 1);
  }
  const Json& volume = object_in(extensions, "KHR_materials_volume");
  s.thin = !(gltf::number(volume, "thicknessFactor", 0) > 0);
  s.attenuation_color = rgb(volume, "attenuationColor", 1);
  s.attenuation_distance = gltf::number(volume, "attenuationDistance", s.attenuation_distance);
  // KHR_materials_dispersion: dispersion = 20 / Abbe number.
  const double dispersion = gltf::number(object_in(extensions, "KHR_materials_dispersion"), "dispersion", 0);
  if (dispersion > 0) s.abbe_number = 20 / dispersion;
}

}  // namespace etendue::gltf
