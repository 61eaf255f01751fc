// Common parts of all materials, and mixtures.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "reader.h"

namespace etendue::pbrt {

namespace {

constexpr const char* v4_materials[] = {"diffuse",        "coateddiffuse",       "coatedconductor", "conductor", "dielectric",
                                        "thindielectric", "diffusetransmission", "measured",        "mix",       "interface",
                                        "hair",           "subsurface"};
constexpr const char* v3_materials[] = {"matte",  "plastic",     "uber",   "glass",   "metal",       "substrate",
                                        "mirror", "translucent", "disney", "fourier", "kdsubsurface"};

/// pbrt's remapping of roughness: in v4 alpha is its square root, in v3 a polynomial of its logarithm.
Value alpha_of(Reader& reader, Location at, Value roughness, bool remap, bool v3) {
  if (!remap) return roughness;
  if (const Number* n = roughness.as<Number>())
    return Value(Number{v3 ? v3_alpha(n->value) : std::sqrt(std::max(n->value, 0.0))}, at);
  const char* text = v3 ? "1.62142 + log(max(r, 0.001)) * (0.819955 + log(max(r, 0.001)) * (0.1734 + log(max(r, 0.001)) * "
                          "(0.0171201 + log(max(r, 0.001)) * 0.000640711)))"
                        : "sqrt(max(r, 0))";
  return Value(formula(reader, at, text, {{"r", roughness}}), at);
}

Ref<Component> mix(Reader& reader, const Material& m) {
  const Parameters& p = m.parameters;
  std::vector<std::string> names = p.texts("materials");
  if (names.empty()) names = {p.text("namedmaterial1"), p.text("namedmaterial2")};
  if (names.size() != 2 || names[0].empty() || names[1].empty())
    throw Error("a mixture needs the names of two materials", p.place("materials"));
  const Ref<Component> shader = reader.make("MixShader", p.at, m.name);
  const bool v3 = p.has("namedmaterial1");
  const auto part = [&](const std::string& name) {
    if (reader.version != 3 || reader.named_materials.contains(name)) return shader_named(reader, name, p.at);
    reader.tolerate(fmt::format("there is no material named '{}'", name), "it is 'matte'", p.at);
    const Ref<Component> matte = reader.make("Lambertian", p.at);
    set_member(*matte, "color", 0.5, p.at);
    return matte;
  };
  // v3's amount is the weight of the first material, v4's that of the second.
  set_map(*shader, v3 ? "second" : "first", Value(part(names[0])), p.at);
  set_map(*shader, v3 ? "first" : "second", Value(part(names[1])), p.at);
  if (v3) {
    const Value amount = color_map(reader, p, {"amount"}, 0.5, Use::reflectance);
    if (const Color* c = amount.as<Color>())
      set_member(*shader, "amount", brightness_of(reader, **c, "the amount of a mixture", p.place("amount")), p.at);
    else
      set_map(*shader, "amount", amount, p.at);
  } else {
    set_map(*shader, "amount", number_map(reader, p, {"amount"}, 0.5), p.at);
  }
  return shader;
}

/// Wraps a shader in its bump map and normal map.
Ref<Component> with_relief(Reader& reader, const Parameters& p, Ref<Component> shader) {
  if (const Parameter* bump = p.first_of({"displacement", "bumpmap"})) {
    const Ref<Component> outer = reader.make("BumpShader", p.at);
    set_member(*outer, "shader", shader, p.at);
    Value height = number_map(reader, p, {bump->name}, 0);
    if (reader.turned) height = Value(formula(reader, p.at, "-h", {{"h", height}}), p.at);
    set_map(*outer, "height", height, p.at);
    shader = outer;
  }
  if (p.has("normalmap") && reader.turned)
    reader.importing.inexact("a normal map on a shape whose orientation is reversed tilts the other way along u", p.at);
  if (p.has("normalmap"))
    if (const auto file = image_file(reader, p, "normalmap")) {
      const Ref<Component> outer = reader.make("NormalMapShader", p.at);
      set_member(*outer, "shader", shader, p.at);
      set_member(*outer, "file", *file, p.at);
      set_member(*outer, "green", "across", p.at);
      shader = outer;
    }
  return shader;
}

/// Increments a nesting level during its lifetime.
class Deeper {
 public:
  explicit Deeper(int& level) : level_(level) { ++level_; }
  ~Deeper() { --level_; }
  Deeper(const Deeper&) = delete;
  Deeper& operator=(const Deeper&) = delete;

 private:
  int& level_;
};

/// Marks a material as being made during its lifetime.
class Making {
 public:
  explicit Making(bool& making) : making_(making) { making_ = true; }
  ~Making() { making_ = false; }
  Making(const Making&) = delete;
  Making& operator=(const Making&) = delete;

