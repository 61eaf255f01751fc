// Emission of surfaces, and their opacity.

#include <algorithm>
#include <cmath>

#include "etendue/describe/registry.h"
#include "etendue/emission_shader.h"
#include "etendue/language/language.h"
#include "writer.h"

namespace etendue::gltf_export {

namespace {

/// The opacity map of a surface; null: opaque.
Ref<Component> opacity_of(const Component& shader) {
  const std::string& type = class_of(shader);
  if (type == "MaskShader") return part_of(shader, "opacity");
  if (type == "Principled") return part_of(shader, "geometry_opacity");
  const bool around = type == "NormalMapShader" || type == "BumpShader";
  const Ref<Component> inner = around ? part_of(shader, "shader") : nullptr;
  return inner ? opacity_of(*inner) : nullptr;
}

bool is_same(const Ref<Component>& a, const Ref<Component>& b) {
  return a == b || (a && b && write_description(*a) == write_description(*b));
}

/// If the map is a step from 0 to 1: the map that is compared, and the cutoff; null: the map is no step.
Ref<Component> before_step(const Component& map, double& cutoff) {
  if (class_of(map) != "RemapMap" || numbers_of(map, "to") != std::vector<double>{0, 1} || !truth_of(map, "clamped"))
    return nullptr;
  const std::vector<double> from = numbers_of(map, "from");
  if (!(from[1] > from[0] && from[1] - from[0] < 0.01)) return nullptr;
  cutoff = from[1];
  return part_of(map, "input");
}

}  // namespace

// In glTF the alpha of the base colour is the surface's coverage, or is compared with a cutoff.
void Writer::holes(Json& m, const Component& of, const char* member) {
  Json& factor = metal(m)["baseColorFactor"];
  if (factor.is_null()) factor = with_alpha({1, 1, 1});
  const Ref<Component> map = part_of(of, member);
  double cutoff = 0;
  const Ref<Component> below = map ? before_step(*map, cutoff) : nullptr;
  const Component* alpha = below ? below.get() : map.get();
  if (const auto amount = alpha ? amount_of(*alpha) : std::nullopt; amount && (amount->image || !amount->of_vertices.empty())) {
    const bool by_vertex = amount->of_vertices == "alpha";
    std::optional<Json> texture;
    if (amount->image && amount->channel == "A") texture = this->texture(*amount->image, false);
    const Json* base = metal(m).contains("baseColorTexture") ? &metal(m)["baseColorTexture"] : nullptr;
    if ((!amount->image || (texture && base && *base == *texture)) && (by_vertex || amount->of_vertices.empty())) {
      factor[3] = std::clamp(amount->factor, 0.0, 1.0);
      m["alphaMode"] = below ? "MASK" : "BLEND";
      if (below) m["alphaCutoff"] = cutoff;
      if (by_vertex) of_this_.alpha = true;
      return;
    }
  }
  const double left = scalar(of, member, 1);
  factor[3] = factor[3].get<double>() * std::clamp(left, 0.0, 1.0);
  m["alphaMode"] = "BLEND";
}

// The ratio of the emission's power to that of a constant radiance of 1, for each wavelength.
Color Writer::mean_radiance(const SceneObject& o, const Component& e) {
  try {
    const Ref<Component> given = copy(o), even = copy(o);
    const Ref<Component> one = Registry::instance().create("DiffuseEmission");
    set(*one, "radiance", Value(Number{1}));
    set(*even, "emission", Value(one));
    for (const Ref<Component>& object : {given, even}) {
      if (object->class_info().find("shader")) set(*object, "shader", Value(Ref<Component>()));
      prepare_tree(*object);
    }
    const auto power = [](const Component& object, const Wavelengths& w) {
      const Ref<Component> emission = part_of(object, "emission");
      return dynamic_cast<const EmissionShader&>(*emission).power(dynamic_cast<const SceneObject&>(object), w);
    };
    std::vector<float> wavelengths, values;
    for (float nm = 360; nm <= 830;) {
      Wavelengths w;
      for (int i = 0; i < spectrum_size; ++i) w.place(i, nm + 5 * float(i), 1);
      const Spectrum a = power(*given, w), b = power(*even, w);
      for (int i = 0; i < spectrum_size; ++i, nm += 5) {
        wavelengths.push_back(nm);
        values.push_back(b[i] > 0 ? a[i] / b[i] : 0);
      }
    }
    return table_spectrum(std::move(wavelengths), std::move(values));
  } catch (const Error& reason) {
    exporting.inexact(fmt::format("{} is left out: {}", class_of(e), reason.what()), &e);
  } catch (const Errors& reason) {
    exporting.inexact(fmt::format("{} is left out: {}", class_of(e), reason.what()), &e);
  }
  return nullptr;
}

void Writer::emission(Json& m, const SceneObject& o, const Component& e) {
  Look light;
  double strength = 1;
  if (class_of(e) == "DiffuseEmission") {
    const Ref<Component> shader = part_of(o, "shader"), map = part_of(e, "radiance");
    const Ref<Component> opacity = shader ? opacity_of(*shader) : nullptr;
    const Color same = opacity ? constant_of(*opacity) : nullptr;
    strength = strength_of(o, e);
    // In glTF the emission of a surface is multiplied by its opacity; here it is not.
    if (same) {
      const double part = double(same->at(at_d_line, ColorUse::coefficient));
      if (part > 0) strength /= part;
      light = look(e, "radiance", ColorUse::radiance);
    } else if (opacity && map && class_of(*map) == "RgbProductMap" && is_same(part_of(*map, "second"), opacity)) {
      light = look_of(*part_of(*map, "first"), ColorUse::radiance);
      const std::vector<double> factor = numbers_of(*map, "factor");
      for (size_t i = 0; i < 3; ++i) light.factor[i] *= factor[i];
    } else if (opacity && map && class_of(*map) == "RgbProductMap" && is_same(part_of(*map, "first"), opacity) &&
               constant_of(*part_of(*map, "second"))) {
      light = look_of(*part_of(*map, "second"), ColorUse::coefficient);
      const std::vector<double> factor = numbers_of(*map, "factor");
      for (size_t i = 0; i < 3; ++i) light.factor[i] *= factor[i];
    } else {
      light = look(e, "radiance", ColorUse::radiance);
      if (opacity) exporting.inexact("the light of a surface is less where it is transparent in glTF", &e);
    }
  } else {
    exporting.inexact(fmt::format("{} shines alike in all directions in glTF", class_of(e)), &e);
    const Color mean = mean_radiance(o, e);
    light.factor = mean ? rgb_of(mean, ColorUse::radiance) : std::array<double, 3>{0, 0, 0};
  }
  double most = 0;
  for (double& x : light.factor) most = std::max(most, x = std::max(0.0, x * strength));
  // Because of this extension the importer treats the surface as a lamp and not as a bright screen, however weak it is.
  if (most > 0) {
    for (double& x : light.factor) x /= most;
    extend(m, "KHR_materials_emissive_strength", {{"emissiveStrength", most}});
  }
  m["emissiveFactor"] = light.factor;
  if (light.texture) m["emissiveTexture"] = *light.texture;
}

}  // namespace etendue::gltf_export
