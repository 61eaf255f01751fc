// Materials of v4, also those that v3 shares.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reader.h"

namespace etendue::pbrt {

namespace {

/// The medium between the two interfaces of a coated material: in pbrt its extinction is 1 per unit of length, of which
/// "albedo" is scattered, even if the albedo is 0.
void set_layer(Reader& reader, Component& shader, const Parameters& p) {
  const Location at = p.at;
  set_map(shader, "thickness", number_map(reader, p, {"thickness"}, 0.01), at);
  const Ref<Component> medium = reader.make("HomogeneousVolume", at);
  const Value albedo = color_map(reader, p, {"albedo"}, 0, Use::coefficient);
  if (albedo.as<Ref<Component>>()) {
    reader.importing.inexact("a coat's albedo that a texture says is 0 here", at);
    set_member(*medium, "absorption", 1, at);
  } else if (const Number* n = albedo.as<Number>()) {
    set_member(*medium, "absorption", 1 - std::clamp(n->value, 0.0, 1.0), at);
    set_member(*medium, "scattering", std::clamp(n->value, 0.0, 1.0), at);
  } else {
    const Color scattering = *albedo.as<Color>();
    std::vector<float> wavelengths, rest;
    for (int nm = 360; nm <= 830; nm += 5) {
      wavelengths.push_back(float(nm));
      rest.push_back(std::clamp(1 - scattering->at(float(nm), ColorUse::coefficient), 0.0f, 1.0f));
    }
    set_member(*medium, "absorption", table_spectrum(wavelengths, rest), at);
    set_member(*medium, "scattering", scattering, at);
  }
  const Value g = number_map(reader, p, {"g"}, 0);
  if (const Number* n = g.as<Number>())
    set_member(*medium, "anisotropy", n->value, at);
  else
    reader.importing.inexact("a coat's g that a texture says is 0 here", at);
  set_member(shader, "medium", medium, at);
  // pbrt's limit of events in a walk between the interfaces, and its number of walks: here walks have no limit.
  p.ignore({"maxdepth"});
  p.ignore({"nsamples"});
}

Roughness roughness(const std::string& prefix) {
  const std::string both = prefix + "roughness";
  return {{prefix + "uroughness", both}, {prefix + "vroughness", both}, 0};
}

Ref<Component> dielectric(Reader& reader, const Parameters& p, const std::string& prefix = {}) {
  const Ref<Component> shader = reader.make("Dielectric", p.at);
  const std::string eta = prefix + "eta";
  set_index(reader, *shader, index_of(reader, p, {eta}, 1.5), p.at);
  set_roughness(reader, *shader, p, roughness(prefix));
  return shader;
}

Ref<Component> conductor(Reader& reader, const Parameters& p, const std::string& prefix) {
  const Ref<Component> shader = reader.make("Conductor", p.at);
  set_roughness(reader, *shader, p, roughness(prefix));
  const Parameter* reflectance = p.first_of({"reflectance", "color"});
  if (!reflectance) {
    set_member(*shader, "ior", metal_of(reader, p, prefix), p.at);
    return shader;
  }
  // n = 1 and k = 2 sqrt(r) / sqrt(1 - r) have the reflectance r at normal incidence; pbrt uses them at all angles. It clamps r
  // to 0.9999; 0.9996 is the reflectance of the largest extinction coefficient that is allowed here.
  constexpr float most = 0.9996f;
  const auto extinction = [](float reflected) { return 2 * std::sqrt(reflected) / std::sqrt(1 - reflected); };
  if (reflectance->is("texture")) {
    reader.importing.inexact("a conductor's reflectance that a texture says is multiplied by that of a nearly perfect mirror",
                             reflectance->at);
    set_map(*shader, "color", color_map(reader, p, {reflectance->name}, 0.5, Use::reflectance), p.at);
    set_member(*shader, "ior", complex_index(flat_spectrum(1), flat_spectrum(extinction(most))), p.at);
    return shader;
  }
  const Color r = spectrum_of(reader, p, *reflectance, Use::reflectance);
  std::vector<float> wavelengths, k;
  for (int nm = 360; nm <= 830; nm += 5) {
    wavelengths.push_back(float(nm));
    k.push_back(extinction(std::clamp(r->at(float(nm), ColorUse::reflectance), 0.0f, most)));
  }
  set_member(*shader, "ior", complex_index(flat_spectrum(1), table_spectrum(wavelengths, k)), p.at);
  return shader;
}

Ref<Component> hair(Reader& reader, const Parameters& p) {
  const Location at = p.at;
  const Ref<Component> shader = reader.make("HairShader", at);
  if (p.has("sigma_a")) {
    set_member(*shader, "pigment", "absorption", at);
    set_map(*shader, "absorption", color_map(reader, p, {"sigma_a"}, 1, Use::coefficient), at);
  } else if (p.first_of({"reflectance", "color"})) {
    set_member(*shader, "pigment", "color", at);
    set_map(*shader, "color", color_map(reader, p, {"reflectance", "color"}, 0.5, Use::reflectance), at);
  } else {
    const bool any = p.has("eumelanin") || p.has("pheomelanin");
    set_map(*shader, "eumelanin", number_map(reader, p, {"eumelanin"}, any ? 0 : 1.3), at);
    set_map(*shader, "pheomelanin", number_map(reader, p, {"pheomelanin"}, 0), at);
  }
  set_map(*shader, "longitudinal_roughness", number_map(reader, p, {"beta_m"}, 0.3), at);
  set_map(*shader, "azimuthal_roughness", number_map(reader, p, {"beta_n"}, 0.3), at);
  const auto everywhere = [&](const char* name, double otherwise) {
    const Value value = number_map(reader, p, {name}, otherwise);
    if (const Number* n = value.as<Number>()) return n->value;
    reader.importing.inexact(fmt::format("a hair's '{}' that a texture says is {} here", name, otherwise), p.place(name));
    return otherwise;
  };
  set_member(*shader, "tilt", everywhere("alpha", 2), at);
  set_member(*shader, "ior", everywhere("eta", 1.55), at);
  return shader;
}

/// The material of v3 and v4, given by coefficients, or by a colour and a mean free path.
Ref<Component> subsurface(Reader& reader, const Parameters& p, bool kd) {
  const Location at = p.at;
  const Ref<Component> shader = reader.make("Subsurface", at);
  const double scale = p.number("scale", 1);
  double g = p.number("g", 0);
  const Parameter* color = kd ? p.find("Kd") : p.find("reflectance");
  const auto constant = [&](const char* name, Color otherwise) {
    const Parameter* found = p.find(name);
    if (found && !found->is("texture")) return spectrum_of(reader, p, *found, Use::coefficient);
    if (found) reader.importing.inexact(fmt::format("a '{}' that a texture says is the default here", name), found->at);
    return otherwise;
  };
  const auto table = [](const auto& value) {
    std::vector<float> wavelengths, values;
    for (int nm = 360; nm <= 830; nm += 5) {
      wavelengths.push_back(float(nm));
      values.push_back(float(value(float(nm))));
    }
    return table_spectrum(wavelengths, values);
  };
  if (color || kd) {
    set_map(*shader, "color", color_map(reader, p, {kd ? "Kd" : "reflectance"}, 0.5, Use::reflectance), at);
    const Color mfp = constant("mfp", flat_spectrum(1));
    set_member(*shader, "mean_free_path", scale == 1 ? mfp : scaled_spectrum(scale, mfp), at);
  } else {
    const MeasuredMedium* const named = measured_medium(reader, p, "name");
    const MeasuredMedium& known = named ? *named : whole_milk;
    const auto coefficient = [&](const char* name, const std::array<double, 3>& otherwise) {
      const Color color = rgb_color("srgb", otherwise[0], otherwise[1], otherwise[2]);
      return named ? color : constant(name, color);
    };
    const Color a = coefficient("sigma_a", known.absorption), s = coefficient("sigma_s", known.scattering);
    if (named) g = 0;  // measured scattering coefficients are reduced ones already
    // By similarity, the medium is replaced by an isotropic one of the reduced albedo a', whose diffuse reflectance is van de
    // Hulst's (1 - s)(1 - 0.139 s) / (1 + 1.17 s), s = sqrt((1 - a') / (1 - a' g')), g' = 0.
    const auto reduced = [&](float nm) { return s->at(nm, ColorUse::coefficient) * float(1 - g); };
    const auto extinction = [&](float nm) { return a->at(nm, ColorUse::coefficient) + reduced(nm); };
    set_member(*shader, "color", table([&](float nm) {
      const double t = extinction(nm), root = t > 0 ? std::sqrt(std::max(1 - reduced(nm) / t, 0.0)) : 1;
      return (1 - root) * (1 - 0.139 * root) / (1 + 1.17 * root);
    }),
               at);
    set_member(*shader, "mean_free_path", table([&](float nm) { return 1 / std::max(scale * double(extinction(nm)), 1e-9); }),
               at);
  }
  if (reader.turned)
    reader.importing.inexact("a subsurface material is inside of its shape, also where its orientation is reversed", at);
  reader.importing.inexact("a subsurface material is a diffusion profile here, by its colour and mean free path", at);
  set_map(*shader, "ior", index_of(reader, p, {"eta"}, 1.33), at);
  bool rough = false;
  for (const char* name : {"roughness", "uroughness", "vroughness"}) rough |= p.has(name);
  if (rough) reader.importing.inexact("the boundary of a subsurface material is smooth here", at);
  p.ignore({"remaproughness"});
  return shader;
}

}  // namespace

Ref<Component> make_v4_shader(Reader& reader, const Material& m) {
  const Parameters& p = m.parameters;
  const std::string& type = m.type;
  const Location at = p.at;
  if (type == "diffuse") {
    const Ref<Component> shader = reader.make("Lambertian", at);
    set_map(*shader, "color", color_map(reader, p, {"reflectance"}, 0.5, Use::reflectance), at);
    return shader;
  }
  if (type == "coateddiffuse" || type == "coatedconductor") {
    const Ref<Component> shader = reader.make("LayeredShader", at);
    const bool diffuse = type == "coateddiffuse";
    set_member(*shader, "top", dielectric(reader, p, diffuse ? "" : "interface."), at);
    if (diffuse) {
      const Ref<Component> base = reader.make("Lambertian", at);
      set_map(*base, "color", color_map(reader, p, {"reflectance"}, 0.5, Use::reflectance), at);
      set_member(*shader, "bottom", base, at);
    } else {
      set_member(*shader, "bottom", conductor(reader, p, "conductor."), at);
    }
    set_layer(reader, *shader, p);
    return shader;
  }
  if (type == "conductor") return conductor(reader, p, "");
  if (type == "dielectric") return dielectric(reader, p);
  if (type == "thindielectric") {
    const Ref<Component> shader = reader.make("ThinDielectric", at);
    set_map(*shader, "ior", index_of(reader, p, {"eta"}, 1.5), at);
    set_member(*shader, "polarizations", "averaged", at);
    return shader;
  }
  if (type == "diffusetransmission") {
    const Ref<Component> shader = reader.make("DiffuseTransmitter", at);
    const double scale = p.number("scale", 1);
    for (const char* name : {"reflectance", "transmittance"}) {
      Value map = color_map(reader, p, {name}, 0.25, Use::reflectance);
      if (const Number* n = map.as<Number>())
        map = Value(Number{n->value * scale});
      else if (scale != 1)
        map = Value(formula(reader, at, fmt::format("{} * map", scale), {{"map", map}}));
      set_map(*shader, name, map, at);
    }
    return shader;
  }
  if (type == "measured") {
    const Ref<Component> shader = reader.make("RglShader", at);
    set_member(*shader, "file", FilePath{reader.importing.file(p.text("filename"), p.place("filename"), p.folder), {}}, at);
    set_member(*shader, "symmetric", false, at);
    return shader;
  }
  if (type == "hair") return hair(reader, p);
  if (type == "subsurface") return subsurface(reader, p, false);
  if (type == "kdsubsurface") return subsurface(reader, p, true);
  if (type.empty() || type == "interface" || type == "none") return reader.make("PassThrough", at);
  return nullptr;
}

}  // namespace etendue::pbrt
