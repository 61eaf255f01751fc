// Converts emitters, and colours of light.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "converter.h"
#include "etendue/describe/color.h"
#include "etendue/film/image_tools.h"
#include "formats/permissions.h"

namespace etendue::mitsuba {

namespace {

const std::vector<std::string> known_emitters = {"area",     "point",      "spot",        "directional", "directionalarea",
                                                 "constant", "envmap",     "projector",   "sky",         "sun",
                                                 "sunsky",   "collimated", "volumelight", "timed_sunsky"};

constexpr double degrees_a_radian = 180 / std::numbers::pi;

Numbers three(const DoubleVector3& v) { return {{v.x, v.y, v.z}, 1, Dimension::none}; }

}  // namespace

Color Converter::scaled_light(const ColorValue& c, bool old) const {
  // Mitsuba before 2 renders in RGB, as its RGB variants do since: a light of equal components is white, which is D65.
  if ((old || imports_for_rgb()) && c.kind == ColorValue::Kind::flat) return rgb_color("srgb", c.rgb[0], c.rgb[0], c.rgb[0]);
  return c.color;
}

Value Converter::light(const Element& e, const std::string& name, Uv uv) {
  const Property* p = e.find(name);
  if (!p) return Value(illuminant_spectrum("D65"), e.at);
  if (const auto* c = std::get_if<ColorValue>(&p->value)) return Value(scaled_light(*c, e.old), p->at);
  if (std::holds_alternative<Nested>(p->value)) return light_of(*e.nested(name), uv);
  const double value = e.number(name, 1);
  return Value(rgb_color("srgb", value, value, value), p->at);
}

Value Converter::light_of(const Element& e, Uv uv) {
  Value v = texture(e, uv);
  if (const auto* n = v.as<Number>(); n && (e.old || imports_for_rgb()))
    return Value(rgb_color("srgb", n->value, n->value, n->value), e.at);
  const auto* map = v.as<Ref<Component>>();
  if (!map || e.old) return v;
  // Mitsuba does not multiply an image used as light by the white point of its colour space.
  Ref<Component> read = make("ReadAsMap", e, "");
  set_member(*read, "map", *map, e.at);
  set_member(*read, "as", "coefficient", e.at);
  return Value(read, e.at);
}

Ref<Component> Converter::area_emission(const Element& e, Uv uv) {
  if (e.type != "area" && e.type != "directionalarea" && e.type != "collimated") {
    importing_.inexact(fmt::format("emitter '{}' on a shape is taken for 'area'", e.type), e.at);
  }
  const Reading reading(e);
  const char* const name = !e.has("radiance") && e.has("intensity") ? "intensity" : "radiance";  // "intensity" in 0.3
  Ref<Component> emission = make(e.type == "directionalarea" ? "CollimatedEmission" : "DiffuseEmission", e);
  if (e.type == "directionalarea") inexact(e, "light along the normal alone spreads by 0.1 degrees here");
  set(*emission, "radiance", light(e, name, uv));
  e.ignore({"sampling_weight"});
  return emission;
}

Ref<Component> Converter::diffuse_emission(const Element& e, const char* light_name) {
  Ref<Component> emission = make("DiffuseEmission", e, "");
  set(*emission, "radiance", light(e, light_name, Uv::as_is));
  return emission;
}

Ref<SceneObject> Converter::emitter(const Element& e) {
  if (std::ranges::find(known_emitters, e.type) == known_emitters.end()) fail_unknown(e, known_emitters);
  const Reading reading(e);
  e.ignore({"sampling_weight"});
  Ref<Component> object;
  if (e.type == "point") {
    object = make("Point", e);
    set_member(*object, "emission", diffuse_emission(e, "intensity"), e.at);
    if (e.has("position"))
      set_member(*object, "position", three(e.vector("position", {})), e.location_of("position"));
    else
      set_transform(*object, e.transform(), e.location_of("to_world"));
  } else if (e.type == "spot") {
    object = spot(e);
  } else if (e.type == "projector") {
    object = projector(e);
  } else if (e.type == "directional") {
    object = directional(e);
  } else if (e.type == "constant") {
    object = make("Environment", e);
    const bool other = !e.has("radiance") && e.has("intensity");
    set_member(*object, "emission", diffuse_emission(e, other ? "intensity" : "radiance"), e.at);
  } else if (e.type == "envmap") {
    object = environment(e);
  } else if (e.type == "sun") {
    if (&e != sun_of_sky_) object = lone_sun(e);
  } else if (e.type == "sky" || e.type == "sunsky" || e.type == "timed_sunsky") {
    object = sky(e);
  } else if (e.type == "collimated") {
    object = beam(e);
  } else if (e.type == "area") {
    if (e.id.empty()) throw Error("an 'area' emitter stands inside a shape", e.at);
    e.read = false;  // read when a shape refers to it
  } else {
    inexact(e, fmt::format("emitter '{}' is not known here: it is left out", e.type));
    e.dismiss();
  }
  return ref_cast<SceneObject>(object);
}

Ref<Component> Converter::spot(const Element& e) {
  const double cutoff = e.number("cutoff_angle", 20);
  Ref<Component> emission = make("ForeignSpotEmission", e, "");
  set(*emission, "radiance", light(e, "intensity", Uv::as_is));
  set_member(*emission, "outer_angle", cutoff, e.location_of("cutoff_angle"));
  set_member(*emission, "inner_angle", e.number("beam_width", cutoff * 3 / 4), e.location_of("beam_width"));
  set_member(*emission, "edge", "linear", e.at);
  // In Mitsuba u and v of the spot's texture begin at the lower right as seen from the light, and image rows at the top.
  if (const Element* picture = e.nested("texture")) {
    set(*emission, "picture", texture(*picture, Uv::as_is));
  }
  Ref<Component> object = make("Point", e);
  set_member(*object, "emission", emission, e.at);
  set_transform(*object, e.transform(), e.location_of("to_world"));
  return object;
}

Ref<Component> Converter::projector(const Element& e) {
  Ref<Component> emission = make("ProjectorEmission", e, "");
  const Element* const picture = e.nested("irradiance");  // null: constant over a square
  set(*emission, "picture", light(e, "irradiance", Uv::from_top));
  set_member(*emission, "scale", e.number("scale", 1) * std::numbers::pi, e.at);
  double aspect = 1;
  if (picture && picture->type == "bitmap")
    if (const auto file =
            importing_.optional_file(picture->string("filename", ""), picture->location_of("filename"), picture->folder)) {
      const Image image = read_image(*file);  // reads the image again, only for its size
      aspect = double(image.width) / double(image.height);
      set_member(*emission, "aspect", aspect, picture->at);
    }
  std::string axis = axis_of(e);
  double fov = e.number("fov", 0);
  const Location at = e.location_of(e.has("fov") ? "fov" : "focal_length");
  if (!e.has("fov")) {  // for a film with the diagonal of 36 x 24 mm
    fov = 2 * std::atan(std::hypot(36, 24) / (2 * focal_length(e))) * degrees_a_radian;
    axis = "diagonal";
  }
  if (axis == "diagonal") {
    fov = 2 * std::atan(std::tan(fov / 2 / degrees_a_radian) / std::sqrt(1 + 1 / (aspect * aspect))) * degrees_a_radian;
    axis = "width";
  }
  set_member(*emission, "fov", fov, at);
  set_member(*emission, "fov_axis", axis, e.location_of("fov_axis"));
  Ref<Component> object = make("Point", e);
  set_member(*object, "emission", emission, e.at);
  set_transform(*object, e.transform(), e.location_of("to_world"));
  return object;
}

Ref<Component> Converter::directional(const Element& e) {
  Ref<Component> object = make("Distant", e);
  set_member(*object, "emission", diffuse_emission(e, !e.has("irradiance") && e.has("intensity") ? "intensity" : "irradiance"),
             e.at);
  const bool given = e.has("direction");
  set_member(*object, "direction", three(e.vector("direction", {0, 0, 1})), e.location_of("direction"));
  if (!given) set_transform(*object, e.transform(), e.location_of("to_world"));
  return object;
}

Ref<Component> Converter::environment(const Element& e) {
  Ref<Component> emission = make("EnvironmentEmission", e, "");
  set_member(*emission, "file", file(e), e.location_of("filename"));
  if (!e.old) set_member(*emission, "rows", "poles", e.at);                // row j at v = j / (height - 1)
  const char* const scale = e.has("scale") ? "scale" : "intensity_scale";  // "intensity_scale" is the name in 0.4
  if (e.has(scale)) set_member(*emission, "scale", e.number(scale, 1), e.location_of(scale));
  if (e.has("gamma")) {
    if (e.number("gamma", 0) == 1) set_member(*emission, "transfer", "linear", e.location_of("gamma"));
  }
  Ref<Component> object = make("Environment", e);
  set_member(*object, "emission", emission, e.at);
  set_transform(*object, e.transform(), e.location_of("to_world"));
  e.ignore({"cache", "mis_compensation"});
  return object;
}

Ref<Component> Converter::beam(const Element& e) {
  Ref<Component> emission = make("CollimatedEmission", e, "");
  set_member(*emission, "about", "axis", e.at);
  set(*emission, "radiance", light(e, "power", Uv::as_is));
  inexact(e, "a beam without width spreads by 0.1 degrees here, and its power is taken for its intensity");
  Ref<Component> object = make("Point", e);
  set_member(*object, "emission", emission, e.at);
  set_transform(*object, e.transform(), e.location_of("to_world"));
  return object;
}

}  // namespace etendue::mitsuba
