// Diffuse surfaces, Phong and Ward models, Disney's BSDF, hair.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "converter.h"
#include "etendue/describe/color.h"
#include "etendue/object_map.h"

namespace etendue::mitsuba {

Converter::Surface Converter::matte(const Element& e, Uv uv, const std::string& name) {
  if (e.type == "difftrans") {
    Ref<Component> shader = make("DiffuseTransmitter", e, name);
    set_member(*shader, "reflectance", 0, e.at);
    set(*shader, "transmittance", color(e, "transmittance", 0.5, uv));
    return {shader, true};
  }
  const bool rough = e.type == "roughdiffuse";
  Ref<Component> shader = make(rough ? "OrenNayar" : "Lambertian", e, name);
  const bool old_name = !e.has("reflectance") && e.has("diffuse_reflectance");
  set(*shader, "color", color(e, old_name ? "diffuse_reflectance" : "reflectance", 0.5, uv));
  if (rough) {
    set(*shader, "roughness", scalar(e, "alpha", 0.2, uv));
    inexact(e, "'roughdiffuse' is a newer model here, which loses no light");
    e.ignore({"use_fast_approx"});
  }
  return {shader, false};
}

Converter::Surface Converter::classic(const Element& e, Uv uv, const std::string& name) {
  const bool phong = e.type == "phong";
  Ref<Component> shader = make(phong ? "PhongShader" : "WardShader", e, name);
  set(*shader, "color", color(e, "diffuse_reflectance", 0.5, uv));
  set(*shader, "specular", color(e, "specular_reflectance", 0.2, uv));
  if (phong) {
    const Value exponent = scalar(e, "exponent", 30, uv);
    if (exponent.as<Number>())
      set(*shader, "exponent", exponent);
    else
      importing_.inexact("the exponent is one number: 32 stands for the texture", e.location_of("exponent"));
  } else {
    const std::string variant = e.string("variant", "balanced");
    if (variant != "balanced")
      importing_.inexact(fmt::format("the variant '{}' of Ward's model is taken for 'balanced'", variant),
                         e.location_of("variant"));
    const Value both = scalar(e, "alpha", 0.1, uv);
    set(*shader, "roughness_u", e.has("alpha_u") ? scalar(e, "alpha_u", 0.1, uv) : both);
    set(*shader, "roughness_v", e.has("alpha_v") ? scalar(e, "alpha_v", 0.1, uv) : both);
  }
  e.ignore({"specular_sampling_weight", "diffuse_amount", "specular_amount"});
  return {shader, false};
}

/// Warns where this program's model and Mitsuba's differ in energy (docs/coming-from-mitsuba.md has the numbers).
void Converter::tell_of_energy(const Element& e, const Component& shader) {
  const Value base = get(shader, "base_color");
  const auto* part = base.as<Ref<Component>>();
  const auto* map = part ? dynamic_cast<const ObjectMap*>(part->get()) : nullptr;
  const Color constant = map ? map->constant() : nullptr;
  constexpr float bright = 0.85f;  // above it the lobes of Mitsuba's model add up to more than 1 by some percent
  if (constant && range_of(*constant, ColorUse::reflectance).most > bright)
    importing_.inexact(
        "'principled' of so bright a colour sends away more light than arrives in Mitsuba, up to a tenth; here it is "
        "scaled down",
        e.location_of("base_color"));
  if (e.has("spec_trans"))
    importing_.inexact(
        "a partly clear 'principled' loses light, the more the rougher it is, and 3 % more here than in Mitsuba: "
        "'energy: kept' of DisneyPrincipled loses none",
        e.location_of("spec_trans"));
}

Converter::Surface Converter::principled(const Element& e, Uv uv, const std::string& name) {
  const bool thin = e.type == "principledthin";
  Ref<Component> shader = make(thin ? "DisneyThin" : "DisneyPrincipled", e, name);
  set(*shader, "base_color", color(e, "base_color", 0.5, uv));
  const auto take = [&](const char* property, double otherwise) {
    if (e.has(property)) set(*shader, property, scalar(e, property, otherwise, uv));
  };
  set(*shader, "roughness", scalar(e, "roughness", 0.5, uv));
  for (const char* property : {"anisotropic", "spec_trans", "spec_tint", "sheen", "sheen_tint", "flatness"}) take(property, 0);
  if (thin) {
    take("diff_trans", 1);
  } else {
    for (const char* property : {"metallic", "clearcoat", "clearcoat_gloss"}) take(property, 0);
  }
  if (e.has("eta")) {
    set_member(*shader, "ior", e.number("eta", 1.5), e.location_of("eta"));
  } else if (!thin && e.has("specular")) {
    // The index of refraction whose reflectance at normal incidence is 0.08 times "specular".
    const double root = std::sqrt(0.08 * std::clamp(e.number("specular", 0.5), 0.0, 10.0));
    set_member(*shader, "ior", 2 / (1 - root) - 1, e.location_of("specular"));
  }
  e.ignore({"diffuse_reflectance_sampling_rate", "main_specular_sampling_rate", "clearcoat_sampling_rate",
            "spec_refl_sampling_rate", "spec_trans_sampling_rate", "diff_trans_sampling_rate"});
  if (!thin) tell_of_energy(e, *shader);
  return {shader, thin || e.has("spec_trans")};
}

Converter::Surface Converter::fibre(const Element& e, const std::string& name) {
  Ref<Component> shader = make("HairShader", e, name);
  if (e.has("sigma_a")) {
    set_member(*shader, "pigment", "absorption", e.at);
    set(*shader, "absorption", color(e, "sigma_a", 0.2, Uv::as_is));
  } else {
    set_member(*shader, "eumelanin", e.number("eumelanin", 1.3), e.location_of("eumelanin"));
    set_member(*shader, "pheomelanin", e.number("pheomelanin", 0.2), e.location_of("pheomelanin"));
  }
  set_member(*shader, "longitudinal_roughness", e.number("longitudinal_roughness", 0.3), e.at);
  set_member(*shader, "azimuthal_roughness", e.number("azimuthal_roughness", 0.3), e.at);
  set_member(*shader, "tilt", e.number("scale_tilt", 2), e.location_of("scale_tilt"));
  set_member(*shader, "ior", index(e, "int_ior", "amber") / index(e, "ext_ior", "air"), e.at);
  return {shader, true};
}

}  // namespace etendue::mitsuba
