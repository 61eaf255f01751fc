// Materials of v3 that v4 does not have.

#include <fmt/format.h>

#include <algorithm>

#include "reader.h"

namespace etendue::pbrt {

namespace {

/// The largest component or value of a number or colour; 1 for a map.
double largest(const Value& v) {
  if (const Number* n = v.as<Number>()) return n->value;
  const Color* c = v.as<Color>();
  if (!c) return 1;
  const double component = double((*c)->largest_component());
  return component > 0 ? component : double(range_of(**c, ColorUse::reflectance).most);
}

Value divided(Reader& reader, Value v, double by, Location at) {
  if (const Number* n = v.as<Number>()) return Value(Number{n->value / by}, at);
  if (const Color* c = v.as<Color>()) {
    if (!((*c)->largest_component() > 0)) return Value(scaled_spectrum(1 / by, *c), at);
    // RGB components are divided and upsampled again: the divided spectrum itself would exceed 1 at the ends.
    const Xyz xyz = to_xyz(**c, ColorUse::reflectance, illuminant_spectrum("D65").get());
    const auto& m = rgb_space("srgb").from_xyz;
    const auto component = [&](size_t i) {
      return std::clamp((m[i] * double(xyz.x) + m[i + 1] * double(xyz.y) + m[i + 2] * double(xyz.z)) / by, 0.0, 1.0);
    };
    return Value(rgb_color("srgb", component(0), component(3), component(6)), at);
  }
  return Value(formula(reader, at, fmt::format("{} * map", 1 / by), {{"map", v}}), at);
}

/// pbrt's sum of a diffuse surface and a dielectric highlight, Kd / pi + Ks F D G / (4 cos cos). A mixture of both, in which
/// each colour is divided by its weight, is the same sum, and is possible if the colours add up to at most 1. Otherwise pbrt's
/// surface may reflect more light than it receives, and a coated surface replaces it. `seen` is the index for which pbrt
/// computes the highlight.
Ref<Component> plastic(Reader& reader, const Parameters& p, const Roughness& roughness, Value kd, Value ks, double eta,
                       double seen) {
  const Location at = p.at;
  const double d = largest(kd), s = largest(ks);
  if (s == 0) {
    const Ref<Component> matt = reader.make("Lambertian", at);
    set_map(*matt, "color", kd, at);
    p.ignore({"roughness", "uroughness", "vroughness", "remaproughness"});
    return matt;
  }
  if (d + s > 1.0001) {
    reader.importing.inexact(
        "Kd and Ks together may exceed 1: a coated body, of which no more light comes than goes in, "
        "stands for their sum",
        at);
    const Ref<Component> coated = reader.make("Plastic", at);
    set_map(*coated, "color", kd, at);
    set_member(*coated, "ior", std::clamp(eta, 1.0, 4.0), at);
    const Ref<Component> helper = reader.make("Dielectric", at);
    set_roughness(reader, *helper, p, roughness);
    set_map(*coated, "roughness", get(*helper, "roughness"), at);
    return coated;
  }
  const double share = d == 0 ? 0 : d / (d + s);
  const Ref<Component> gloss = reader.make("Conductor", at);
  set_member(*gloss, "ior", complex_index(flat_spectrum(float(seen)), flat_spectrum(0)), at);
  set_roughness(reader, *gloss, p, roughness);
  set_map(*gloss, "color", divided(reader, ks, 1 - share, at), at);
  if (share == 0) return gloss;
  const Ref<Component> matt = reader.make("Lambertian", at);
  set_map(*matt, "color", divided(reader, kd, share, at), at);
  const Ref<Component> both = reader.make("MixShader", at);
  set_member(*both, "first", matt, at);
  set_member(*both, "second", gloss, at);
  set_member(*both, "amount", 1 - share, at);
  return both;
}

Ref<Component> glass(Reader& reader, const Parameters& p) {
  const Ref<Component> shader = reader.make("Dielectric", p.at);
  set_index(reader, *shader, index_of(reader, p, {"eta", "index"}, 1.5), p.at);
  set_roughness(reader, *shader, p, {{"uroughness"}, {"vroughness"}, 0, true});
  if (p.has("Kr")) set_map(*shader, "reflection_tint", color_map(reader, p, {"Kr"}, 1, Use::reflectance), p.at);
  if (p.has("Kt")) set_map(*shader, "transmission_tint", color_map(reader, p, {"Kt"}, 1, Use::reflectance), p.at);
  return shader;
}

Ref<Component> uber(Reader& reader, const Parameters& p) {
  const Location at = p.at;
  const Value eta = index_of(reader, p, {"eta", "index"}, 1.5);
  const Number* n = eta.as<Number>();
  const double index = n ? n->value : 1.5;
  const Roughness roughness{{"uroughness", "roughness"}, {"vroughness", "uroughness", "roughness"}, 0.1};
  Ref<Component> shader = plastic(reader, p, roughness, color_map(reader, p, {"Kd"}, 0.25, Use::reflectance),
                                  color_map(reader, p, {"Ks"}, 0.25, Use::reflectance), index, index);
  for (const char* name : {"Kr", "Kt"}) {
    if (!p.has(name)) continue;
    const Value amount = color_map(reader, p, {name}, 0, Use::reflectance);
    if (largest(amount) > 0)
      reader.importing.inexact(
          fmt::format("'{}' of an uber material is left out: what is mirrored or let through smoothly", name), p.place(name));
  }
  if (p.has("opacity")) {
    const Ref<Component> mask = reader.make("MaskShader", at);
    set_member(*mask, "shader", shader, at);
    const Value opacity = color_map(reader, p, {"opacity"}, 1, Use::reflectance);
    if (const Color* c = opacity.as<Color>())
      set_member(*mask, "opacity", brightness_of(reader, **c, "an opacity", p.place("opacity")), at);
    else
      set_map(*mask, "opacity", opacity, at);
    shader = mask;
  }
  return shader;
}

/// pbrt's FresnelBlend is the model of Ashikhmin and Shirley with GGX microfacets. Here their own highlight is used, with the
/// exponent that makes it equally sharp at the peak: there GGX falls off as 1 - 2 tan^2 / alpha^2 and cos^n as 1 - (n / 2)
/// tan^2, so that n = 4 / alpha^2.
Ref<Component> substrate(Reader& reader, const Parameters& p) {
  const Location at = p.at;
  const Ref<Component> shader = reader.make("AshikhminShirley", at);
  set_map(*shader, "color", color_map(reader, p, {"Kd"}, 0.5, Use::reflectance), at);
  set_map(*shader, "specular", color_map(reader, p, {"Ks"}, 0.5, Use::reflectance), at);
  const bool remap = p.boolean("remaproughness", true);
  for (const auto& [name, member] : {std::pair("uroughness", "exponent_u"), std::pair("vroughness", "exponent_v")}) {
    const Value roughness = number_map(reader, p, {name}, 0.1);
    double alpha = remap ? v3_alpha(0.1) : 0.1;
    if (const Number* n = roughness.as<Number>())
      alpha = remap ? v3_alpha(n->value) : n->value;
    else
      reader.importing.inexact("the roughness of a substrate that a texture says is 0.1 here", p.place(name));
    set_member(*shader, member, std::clamp(4 / (alpha * alpha), 0.0, 1e6), at);
  }
  reader.importing.inexact("a substrate's highlight is Ashikhmin's and Shirley's own, not GGX's", at);
  return shader;
}

Ref<Component> translucent(Reader& reader, const Parameters& p) {
  const Location at = p.at;
  const Value kd = color_map(reader, p, {"Kd"}, 0.25, Use::reflectance);
  const Ref<Component> shader = reader.make("DiffuseTransmitter", at);
  for (const auto& [name, member] : {std::pair("reflect", "reflectance"), std::pair("transmit", "transmittance")}) {
    const Value share = color_map(reader, p, {name}, 0.5, Use::reflectance);
    set_map(*shader, member, Value(formula(reader, at, "a * b", {{"a", kd}, {"b", share}})), at);
  }
  if (largest(color_map(reader, p, {"Ks"}, 0.25, Use::reflectance)) > 0)
    reader.importing.inexact("the highlights of a translucent material are left out", at);
  p.ignore({"roughness"});
  p.ignore({"remaproughness"});
  return shader;
}

Ref<Component> disney(Reader& reader, const Parameters& p) {
  const Location at = p.at;
  const bool thin = p.boolean("thin", false);
  const Ref<Component> shader = reader.make(thin ? "DisneyThin" : "DisneyPrincipled", at);
  const auto carry = [&](const char* from, const char* to, double otherwise) {
    Value value = number_map(reader, p, {from}, otherwise);
    if (const Number* n = value.as<Number>(); n && (n->value < 0 || n->value > 1)) {
      reader.importing.inexact(fmt::format("'{}' of a Disney material is kept within 0 and 1", from), p.place(from));
      value = Value(Number{std::clamp(n->value, 0.0, 1.0)}, at);
    }
    set_map(*shader, to, value, at);
  };
  set_map(*shader, "base_color", color_map(reader, p, {"color"}, 0.5, Use::reflectance), at);
  carry("roughness", "roughness", 0.5);
  carry("anisotropic", "anisotropic", 0);
  carry("spectrans", "spec_trans", 0);
  carry("speculartint", "spec_tint", 0);
  carry("sheen", "sheen", 0);
  carry("sheentint", "sheen_tint", 0.5);
  carry("flatness", "flatness", 0);
  if (thin) {
    carry("difftrans", "diff_trans", 1);
    p.ignore({"metallic", "clearcoat", "clearcoatgloss"});
  } else {
    carry("metallic", "metallic", 0);
    carry("clearcoat", "clearcoat", 0);
    carry("clearcoatgloss", "clearcoat_gloss", 1);
  }
  const Value eta = index_of(reader, p, {"eta"}, 1.5);
  if (const Number* n = eta.as<Number>()) set_member(*shader, "ior", n->value, at);
  const Value distance = color_map(reader, p, {"scatterdistance"}, 0, Use::coefficient);
  if (largest(distance) > 0)
    reader.importing.inexact("the scattering below a Disney material's surface is left out", p.place("scatterdistance"));
  return shader;
}

}  // namespace

Ref<Component> make_v3_shader(Reader& reader, const Material& m) {
  const Parameters& p = m.parameters;
  const Location at = p.at;
  const std::string& type = m.type;
  if (type == "matte") {
    const Value sigma = number_map(reader, p, {"sigma"}, 0);
    const Number* n = sigma.as<Number>();
    const bool lambertian = n && n->value == 0;
    const Ref<Component> shader = reader.make(lambertian ? "Lambertian" : "OrenNayar", at);
    set_map(*shader, "color", color_map(reader, p, {"Kd"}, 0.5, Use::reflectance), at);
    if (!lambertian) {
      // sigma is the standard deviation of the facets' slope angle in degrees; the largest roughness here, 1, stands for 60
      // degrees.
      if (n)
        set_member(*shader, "roughness", std::clamp(n->value / 60, 0.0, 1.0), at);
      else
        set_map(*shader, "roughness", Value(formula(reader, at, "clamp(sigma / 60, 0, 1)", {{"sigma", sigma}})), at);
      reader.importing.inexact("a rough matte surface keeps all energy here, which Oren's and Nayar's own does not", at);
    }
    return shader;
  }
  if (type == "mirror") {
    const Ref<Component> shader = reader.make("PerfectSpecular", at);
    set_map(*shader, "color", color_map(reader, p, {"Kr"}, 0.9, Use::reflectance), at);
    return shader;
  }
  if (type == "plastic") {
    // pbrt computes its highlight for light from inside, from 1.5 to 1: with total internal reflection beyond asin(1 / 1.5).
    constexpr double index = 1.5;
    return plastic(reader, p, {{"roughness"}, {"roughness"}, 0.1}, color_map(reader, p, {"Kd"}, 0.25, Use::reflectance),
                   color_map(reader, p, {"Ks"}, 0.25, Use::reflectance), index, 1 / index);
  }
  if (type == "uber") return uber(reader, p);
  if (type == "glass") return glass(reader, p);
  if (type == "metal") {
    const Ref<Component> shader = reader.make("Conductor", at);
    set_member(*shader, "ior", metal_of(reader, p), at);
    set_roughness(reader, *shader, p, {{"uroughness", "roughness"}, {"vroughness", "roughness"}, 0.01});
    return shader;
  }
  if (type == "substrate") return substrate(reader, p);
  if (type == "translucent") return translucent(reader, p);
  if (type == "disney") return disney(reader, p);
  if (type == "fourier") {
    reader.importing.inexact("a fourier material cannot be read: it is matt grey here", at);
    p.forget();
    return reader.make("Lambertian", at);
  }
  return nullptr;
}

}  // namespace etendue::pbrt
