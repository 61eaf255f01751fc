// Dielectrics, conductors and plastic.

#include <fmt/format.h>

#include <algorithm>

#include "converter.h"
#include "etendue/describe/color.h"

namespace etendue::mitsuba {

namespace {

struct NamedIndex {
  const char* name;
  double index;
};
// Mitsuba's own values, so that scenes look the same: "Mitsuba 3 documentation", plugin "dielectric".
constexpr NamedIndex indices[] = {{"vacuum", 1.0},      {"helium", 1.00004},         {"hydrogen", 1.00013},
                                  {"air", 1.000277},    {"carbon dioxide", 1.00045}, {"water", 1.3330},
                                  {"acetone", 1.36},    {"ethanol", 1.361},          {"carbon tetrachloride", 1.461},
                                  {"glycerol", 1.4729}, {"benzene", 1.501},          {"silicone oil", 1.52045},
                                  {"bromine", 1.661},   {"water ice", 1.31},         {"fused quartz", 1.458},
                                  {"pyrex", 1.470},     {"acrylic glass", 1.49},     {"polypropylene", 1.49},
                                  {"bk7", 1.5046},      {"sodium chloride", 1.544},  {"amber", 1.55},
                                  {"pet", 1.5750},      {"diamond", 2.419}};

}  // namespace

double Converter::index(const Element& e, const char* name, const char* otherwise) {
  const auto look_up = [&](std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    std::vector<std::string> known;
    for (const NamedIndex& i : indices) {
      if (text == i.name) return i.index;
      known.emplace_back(i.name);
    }
    throw Error(fmt::format("no material of index '{}' is known{}", text, suggestion(text, known)), e.location_of(name));
  };
  const Property* p = e.find(name);
  if (!p) return look_up(otherwise);
  if (std::holds_alternative<std::string>(p->value)) return look_up(e.string(name, ""));
  const double index = e.number(name, 1);
  if (!(index > 0)) throw Error(fmt::format("'{}' must be more than 0", name), p->at);
  return index;
}

void Converter::set_roughness(Component& shader, const Element& e, Uv uv, double otherwise) {
  const std::string distribution = e.string("distribution", "beckmann");
  if (distribution == "ggx" || distribution == "beckmann") {
    set_member(shader, "distribution", distribution, e.location_of("distribution"));
  } else if (distribution == "phong" || distribution == "as") {
    importing_.inexact(fmt::format("the microfacet distribution '{}' is taken for 'beckmann'", distribution),
                       e.location_of("distribution"));
    set_member(shader, "distribution", "beckmann", e.at);
  } else {
    throw Error(fmt::format("there is no microfacet distribution '{}'{}", distribution,
                            suggestion(distribution, {"beckmann", "ggx", "phong", "as"})),
                e.location_of("distribution"));
  }
  if (e.has("alpha_u") || e.has("alpha_v")) {
    set(shader, "roughness", scalar(e, "alpha_u", otherwise, uv));
    set(shader, "roughness_v", scalar(e, "alpha_v", otherwise, uv));
  } else {
    set(shader, "roughness", scalar(e, "alpha", otherwise, uv));
  }
  set_member(shader, "multiple_scattering", false, e.at);
  set_member(shader, "heights", "independent", e.at);  // G is the product of two G1 (MicrofacetDistribution::G)
  e.ignore({"sample_visible"});
}

Converter::Surface Converter::dielectric(const Element& e, Uv uv, const std::string& name) {
  const double inside = index(e, "int_ior", "bk7"), outside = index(e, "ext_ior", "air");
  const bool thin = e.type == "thindielectric";
  Ref<Component> shader = make(thin ? "ThinDielectric" : "Dielectric", e, name);
  if (thin) {
    set_member(*shader, "ior", inside / outside, e.location_of("int_ior"));
    set_member(*shader, "polarizations", "averaged", e.at);
  } else {
    set_member(*shader, "ior", inside, e.location_of("int_ior"));
    set_member(*shader, "exterior", outside, e.location_of("ext_ior"));
    if (e.type == "roughdielectric") set_roughness(*shader, e, uv, 0.1);
  }
  if (e.has("specular_reflectance")) set(*shader, "reflection_tint", color(e, "specular_reflectance", 1, uv));
  if (e.has("specular_transmittance")) set(*shader, "transmission_tint", color(e, "specular_transmittance", 1, uv));
  return {shader, true};
}

namespace {

/// The index n for Mitsuba's lossless conductor, whose n = 0 reflects all light: F = ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2) at
/// normal incidence, which for k = 1 is 1 - 2 n to first order. Here an index must be positive.
constexpr float almost_no_index = 1e-6f;

/// Mitsuba's tables that do not cover the visible range. Mitsuba uses n = 0 in the gaps, which reflects all light.
constexpr const char* going_on = "and all light beyond is reflected: here the last n and k go on";
constexpr std::tuple<const char*, const char*, const char*> incomplete_tables[] = {
    {"AlSb", "ends at 590 nm", going_on},
    {"d-C", "ends at 656 nm", going_on},
    {"Se", "ends at 689 nm", going_on},
    {"Se-e", "ends at 689 nm", going_on},
    {"AlAs", "has n = 0 from 394 to 435 nm",
     "where all light is reflected: here n goes evenly from what it is on either side"}};

/// A table of refractive indices that ends within the visible range is extended by its first and last values: an index of 0 is
/// invalid.
Color going_on_at_its_ends(const Color& table) {
  constexpr int first = 360, last = 830;  // [nm]
  const auto at = [&](int nm) { return table->at(float(nm), ColorUse::coefficient); };
  int low = first, high = last;
  while (low < last && at(low) == 0) ++low;
  while (high > low && at(high) == 0) --high;
  if (low == first && high == last) return table;
  if (low == last) return table;  // 0 everywhere: reported where the index is used
  std::vector<float> wavelengths, values;
  for (int nm = first; nm <= last; ++nm) {
    wavelengths.push_back(float(nm));
    values.push_back(at(std::clamp(nm, low, high)));
  }
  return table_spectrum(std::move(wavelengths), std::move(values));
}

/// The complex index of a material name of Mitsuba; warns where the values differ from Mitsuba's.
Color named_metal(Importing& importing, const std::string& material, Location at) {
  // Mitsuba has most tables under two names, one of which states the source (Palik's handbook): "Mo" and "Mo_palik".
  constexpr std::string_view palik = "_palik";
  std::vector<std::string> names = {material};
  if (material.ends_with(palik)) names.push_back(material.substr(0, material.size() - palik.size()));
  for (const std::string& name : names) {
    Color index;
    try {
      index = metal_index(name);
    } catch (const Error&) {
      continue;
    }
    for (const auto& [incomplete, what, instead] : incomplete_tables)
      if (names.back() == incomplete)
        importing.inexact(fmt::format("Mitsuba's table of '{}' {}, {}", material, what, instead), at);
    return index;
  }
  std::string list;
  for (const std::string& known : metal_names()) list += (list.empty() ? "'" : ", '") + known + "'";
  importing.inexact(
      fmt::format("the optical constants of '{}' are not known here{}: those of chromium stand for them; known are {}",
                  material, suggestion(material, metal_names()), list),
      at);
  return metal_index("Cr");
}

}  // namespace

Converter::Surface Converter::conductor(const Element& e, Uv uv, const std::string& name) {
  const std::string material = e.string("material", e.old && !e.has("eta") ? "Cu" : "none");
  const bool lossless = material == "none" || material == "None";
  const bool by_numbers = e.has("eta") || e.has("k");
  const bool rough = e.type == "roughconductor";
  if (!by_numbers && lossless && !rough) {
    Ref<Component> mirror = make("PerfectSpecular", e, name);
    set(*mirror, "color", color(e, "specular_reflectance", 1, uv));
    return {mirror, false};
  }
  Ref<Component> shader = make("Conductor", e, name);
  if (by_numbers) {
    const Property *n = e.find("eta"), *k = e.find("k");
    const auto* rgb_n = n ? std::get_if<ColorValue>(&n->value) : nullptr;
    const auto* rgb_k = k ? std::get_if<ColorValue>(&k->value) : nullptr;
    const double exterior = e.has("ext_eta") ? index(e, "ext_eta", "air") : 1;
    const auto three = [&](const ColorValue& c) {
      return Numbers{{c.rgb[0] / exterior, c.rgb[1] / exterior, c.rgb[2] / exterior}, 1, Dimension::none};
    };
    if (e.old && rgb_n && rgb_k && rgb_n->kind == ColorValue::Kind::rgb && rgb_k->kind == ColorValue::Kind::rgb) {
      set_member(*shader, "index", "rgb", n->at);
      set_member(*shader, "rgb_n", three(*rgb_n), n->at);
      set_member(*shader, "rgb_k", three(*rgb_k), k->at);
    } else {
      const auto part = [&](const char* of, double otherwise) {
        const Color c = going_on_at_its_ends(spectrum_of(e, of, otherwise));
        return exterior == 1 ? c : scaled_spectrum(1 / exterior, c);
      };
      set_member(*shader, "ior", complex_index(part("eta", double(almost_no_index)), part("k", 1)), e.at);
    }
  } else if (lossless) {
    set_member(*shader, "ior", complex_index(flat_spectrum(almost_no_index), flat_spectrum(1)), e.at);  // reflects all light
  } else {
    set_member(*shader, "ior", named_metal(importing_, material, e.location_of("material")), e.location_of("material"));
  }
  set(*shader, "color", color(e, "specular_reflectance", 1, uv));
  if (rough)
    set_roughness(*shader, e, uv, 0.1);
  else
    set_member(*shader, "roughness", 0, e.at);
  return {shader, false};
}

Converter::Surface Converter::plastic(const Element& e, Uv uv, const std::string& name) {
  Ref<Component> shader = make("LossyPlastic", e, name);
  set(*shader, "color", color(e, "diffuse_reflectance", 0.5, uv));
  if (e.has("specular_reflectance")) set(*shader, "reflection_tint", color(e, "specular_reflectance", 1, uv));
  set_member(*shader, "ior", index(e, "int_ior", "polypropylene") / index(e, "ext_ior", "air"), e.at);
  set_member(*shader, "nonlinear", e.boolean("nonlinear", false), e.at);
  if (e.type == "pplastic") inexact(e, "'pplastic' is taken for 'roughplastic': light has no polarization here");
  if (e.type != "plastic") {
    const std::string distribution = e.string("distribution", "beckmann");
    if (distribution != "ggx" && distribution != "beckmann")
      importing_.inexact(fmt::format("the microfacet distribution '{}' is taken for 'beckmann'", distribution),
                         e.location_of("distribution"));
    set_member(*shader, "distribution", distribution == "ggx" ? "ggx" : "beckmann", e.at);
    const Value alpha = scalar(e, "alpha", 0.1, uv);
    if (alpha.as<Number>())
      set(*shader, "roughness", alpha);
    else
      importing_.inexact("the roughness of plastic is one number: 0.1 stands for the texture", e.location_of("alpha"));
  } else {
    set_member(*shader, "roughness", 0, e.at);
  }
  e.ignore({"sample_visible", "specular_sampling_weight"});
  return {shader, false};
}

}  // namespace etendue::mitsuba
