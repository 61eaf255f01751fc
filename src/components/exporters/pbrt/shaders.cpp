// Writes shaders as materials, and media.

#include "writer.h"

namespace etendue::pbrt_export {

Surface Writer::surface_of(const Component* shader) {
  Surface surface;
  // In pbrt opacity belongs to the shape.
  if (shader && shader->class_info().name == "MaskShader") {
    surface.alpha = number_map("alpha", *shader, "opacity");
    const Ref<Component> inner = part_of(*shader, "shader");
    surface.material = inner ? material_of(*inner) : "";
  } else if (shader) {
    surface.material = material_of(*shader);
  } else {
    static const char* black = "black_surface";
    if (materials_.emplace(nullptr, black).second)
      out_ += fmt::format("MakeNamedMaterial \"{}\" \"string type\" \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\n", black);
    surface.material = black;
  }
  return surface;
}

std::string Writer::material_of(const Component& shader) {
  if (const auto found = materials_.find(&shader); found != materials_.end()) return found->second;
  // Bump and normal maps are parameters of the material that they modify.
  const Component* base = &shader;
  std::string relief;
  Ref<Component> held;
  for (std::string name = base->class_info().name; name == "BumpShader" || name == "NormalMapShader";
       name = base->class_info().name) {
    if (name == "BumpShader") {
      relief += number_map("displacement", *base, "height");
      if (number_of(*base, "scale") != 1) exporting.inexact("the factor of a bump map's heights is left out", base);
    } else {
      relief += fmt::format(" \"string normalmap\" \"{}\"", exporting.copy_beside(word_of(*base, "file")));
    }
    held = part_of(*base, "shader");
    if (!held) break;
    base = held.get();
  }
  std::string type;
  const std::string parameters = parameters_of(*base, type);
  const std::string name = exporting.name_for(shader);
  out_ += fmt::format("MakeNamedMaterial \"{}\" \"string type\" \"{}\"{}{}\n", name, type, parameters, relief);
  materials_[&shader] = name;
  return name;
}

std::string Writer::roughness_of(const Component& shader, const std::string& prefix) {
  std::string text;
  if (part_of(shader, "roughness_v"))
    text = number_map((prefix + "uroughness").c_str(), shader, "roughness") +
           number_map((prefix + "vroughness").c_str(), shader, "roughness_v");
  else
    text = number_map((prefix + "roughness").c_str(), shader, "roughness");
  if (const Ref<Component> rotation = part_of(shader, "rotation"))
    if (const Color c = constant_of(*rotation); !c || c->at(550, ColorUse::coefficient) != 0)
      exporting.inexact("the rotation of an anisotropic surface is left out", &shader);
  if (shader.class_info().find("distribution") && word_of(shader, "distribution") == "beckmann")
    exporting.inexact("pbrt has GGX's facets alone: they stand for Beckmann's", &shader);
  const Ref<Component> alpha = part_of(shader, "roughness");
  const Color c = alpha ? constant_of(*alpha) : nullptr;
  const bool rough = !c || c->at(550, ColorUse::coefficient) > 0.001f, multiple = truth_of(shader, "multiple_scattering");
  const std::string heights = shader.class_info().find("heights") ? word_of(shader, "heights") : "correlated";
  if (rough && multiple)
    exporting.inexact("pbrt loses the light that meets more than one facet: rough surfaces are a little darker there", &shader);
  else if (rough && (heights == "independent" || (heights == "by_side" && shader.class_info().name == "Dielectric")))
    exporting.inexact("the heights of facets are correlated in pbrt: rough surfaces are a little brighter at a slant", &shader);
  return text;
}

std::string Writer::index_of(const Component& shader, const std::string& name) {
  Color c = color_of(shader, "ior");
  if (!c) return fmt::format(" \"float {}\" {}", name, number_of(shader, "ior"));
  // pbrt's eta is the relative index of the two sides.
  const Color outside = shader.class_info().find("exterior") ? color_of(shader, "exterior") : nullptr;
  if (outside && outside->varies()) {
    std::vector<float> wavelengths, quotients;
    for (int nm = 360; nm <= 830; nm += 5) {
      wavelengths.push_back(float(nm));
      quotients.push_back(c->at(float(nm), ColorUse::coefficient) / outside->at(float(nm), ColorUse::coefficient));
    }
    c = table_spectrum(wavelengths, quotients);
  } else if (outside) {
    c = scaled_spectrum(1 / double(outside->at(550, ColorUse::coefficient)), c);
  }
  if (!c->varies()) return fmt::format(" \"float {}\" {}", name, c->at(550, ColorUse::coefficient));
  return spectrum(name.c_str(), c, ColorUse::coefficient);
}

std::string Writer::metal_of(const Component& shader, const std::string& prefix) {
  const Color ior = color_of(shader, "ior");
  for (const char* metal : {"Cu", "Au", "Ag", "Al", "CuZn", "MgO", "TiO2"})
    if (ior && ior->expression() == fmt::format("metal(\"{}\")", metal))
      return fmt::format(" \"spectrum {0}eta\" \"metal-{1}-eta\" \"spectrum {0}k\" \"metal-{1}-k\"", prefix, metal);
  const Color k = ior ? ior->imaginary() : nullptr;
  std::string text = ior ? spectrum((prefix + "eta").c_str(), ior, ColorUse::coefficient) : "";
  text +=
      k ? spectrum((prefix + "k").c_str(), k, ColorUse::coefficient) : fmt::format(" \"spectrum {}k\" [ 360 0 830 0 ]", prefix);
  if (const Ref<Component> tint = part_of(shader, "color"))
    if (const Color c = constant_of(*tint); !c || c->varies() || c->at(550, ColorUse::reflectance) != 1)
      exporting.inexact("the colour that a metal's reflectance is multiplied by is left out", &shader);
  return text;
}

std::string Writer::layered(const Component& shader, std::string& type) {
  const Ref<Component> top = part_of(shader, "top"), bottom = part_of(shader, "bottom"), medium = part_of(shader, "medium");
  const std::string below = bottom ? bottom->class_info().name : "";
  if (!top || top->class_info().name != "Dielectric" || (below != "Lambertian" && below != "Conductor")) {
    exporting.inexact("pbrt has layers of a dielectric over a matt surface or a metal alone: the lower one is left", &shader);
    return bottom ? parameters_of(*bottom, type) : "";
  }
  const bool diffuse = below == "Lambertian";
  type = diffuse ? "coateddiffuse" : "coatedconductor";
  const std::string prefix = diffuse ? "" : "interface.";
  std::string text = roughness_of(*top, prefix) + index_of(*top, prefix + "eta");
  text += diffuse ? color_map("reflectance", *bottom, "color")
                  : roughness_of(*bottom, "conductor.") + metal_of(*bottom, "conductor.");
  text += " \"bool remaproughness\" false";
  // pbrt's layer always has the extinction 1; a thickness of 0 makes it clear.
  const Ref<Component> thickness = part_of(shader, "thickness");
  const Color t = thickness ? constant_of(*thickness) : nullptr;
  if (!medium) return text + " \"float thickness\" 0";
  const Color a = medium->class_info().name == "HomogeneousVolume" ? color_of(*medium, "absorption") : nullptr,
              s = a ? color_of(*medium, "scattering") : nullptr;
  if (!a || !s || !t || a->varies() || s->varies()) {
    exporting.inexact("the medium between two layers is left out", &shader);
    return text + " \"float thickness\" 0";
  }
  const float absorbs = a->at(550, ColorUse::coefficient), scatters = s->at(550, ColorUse::coefficient);
  return text + fmt::format(" \"float thickness\" {}{}", t->at(550, ColorUse::coefficient) * (absorbs + scatters),
                            scatters > 0 ? fmt::format(" \"spectrum albedo\" [ 360 {0} 830 {0} ] \"float g\" {1}",
                                                       scatters / (absorbs + scatters), mean_cosine(*medium))
                                         : "");
}

std::string Writer::parameters_of(const Component& shader, std::string& type) {
  const std::string name = shader.class_info().name;
  const auto nearly = [&](const char* what) { exporting.inexact(fmt::format("{} stands for a {}", what, name), &shader); };
  if (name == "Lambertian" || name == "OrenNayar") {
    type = "diffuse";
    if (name == "OrenNayar") nearly("a Lambertian surface");
    return color_map("reflectance", shader, "color");
  }
  if (name == "Conductor") {
    type = "conductor";
    return metal_of(shader, "") + roughness_of(shader, "") + " \"bool remaproughness\" false";
  }
  if (name == "PerfectSpecular") {
    type = "conductor";
    exporting.inexact("a mirror reflects more at grazing angles in pbrt", &shader);
    return color_map("reflectance", shader, "color");
  }
  if (name == "Dielectric") {
    type = "dielectric";
    if (part_of(shader, "reflection_tint") || part_of(shader, "transmission_tint"))
      for (const char* tint : {"reflection_tint", "transmission_tint"})
        if (const Ref<Component> map = part_of(shader, tint))
          if (const Color c = constant_of(*map); !c || c->varies() || c->at(550, ColorUse::reflectance) != 1)
            exporting.inexact(fmt::format("the '{}' of a dielectric is left out", tint), &shader);
    return index_of(shader, "eta") + roughness_of(shader, "") + " \"bool remaproughness\" false";
  }
  if (name == "ThinDielectric") {
    type = "thindielectric";
    if (word_of(shader, "polarizations") == "apart")
      exporting.inexact("thin panes reflect a little less at a slant in pbrt, where polarizations are averaged", &shader);
    return index_of(shader, "eta");
  }
  if (name == "DiffuseTransmitter") {
    type = "diffusetransmission";
    return color_map("reflectance", shader, "reflectance") + color_map("transmittance", shader, "transmittance");
  }
  if (name == "LayeredShader") return layered(shader, type);
  if (name == "Plastic" || name == "LossyPlastic") {
    type = "coateddiffuse";
    nearly("a layer of random walks");
    return color_map("reflectance", shader, "color") + number_map("roughness", shader, "roughness") + index_of(shader, "eta") +
           " \"bool remaproughness\" false \"float thickness\" 0";
  }
  if (name == "PassThrough") {
    type = "interface";
    return {};
  }
  if (name == "MixShader") {
    type = "mix";
    const Ref<Component> first = part_of(shader, "first"), second = part_of(shader, "second");
    const std::string a = surface_of(first.get()).material, b = surface_of(second.get()).material;
    return fmt::format(" \"string materials\" [ \"{}\" \"{}\" ]{}", a, b, number_map("amount", shader, "amount"));
  }
  if (name == "HairShader") {
    type = "hair";
    const std::string pigment = word_of(shader, "pigment");
    const std::string what = pigment == "color"        ? color_map("reflectance", shader, "color")
                             : pigment == "absorption" ? color_map("sigma_a", shader, "absorption", ColorUse::coefficient)
                                                       : number_map("eumelanin", shader, "eumelanin") +
                                                             number_map("pheomelanin", shader, "pheomelanin");
    return what + number_map("beta_m", shader, "longitudinal_roughness") + number_map("beta_n", shader, "azimuthal_roughness") +
           fmt::format(" \"float alpha\" {} \"float eta\" {}", number_of(shader, "tilt"), number_of(shader, "ior"));
  }
  if (name == "RglShader") {
    type = "measured";
    return fmt::format(" \"string filename\" \"{}\"", exporting.copy_beside(word_of(shader, "file")));
  }
  type = "diffuse";
  for (const char* member : {"color", "base_color"})
    if (shader.class_info().find(member)) {
      nearly("a matt surface of its colour");
      return color_map("reflectance", shader, member);
    }
  nearly("a matt grey surface");
  return {};
}

std::string Writer::medium_of(const Component& medium) {
  if (const auto found = media_.find(&medium); found != media_.end()) return found->second;
  std::string& name = media_[&medium];
  if (medium.class_info().name != "HomogeneousVolume") {
    exporting.inexact(fmt::format("a {} is left out", medium.class_info().name), &medium);
    return name;
  }
  name = exporting.name_for(medium);
  Color a = color_of(medium, "absorption"), s = color_of(medium, "scattering");
  const Color extinction = medium.class_info().find("extinction") ? color_of(medium, "extinction") : nullptr;
  if (extinction && extinction->expression() != "0")
    exporting.inexact("a medium's extinction and albedo are written as its absorption and scattering", &medium);
  if (!turns_by_anisotropy_alone(medium))
    exporting.inexact("pbrt's media scatter by one lobe: it has the same mean cosine", &medium);
  out_ += fmt::format("MakeNamedMedium \"{}\" \"string type\" \"homogeneous\"{}{} \"float g\" {}\n", name,
                      spectrum("sigma_a", a, ColorUse::coefficient), spectrum("sigma_s", s, ColorUse::coefficient),
                      mean_cosine(medium));
  return name;
}

}  // namespace etendue::pbrt_export