 private:
  bool& making_;
};

}  // namespace

double brightness_of(Reader& reader, const SpectralFunction& color, const std::string& what, Location at) {
  const ValueRange range = range_of(color, ColorUse::reflectance);
  if (range.most - range.least > 0.01f)
    reader.importing.inexact(fmt::format("{} that differs between colours is their brightness here", what), at);
  return std::min(1.0, double(to_xyz(color, ColorUse::reflectance, illuminant_spectrum("D65").get()).y));
}

// pbrt's eta is the relative index of the two sides, whatever media the path has entered: a boundary between glass and water
// states the quotient of their indices.
void set_index(const Reader& reader, Component& dielectric, const Value& eta, Location at) {
  set_map(dielectric, reader.turned ? "exterior" : "ior", eta, at);
  set_member(dielectric, reader.turned ? "ior" : "exterior", 1, at);
}

double v3_alpha(double roughness) {
  const double x = std::log(std::max(roughness, 1e-3));
  return 1.62142 + x * (0.819955 + x * (0.1734 + x * (0.0171201 + x * 0.000640711)));
}

void set_roughness(Reader& reader, Component& shader, const Parameters& p, const Roughness& asked) {
  const bool v3 = reader.version == 3, remap = p.boolean("remaproughness", true);
  const auto given = [&](const std::vector<std::string>& names) {
    const auto found = std::ranges::find_if(names, [&](const std::string& name) { return p.has(name); });
    return number_map(reader, p, {found == names.end() ? std::string_view(names.back()) : *found}, asked.otherwise);
  };
  const auto zero = [](const Value& v) {
    const Number* n = v.as<Number>();
    return n && n->value == 0;
  };
  Value u = given(asked.u), v = given(asked.v);
  // v4 is smooth if the roughness along either direction is 0; v3's glass if both are 0, and its other materials never: there 0
  // becomes 0.001.
  const bool smooth = asked.glass && zero(u) && zero(v);
  const auto alpha = [&](Value roughness) {
    if (zero(roughness) && (!v3 || smooth)) return roughness;
    Value result = alpha_of(reader, p.at, std::move(roughness), remap, v3);
    if (const Number* n = result.as<Number>(); n && n->value > 1) {
      reader.importing.inexact("a roughness beyond an alpha of 1 is an alpha of 1 here", p.at);
      result = Value(Number{1}, p.at);
    }
    return result;
  };
  const Value along = alpha(u);
  set_map(shader, "roughness", along, p.at);
  if (write_value(u) != write_value(v)) set_map(shader, "roughness_v", alpha(v), p.at);
  set_member(shader, "multiple_scattering", false, p.at);
  // pbrt uses the same height-correlated G for transmission as for reflection.
  const Number* n = along.as<Number>();
  if (shader.class_info().name == "Dielectric" && !(n && n->value == 0)) set_member(shader, "heights", "correlated", p.at);
}

std::vector<std::string> material_names() {
  std::vector<std::string> all(std::begin(v4_materials), std::end(v4_materials));
  all.insert(all.end(), std::begin(v3_materials), std::end(v3_materials));
  return all;
}

bool has_front(const Reader& reader, const Material& material) {
  std::vector<const Material*> open{&material};
  std::set<const Material*> seen;  // mixtures may share parts, and contain themselves
  while (!open.empty()) {
    const Material& m = *open.back();
    open.pop_back();
    if (!seen.insert(&m).second) continue;
    for (const char* relief : {"displacement", "bumpmap", "normalmap"})
      if (std::ranges::count(m.parameters.own, relief, &Parameter::name)) return true;
    for (const char* type : {"dielectric", "glass", "subsurface", "kdsubsurface"})
      if (m.type == type) return true;
    if (m.type != "mix") continue;
    for (const Parameter& p : m.parameters.own) {
      if (p.name != "materials" && p.name != "namedmaterial1" && p.name != "namedmaterial2") continue;
      for (const std::string& name : p.strings)
        if (const auto part = reader.named_materials.find(name); part != reader.named_materials.end())
          open.push_back(&reader.materials[part->second]);
    }
  }
  return false;
}

Ref<Component> shader_of(Reader& reader, size_t index, Location used_at) {
  Material& m = reader.materials[index];
  Ref<Component>& made = m.shaders[reader.turned ? 1 : 0];
  if (made) return made;
  if (m.making) throw Error(fmt::format("the material '{}' is a mixture of itself", m.name), used_at);
  if (reader.mixing >= Reader::most_nested)
    throw Error(fmt::format("mixtures of mixtures nest more than {} deep", Reader::most_nested), m.parameters.at);
  const Making making(m.making);
  const Deeper deeper(reader.mixing);
  Ref<Component> shader = m.type == "mix" ? mix(reader, m) : make_v4_shader(reader, m);
  if (!shader) shader = make_v3_shader(reader, m);
  if (!shader) {
    reader.tolerate(fmt::format("there is no material '{}'{}", m.type, suggestion(m.type, material_names())), "it is 'matte'",
                    m.parameters.at);
    m.type = "matte";
    shader = make_v3_shader(reader, m);
  }
  shader = with_relief(reader, m.parameters, shader);
  if (shader->origin) shader->origin->name = m.name;
  m.parameters.tell_unused(reader.importing);
  made = shader;
  return shader;
}

void make_with_present_textures(Reader& reader, size_t material) {
  try {
    shader_of(reader, material, reader.materials[material].parameters.at);
  } catch (const Error&) {  // reported where the material is used, or at the end
  }
}

Ref<Component> shader_named(Reader& reader, const std::string& name, Location used_at) {
  const auto found = reader.named_materials.find(name);
  if (found != reader.named_materials.end()) return shader_of(reader, found->second, used_at);
  std::vector<std::string> known;
  for (const auto& [n, index] : reader.named_materials) known.push_back(n);
  throw Error(fmt::format("there is no material named '{}'{}", name, suggestion(name, known)), used_at);
}

}  // namespace etendue::pbrt
