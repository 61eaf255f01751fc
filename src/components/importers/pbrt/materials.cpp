// v4's materials, and what all materials have in common.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reader.h"

namespace etendue::pbrt {

namespace {

constexpr const char* v4_materials[] = {"diffuse",        "coateddiffuse",       "coatedconductor", "conductor", "dielectric",
                                        "thindielectric", "diffusetransmission", "measured",        "mix",       "interface",
                                        "hair",           "subsurface"};
constexpr const char* v3_materials[] = {"matte",  "plastic",     "uber",   "glass",   "metal",       "substrate",
                                        "mirror", "translucent", "disney", "fourier", "kdsubsurface"};

/// pbrt's formula of v4: alpha is the root of the roughness; of v3, a polynomial of its logarithm.
Value alpha_of(Reader& reader, Location at, Value roughness, bool remap, bool v3) {
  if (!remap) return roughness;
  if (const Number* n = roughness.as<Number>())
    return Value(Number{v3 ? v3_alpha(n->value) : std::sqrt(std::max(n->value, 0.0))}, at);
  const char* text = v3 ? "1.62142 + log(max(r, 0.001)) * (0.819955 + log(max(r, 0.001)) * (0.1734 + log(max(r, 0.001)) * "
                          "(0.0171201 + log(max(r, 0.001)) * 0.000640711)))"
                        : "sqrt(max(r, 0))";
  return Value(formula(reader, at, text, {{"r", roughness}}), at);
}

/// The clear layer between the two surfaces of a coated material: it absorbs as if its extinction were 1 per unit of length,
/// of which "albedo" is scattered, whether or not there is any.
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
  // How many events pbrt follows before it gives a walk up, and how many walks it makes: here none is given up.
  p.ignore({"maxdepth"});
  p.ignore({"nsamples"});
}

Ref<Component> dielectric(Reader& reader, const Parameters& p, const std::string& prefix = {}) {
  const Ref<Component> shader = reader.make("Dielectric", p.at);
  const std::string eta = prefix + "eta";
  set_map(*shader, "ior", index_of(reader, p, {eta}, 1.5), p.at);
  set_roughness(reader, *shader, p, 0, false, prefix);
  return shader;
}

Ref<Component> conductor(Reader& reader, const Parameters& p, const std::string& prefix) {
  const Ref<Component> shader = reader.make("Conductor", p.at);
  set_roughness(reader, *shader, p, 0, false, prefix);
  const Parameter* reflectance = p.first_of({"reflectance", "color"});
  if (!reflectance) {
    set_member(*shader, "ior", metal_of(reader, p, prefix), p.at);
    return shader;
  }
  // n = 1 and k = 2 sqrt(r) / sqrt(1 - r) reflect r straight on; pbrt uses them at all angles.
  if (reflectance->is("texture")) {
    reader.importing.inexact("a conductor's reflectance that a texture says is multiplied by that of a nearly perfect mirror",
                             reflectance->at);
    set_map(*shader, "color", color_map(reader, p, {reflectance->name}, 0.5, Use::reflectance), p.at);
    set_member(*shader, "ior", complex_index(flat_spectrum(1), flat_spectrum(200)), p.at);
    return shader;
  }
  const Color r = spectrum_of(reader, p, *reflectance, Use::reflectance);
  std::vector<float> wavelengths, k;
  for (int nm = 360; nm <= 830; nm += 5) {
    const float at = std::clamp(r->at(float(nm), ColorUse::reflectance), 0.0f, 0.9999f);
    wavelengths.push_back(float(nm));
    k.push_back(2 * std::sqrt(at) / std::sqrt(1 - at));
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
  set_member(*shader, "tilt", p.number("alpha", 2), at);
  set_member(*shader, "ior", p.number("eta", 1.55), at);
  return shader;
}

/// v3's and v4's: coefficients, or a colour and a mean free path.
Ref<Component> subsurface(Reader& reader, const Parameters& p, bool kd) {
  const Location at = p.at;
  const Ref<Component> shader = reader.make("Subsurface", at);
  const double scale = p.number("scale", 1), g = p.number("g", 0);
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
    if (!p.text("name").empty()) reader.importing.inexact("a named medium is not known here: skin's default is taken", at);
    const Color a = constant("sigma_a", rgb_color("srgb", 0.0011, 0.0024, 0.014));
    const Color s = constant("sigma_s", rgb_color("srgb", 2.55, 3.21, 3.77));
    // By similarity: the reduced albedo a' of an isotropic medium reflects about
    // 1 - sqrt(1 - a') of ... van de Hulst's (1 - s)(1 - 0.139 s) / (1 + 1.17 s), s = sqrt((1 - a') / (1 - a' g')), g' = 0.
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
  reader.importing.inexact("a subsurface material is a diffusion profile here, by its colour and mean free path", at);
  set_map(*shader, "ior", index_of(reader, p, {"eta"}, 1.33), at);
  if (p.has("roughness") || p.has("uroughness") || p.has("vroughness"))
    reader.importing.inexact("the boundary of a subsurface material is smooth here", at);
  p.ignore({"remaproughness"});
  return shader;
}

Ref<Component> mix(Reader& reader, const Material& m) {
  const Parameters& p = m.parameters;
  std::vector<std::string> names = p.texts("materials");
  if (names.empty()) names = {p.text("namedmaterial1"), p.text("namedmaterial2")};
  if (names.size() != 2 || names[0].empty() || names[1].empty())
    throw Error("a mixture needs the names of two materials", p.place("materials"));
  const Ref<Component> shader = reader.make("MixShader", p.at, m.name);
  const bool v3 = p.has("namedmaterial1");
  // v3's amount is the share of the first, v4's of the second.
  set_map(*shader, v3 ? "second" : "first", Value(shader_named(reader, names[0], p.at)), p.at);
  set_map(*shader, v3 ? "first" : "second", Value(shader_named(reader, names[1], p.at)), p.at);
  if (v3) {
    const Value amount = color_map(reader, p, {"amount"}, 0.5, Use::reflectance);
    if (const Color* c = amount.as<Color>())
      set_member(*shader, "amount", double(to_xyz(**c, ColorUse::reflectance, illuminant_spectrum("D65").get()).y), p.at);
    else
      set_map(*shader, "amount", amount, p.at);
  } else {
    set_map(*shader, "amount", number_map(reader, p, {"amount"}, 0.5), p.at);
  }
  return shader;
}

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
    return shader;
  }
  if (type == "mix") return mix(reader, m);
  if (type == "hair") return hair(reader, p);
  if (type == "subsurface") return subsurface(reader, p, false);
  if (type == "kdsubsurface") return subsurface(reader, p, true);
  if (type.empty() || type == "interface" || type == "none") return reader.make("PassThrough", at);
  return nullptr;
}

