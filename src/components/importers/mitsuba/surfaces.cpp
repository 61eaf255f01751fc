// Chooses the shader for each bsdf of Mitsuba, and converts bsdfs that contain others.

#include <fmt/format.h>

#include <algorithm>

#include "converter.h"

namespace etendue::mitsuba {

namespace {

const std::vector<std::string> known_bsdfs = {"diffuse",
                                              "roughdiffuse",
                                              "dielectric",
                                              "thindielectric",
                                              "roughdielectric",
                                              "conductor",
                                              "roughconductor",
                                              "plastic",
                                              "roughplastic",
                                              "coating",
                                              "roughcoating",
                                              "mask",
                                              "twosided",
                                              "blendbsdf",
                                              "mixturebsdf",
                                              "bumpmap",
                                              "normalmap",
                                              "phong",
                                              "ward",
                                              "difftrans",
                                              "principled",
                                              "principledthin",
                                              "null",
                                              "hair",
                                              "measured",
                                              "hk",
                                              "irawan",
                                              "pplastic",
                                              "polarizer",
                                              "retarder",
                                              "circular",
                                              "measured_polarized"};

}  // namespace

Converter::Surface Converter::surface(const Element& e, Uv uv) {
  if (!textured(e)) uv = Uv::as_is;
  if (const auto known = surfaces_.find({&e, uv}); known != surfaces_.end()) return known->second;
  const Reading reading(e);
  const Surface made = make_surface(e, uv, e.id);
  surfaces_[{&e, uv}] = made;
  return made;
}

Converter::Surface Converter::make_surface(const Element& e, Uv uv, const std::string& name) {
  const std::string& type = e.type;
  if (type == "diffuse" || type == "roughdiffuse" || type == "difftrans") return matte(e, uv, name);
  if (type == "dielectric" || type == "roughdielectric" || type == "thindielectric") return dielectric(e, uv, name);
  if (type == "conductor" || type == "roughconductor") return conductor(e, uv, name);
  if (type == "plastic" || type == "roughplastic" || type == "pplastic") return plastic(e, uv, name);
  if (type == "coating" || type == "roughcoating") return coating(e, uv, name);
  if (type == "blendbsdf" || type == "mixturebsdf") return mixture(e, uv, name);
  if (type == "mask") return mask(e, uv, name);
  if (type == "bumpmap" || type == "normalmap") return tilted(e, uv, name);
  if (type == "phong" || type == "ward") return classic(e, uv, name);
  if (type == "principled" || type == "principledthin") return principled(e, uv, name);
  if (type == "hair") return fibre(e, name);
  if (type == "polarizer" || type == "circular" || type == "retarder") return filter_of_polarization(e, uv, name);
  if (type == "null") return {make("PassThrough", e, name), true};
  if (type == "measured") {
    Ref<Component> shader = make("RglShader", e, name);
    set_member(*shader, "file", file(e), e.location_of("filename"));
    set_member(*shader, "symmetric", false, e.at);
    return {shader, false};
  }
  if (type == "twosided") {
    const std::vector<const Element*> inner = e.all("bsdf");
    if (inner.empty()) throw Error("'twosided' needs a bsdf", e.at);
    if (inner.size() > 1) {
      Ref<Component> shader = make("TwoSidedShader", e, name);
      set_member(*shader, "front", surface(*inner[0], uv).shader, inner[0]->at);
      set_member(*shader, "back", surface(*inner[1], uv).shader, inner[1]->at);
      if (inner.size() > 2) inexact(*inner[2], "a surface has two sides: the third bsdf of 'twosided' is left out");
      return {shader, true};
    }
    if (!inner.front()->id.empty() || name.empty()) return {surface(*inner.front(), uv).shader, true};
    const Reading reading(*inner.front());
    return {make_surface(*inner.front(), uv, name).shader, true};
  }
  Ref<Component> shader = make("Lambertian", e, name);
  bool colored = false;
  for (const char* own : {"reflectance", "diffuse_reflectance", "base_color", "color"})
    if (!colored && e.has(own)) {
      set(*shader, "color", color(e, own, 0.5, uv));
      colored = true;
    }
  stand_in(e, known_bsdfs, fmt::format("a matt {} stands for it", colored ? "surface of its colour" : "grey"));
  return {shader, false};
}

// A linear polarizer and a retarder are plates here too. Others transmit half of unpolarized light, or all of it, without a
// change of direction, as in Mitsuba's unpolarized variants.
Converter::Surface Converter::filter_of_polarization(const Element& e, Uv uv, const std::string& name) {
  const Value angle = scalar(e, "theta", 0, uv);
  const auto* turned = angle.as<Number>();
  if (turned && e.type == "polarizer" && e.boolean("polarizing", true)) {
    Ref<Component> sheet = make("LinearPolarizer", e, name);
    set_member(*sheet, "angle", -turned->value, e.at);  // Mitsuba turns it clockwise, and a retarder the other way
    set(*sheet, "transmitted", scalar(e, "transmittance", 1, uv));
    return {sheet, true};
  }
  if (turned && e.type == "retarder" && !e.has("transmittance")) {
    const Value delta = scalar(e, "delta", 90, uv);
    if (const auto* degrees = delta.as<Number>()) {
      Ref<Component> plate = make("Retarder", e, name);
      set_member(*plate, "angle", turned->value, e.at);
      set_member(*plate, "retardance", degrees->value / 360, e.at);
      return {plate, true};
    }
  }
  inexact(e, fmt::format("'{}' lets through what it lets through of light without polarization", e.type));
  e.ignore({"theta", "delta", "left_handed", "polarizing"});
  const double share = e.type == "retarder" ? 1 : 0.5;
  const Value through = scalar(e, "transmittance", 1, uv);
  const auto* number = through.as<Number>();
  if (!number) importing_.inexact("the transmittance is one number: 1 stands for the texture", e.location_of("transmittance"));
  const double open = share * (number ? number->value : 1);
  if (open >= 1) return {make("PassThrough", e, name), true};
  Ref<Component> black = make("Lambertian", e, ""), shader = make("MaskShader", e, name);
  set_member(*black, "color", 0.0, e.at);
  set_member(*shader, "shader", black, e.at);
  set_member(*shader, "opacity", 1 - open, e.at);
  return {shader, true};
}

Converter::Surface Converter::inner_surface(const Element& e, Uv uv, size_t number) {
  const std::vector<const Element*> inner = e.all("bsdf");
  if (inner.size() <= number)
    throw Error(fmt::format("'{}' needs {} bsdf{} inside", e.type, number + 1, number > 0 ? "s" : ""), e.at);
  return surface(*inner[number], uv);
}

Converter::Surface Converter::mask(const Element& e, Uv uv, const std::string& name) {
  const Surface inner = inner_surface(e, uv);
  Ref<Component> shader = make("MaskShader", e, name);
  set_member(*shader, "shader", inner.shader, e.at);
  set(*shader, "opacity", scalar(e, "opacity", 0.5, uv));
  return {shader, inner.both_sides};
}

Converter::Surface Converter::mixture(const Element& e, Uv uv, const std::string& name) {
  const size_t count = e.all("bsdf").size();
  if (count == 0) throw Error(fmt::format("'{}' needs bsdfs inside", e.type), e.at);
  std::vector<Surface> parts;
  bool differ = false, any = false;
  for (size_t i = 0; i < count; ++i) {
    parts.push_back(inner_surface(e, uv, i));
    differ = differ || parts[i].both_sides != parts[0].both_sides;
    any = any || parts[i].both_sides;
  }
  if (differ) inexact(e, "what is black from behind in one part of a mixture is seen from both sides here");
  const auto mixed = [&](const Ref<Component>& first, const Ref<Component>& second, Value amount, const std::string& called) {
    Ref<Component> mix = make("MixShader", e, called);
    Ref<Component> black;
    if (!first) set_member(*(black = make("Lambertian", e, "")), "color", 0.0, e.at);
    set_member(*mix, "first", first ? first : black, e.at);
    set_member(*mix, "second", second, e.at);
    set(*mix, "amount", amount);
    return mix;
  };
  if (e.type == "blendbsdf") {
    if (count != 2) throw Error(fmt::format("'blendbsdf' needs two bsdfs inside, not {}", count), e.at);
    return {mixed(parts[0].shader, parts[1].shader, scalar(e, "weight", 0.5, uv), name), any};
  }
  constexpr size_t most = 100;  // each part is nested in a mixture with those before it
  if (count > most) throw Error(fmt::format("a mixture of {} bsdfs: {} are the most", count, most), e.at);
  // The weight of each part is its fraction of the mixture so far; the difference of the sum to 1 is black.
  const std::string text = e.string("weights", "");
  std::vector<double> weights = parse_numbers({text, e.location_of("weights")});
  if (weights.size() != count)
    throw Error(fmt::format("{} weights for {} bsdfs", weights.size(), count), e.location_of("weights"));
  double sum = 0;
  for (const double w : weights) {
    if (!(w >= 0)) throw Error("weights must not be negative", e.location_of("weights"));
    sum += w;
  }
  if (!(sum > 0)) throw Error("the weights are all 0", e.location_of("weights"));
  if (sum > 1) {
    importing_.inexact("the weights are more than 1 together: they are scaled down to 1", e.location_of("weights"));
    for (double& w : weights) w /= sum;
  }
  Ref<Component> so_far;
  double share = std::max(1 - sum, 0.0);  // starts with the weight of black
  for (size_t i = 0; i < count; ++i) {
    share += weights[i];
    if (weights[i] == 0) continue;
    so_far = weights[i] == share
                 ? parts[i].shader
                 : mixed(so_far, parts[i].shader, Value(Number{weights[i] / share}, e.at), i + 1 == count ? name : "");
  }
  return {so_far, any};
}

Converter::Surface Converter::coating(const Element& e, Uv uv, const std::string& name) {
  const Surface inner = inner_surface(e, uv);
  Ref<Component> top = make("Dielectric", e, "");
  set_member(*top, "ior", index(e, "int_ior", "bk7") / index(e, "ext_ior", "air"), e.at);
  if (e.type == "roughcoating") set_roughness(*top, e, uv, 0.1);
  if (e.has("specular_reflectance")) set(*top, "reflection_tint", color(e, "specular_reflectance", 1, uv));
  Ref<Component> layered = make("LayeredShader", e, name);
  set_member(*layered, "top", top, e.at);
  set_member(*layered, "bottom", inner.shader, e.at);
  if (e.has("sigma_a")) {
    Ref<Component> medium = make("HomogeneousVolume", e, "");
    set_member(*medium, "absorption", spectrum_of(e, "sigma_a", 0), e.location_of("sigma_a"));
    set_member(*layered, "medium", medium, e.at);
    set_member(*layered, "thickness", e.number("thickness", 1), e.location_of("thickness"));
  } else {
    e.ignore({"thickness"});
  }
  inexact(e, fmt::format("'{}' here has the light too that goes back and forth between coat and body more than once", e.type));
  e.ignore({"specular_sampling_weight"});
  return {layered, inner.both_sides};
}

Converter::Surface Converter::tilted(const Element& e, Uv uv, const std::string& name) {
  const Surface inner = inner_surface(e, uv);
  const std::vector<const Element*> maps = e.all("texture");  // any name, before the bsdf or after it
  if (maps.empty()) throw Error(fmt::format("'{}' needs a texture", e.type), e.at);
  if (maps.size() > 1) inexact(*maps[1], fmt::format("'{}' has one texture: the first counts", e.type));
  const Element* const map = maps.front();
  Ref<Component> shader;
  if (e.type == "bumpmap") {
    shader = make("BumpShader", e, name);
    set(*shader, "height", texture(*map, uv, Read::luminance));
    set_member(*shader, "scale", e.number("scale", 1), e.location_of("scale"));
  } else {
    if (map->type == "rawconstant") {
      const Reading reading(*map);
      const DoubleVector3 n = map->vector("value", {0.5, 0.5, 1});
      if (n.x != 0.5 || n.y != 0.5) inexact(*map, "a normal map of one normal is left out");
      return inner;  // the unperturbed normal changes nothing
    }
    shader = make("NormalMapShader", e, name);
    set(*shader, "map", texture(*map, uv));
    set_member(*shader, "green", "across", e.at);
  }
  set_member(*shader, "shader", inner.shader, e.at);
  // Mitsuba's defaults since 3.7.1.
  if (!e.old && e.boolean("use_shadowing_function", true)) set_member(*shader, "shadowing", true, e.at);
  if (!e.old && e.boolean("flip_invalid_normals", true)) set_member(*shader, "opposite_slopes", true, e.at);
  return {shader, inner.both_sides};
}

}  // namespace etendue::mitsuba
