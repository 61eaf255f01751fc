// Writes surfaces as bsdfs.

#include "etendue/describe/registry.h"
#include "writer.h"

namespace etendue::mitsuba_export {

namespace {

/// Whether Mitsuba's bsdf for this shader handles both sides by itself.
bool through(const Component& shader) {
  const std::string& type = class_of(shader);
  if (type == "MaskShader" || type == "BumpShader" || type == "NormalMapShader") {
    const Ref<Component> inner = part_of(shader, "shader");
    return inner && through(*inner);
  }
  if (type == "MixShader") {
    for (const char* member : {"first", "second"})
      if (const Ref<Component> inner = part_of(shader, member); inner && through(*inner)) return true;
    return false;
  }
  return type == "Dielectric" || type == "ThinDielectric" || type == "PassThrough" || type == "DiffuseTransmitter" ||
         type == "DisneyThin" || type == "HairShader";
}

Node plugin(Node parent, const char* type) {
  Node n = parent.append_child("bsdf");
  n.append_attribute("type") = type;
  return n;
}

}  // namespace

void Writer::surface(Node shape, const Component* shader, bool both_sides, Uv uv) {
  if (!shader) {
    spectrum(plugin(shape, "diffuse"), "reflectance", flat_spectrum(0), ColorUse::reflectance);
    return;
  }
  const bool two_sided = both_sides && !through(*shader);
  const bool named = shader->origin && !shader->origin->name.empty();
  std::string& id = bsdfs_[{shader, two_sided, uv}];
  if (named && !id.empty()) {
    shape.append_child("ref").append_attribute("id") = id.c_str();
    return;
  }
  const Node parent = named ? scene_ : shape;
  bsdf(parent, *shader, two_sided, uv);
  if (!named) return;
  id = exporting.name_for(*shader) + (two_sided ? "_twosided" : "") + (uv == Uv::from_top ? "_turned" : "");
  parent.last_child().append_attribute("id") = id.c_str();
  shape.append_child("ref").append_attribute("id") = id.c_str();
}

void Writer::roughness(Node n, const Component& s, Uv uv) {
  text(n, "distribution", word_of(s, "distribution"));
  if (part_of(s, "roughness_v")) {
    scalar_map(n, "alpha_u", s, "roughness", uv);
    scalar_map(n, "alpha_v", s, "roughness_v", uv);
  } else {
    scalar_map(n, "alpha", s, "roughness", uv);
  }
  const bool independent = word_of(s, "heights") == "independent";
  if (truth_of(s, "multiple_scattering"))
    exporting.inexact("light that meets more than one facet of a rough surface is lost in Mitsuba", &s);
  else if (!independent)
    exporting.inexact("rough surfaces are a little darker at a slant in Mitsuba, where heights of facets are independent", &s);
}

void Writer::dielectric(Node parent, const Component& s, Uv uv) {
  const bool rough = scalar(s, "roughness") >= 0.001;
  Node n = plugin(parent, rough ? "roughdielectric" : "dielectric");
  const Color inside = color_of(s, "ior"), outside = color_of(s, "exterior");
  if (inside->varies()) exporting.inexact("glass does not disperse in Mitsuba: it has its index at 587.6 nm", &s);
  number(n, "int_ior", double(inside->at(587.6f, ColorUse::coefficient)));
  number(n, "ext_ior", outside ? double(outside->at(587.6f, ColorUse::coefficient)) : 1.0);
  if (rough) roughness(n, s, uv);
  map(n, "specular_reflectance", s, "reflection_tint", ColorUse::reflectance, uv);
  map(n, "specular_transmittance", s, "transmission_tint", ColorUse::reflectance, uv);
}

void Writer::conductor(Node parent, const Component& s, Uv uv) {
  const bool rough = scalar(s, "roughness") >= 0.001;
  Node n = plugin(parent, rough ? "roughconductor" : "conductor");
  if (word_of(s, "index") == "rgb") {
    const std::vector<double> eta = numbers_of(s, "rgb_n"), k = numbers_of(s, "rgb_k");
    value(n, "rgb", "eta", fmt::format("{} {} {}", eta[0], eta[1], eta[2]));
    value(n, "rgb", "k", fmt::format("{} {} {}", k[0], k[1], k[2]));
    exporting.inexact("n and k as red, green and blue are spectra in Mitsuba's spectral variants", &s);
  } else {
    const Color ior = color_of(s, "ior");
    spectrum(n, "eta", ior, ColorUse::coefficient);
    spectrum(n, "k", ior->imaginary() ? Color(ior->imaginary()) : flat_spectrum(0), ColorUse::coefficient);
  }
  if (rough) roughness(n, s, uv);
  map(n, "specular_reflectance", s, "color", ColorUse::reflectance, uv);
}

Node Writer::tilted(Node parent, const Component& s, Uv uv) {
  const bool bumps = class_of(s) == "BumpShader";
  if (bumps && class_of(*part_of(s, "height")) == "ConstantMap") return parent;  // a constant height: the surface stays flat
  Node n = plugin(parent, bumps ? "bumpmap" : "normalmap");
  truth(n, "use_shadowing_function", truth_of(s, "shadowing"));
  truth(n, "flip_invalid_normals", truth_of(s, "opposite_slopes"));
  if (bumps) {
    scalar_map(n, "arbitrary", s, "height", uv);
    number(n, "scale", number_of(s, "scale"));
    return n;
  }
  Ref<Component> image = part_of(s, "map");
  if (!word_of(s, "file").empty()) {
    image = made_.emplace_back(Registry::instance().create("ImageMap"));
    for (const char* member : {"file", "transfer", "repeat"}) set(*image, member, value_of(s, member));
  }
  if (word_of(s, "green") == "v")
    exporting.inexact("green of normals tilts to the left of u in Mitsuba, where v may run the other way", &s);
  normals(n, "normalmap", *image, uv);
  return n;
}

void Writer::bsdf(Node parent, const Component& s, bool both_sides, Uv uv) {
  const std::string& type = class_of(s);
  const bool holds_others = type == "MaskShader" || type == "MixShader";
  if (both_sides && !holds_others && !through(s)) parent = plugin(parent, "twosided");
  const auto inner = [&](Node n, const char* member) {
    if (const Ref<Component> part = part_of(s, member))
      bsdf(n, *part, both_sides && holds_others, uv);
    else
      spectrum(plugin(n, "diffuse"), "reflectance", flat_spectrum(0), ColorUse::reflectance);
  };
  if (type == "Lambertian") {
    map(plugin(parent, "diffuse"), "reflectance", s, "color", ColorUse::reflectance, uv);
  } else if (type == "Dielectric") {
    dielectric(parent, s, uv);
  } else if (type == "ThinDielectric") {
    Node n = plugin(parent, "thindielectric");
    if (word_of(s, "polarizations") == "apart")
      exporting.inexact("thin panes reflect a little less at a slant in Mitsuba, where polarizations are averaged", &s);
    number(n, "int_ior", double(color_of(s, "ior")->at(587.6f, ColorUse::coefficient)));
    number(n, "ext_ior", 1);
    map(n, "specular_reflectance", s, "reflection_tint", ColorUse::reflectance, uv);
    map(n, "specular_transmittance", s, "transmission_tint", ColorUse::reflectance, uv);
  } else if (type == "Conductor") {
    conductor(parent, s, uv);
  } else if (type == "PerfectSpecular") {
    map(plugin(parent, "conductor"), "specular_reflectance", s, "color", ColorUse::reflectance, uv);
  } else if (type == "LossyPlastic" || type == "Plastic") {
    const bool rough = scalar(s, "roughness") >= 0.001;
    Node n = plugin(parent, rough ? "roughplastic" : "plastic");
    map(n, "diffuse_reflectance", s, "color", ColorUse::reflectance, uv);
    number(n, "int_ior", number_of(s, "ior"));
    number(n, "ext_ior", 1);
    truth(n, "nonlinear", truth_of(s, "nonlinear"));
    if (type == "LossyPlastic") map(n, "specular_reflectance", s, "reflection_tint", ColorUse::reflectance, uv);
    if (rough) {
      text(n, "distribution", word_of(s, "distribution"));
      number(n, "alpha", scalar(s, "roughness"));
    }
    if (type == "Plastic" && rough) exporting.inexact("Mitsuba's rough plastic loses light between its layers", &s);
  } else if (type == "PassThrough") {
    plugin(parent, "null");
  } else if (type == "MaskShader") {
    Node n = plugin(parent, "mask");
    scalar_map(n, "opacity", s, "opacity", uv);
    inner(n, "shader");
  } else if (type == "MixShader") {
    Node n = plugin(parent, "blendbsdf");
    scalar_map(n, "weight", s, "amount", uv);
    inner(n, "first");
    inner(n, "second");
  } else if (type == "TwoSidedShader") {  // `parent` is a "twosided" already, unless only the front is visible
    inner(parent, "front");
    if (both_sides) inner(parent, "back");
  } else if (type == "BumpShader" || type == "NormalMapShader") {
    inner(tilted(parent, s, uv), "shader");
  } else if (type == "DisneyPrincipled" || type == "DisneyThin") {
    const bool thin = type == "DisneyThin";
    Node n = plugin(parent, thin ? "principledthin" : "principled");
    map(n, "base_color", s, "base_color", ColorUse::reflectance, uv);
    for (const char* member : {"roughness", "anisotropic", "spec_trans", "spec_tint", "flatness", "sheen", "sheen_tint"})
      scalar_map(n, member, s, member, uv);
    if (thin) {
      scalar_map(n, "diff_trans", s, "diff_trans", uv);
    } else {
      for (const char* member : {"metallic", "clearcoat", "clearcoat_gloss"}) scalar_map(n, member, s, member, uv);
    }
    number(n, "eta", scalar(s, "ior"));
  } else {
    exporting.inexact(fmt::format("Mitsuba has no surface like {}: a matt grey stands for it", type), &s);
    spectrum(plugin(parent, "diffuse"), "reflectance", flat_spectrum(0.5f), ColorUse::reflectance);
  }
}

}  // namespace etendue::mitsuba_export