/// Bumps and normals around a shader.
Ref<Component> with_relief(Reader& reader, const Parameters& p, Ref<Component> shader) {
  if (const Parameter* bump = p.first_of({"displacement", "bumpmap"})) {
    const Ref<Component> outer = reader.make("BumpShader", p.at);
    set_member(*outer, "shader", shader, p.at);
    set_map(*outer, "height", number_map(reader, p, {bump->name}, 0), p.at);
    shader = outer;
  }
  if (p.has("normalmap"))
    if (const auto file = image_file(reader, p, "normalmap")) {
      const Ref<Component> outer = reader.make("NormalMapShader", p.at);
      set_member(*outer, "shader", shader, p.at);
      set_member(*outer, "file", *file, p.at);
      shader = outer;
    }
  return shader;
}

}  // namespace

double v3_alpha(double roughness) {
  const double x = std::log(std::max(roughness, 1e-3));
  return 1.62142 + x * (0.819955 + x * (0.1734 + x * (0.0171201 + x * 0.000640711)));
}

void set_roughness(Reader& reader, Component& shader, const Parameters& p, double otherwise, bool v3,
                   const std::string& prefix) {
  const std::string r = prefix + "roughness", u = prefix + "uroughness", v = prefix + "vroughness";
  const bool remap = p.boolean("remaproughness", true);
  const auto alpha = [&](std::initializer_list<std::string_view> names) {
    Value roughness = number_map(reader, p, names, otherwise);
    // v3's glass is smooth where nothing says otherwise, and so is v4's at 0.
    const Number* n = roughness.as<Number>();
    if (n && n->value == 0) return roughness;
    return alpha_of(reader, p.at, std::move(roughness), remap, v3);
  };
  set_map(shader, "roughness", alpha({u, r}), p.at);
  const Parameter* across = p.find(v);
  if (p.has(u) || across) set_map(shader, "roughness_v", alpha({v, r}), p.at);
  set_member(shader, "multiple_scattering", false, p.at);
}

std::vector<std::string> material_names() {
  std::vector<std::string> all(std::begin(v4_materials), std::end(v4_materials));
  all.insert(all.end(), std::begin(v3_materials), std::end(v3_materials));
  return all;
}

Ref<Component> shader_of(Reader& reader, size_t index, Location used_at) {
  Material& m = reader.materials[index];
  if (m.shader) return m.shader;
  if (m.making) throw Error(fmt::format("the material '{}' is a mixture of itself", m.name), used_at);
  m.making = true;
  Ref<Component> shader = make_v4_shader(reader, m);
  if (!shader) shader = make_v3_shader(reader, m);
  if (!shader)
    throw Error(fmt::format("there is no material '{}'{}", m.type, suggestion(m.type, material_names())), m.parameters.at);
  shader = with_relief(reader, m.parameters, shader);
  if (shader->origin) shader->origin->name = m.name;
  m.parameters.tell_unused(reader.importing);
  m.shader = shader;
  return shader;
}

Ref<Component> shader_named(Reader& reader, const std::string& name, Location used_at) {
  const auto found = reader.named_materials.find(name);
  if (found != reader.named_materials.end()) return shader_of(reader, found->second, used_at);
  std::vector<std::string> known;
  for (const auto& [n, index] : reader.named_materials) known.push_back(n);
  throw Error(fmt::format("there is no material named '{}'{}", name, suggestion(name, known)), used_at);
}

}  // namespace etendue::pbrt
