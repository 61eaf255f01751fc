#include "lights.h"

#include <cmath>

#include "components/importers/models/surface.h"

namespace etendue::gltf {
namespace {

constexpr double degrees = 180 / 3.14159265358979323846;

Numbers vector(double x, double y, double z) { return Numbers{{x, y, z}, 1, Dimension::none}; }

}  // namespace

Transform without_stretch(const Transform& t) {
  Transform::DoubleMatrix m = t.exact();
  for (size_t c = 0; c < 3; ++c) {
    const double length = std::sqrt(m[c] * m[c] + m[4 + c] * m[4 + c] + m[8 + c] * m[8 + c]);
    if (!(length > 0)) return Transform::translate({m[3], m[7], m[11]});
    for (size_t r = 0; r < 12; r += 4) m[r + c] /= length;
  }
  return Transform(m);
}

// glTF measures light in candela and lux, and emissive surfaces in cd/m^2. All are converted such that 1 cd/m^2 has the
// luminance Y = 1 (in SI units it is 683 lm/W * 106.857 nm = 72984 times less, which changes the exposure only): viewers show 1
// cd/m^2 as white, and the lights added to files without light match it.
Ref<Component> make_light(Importing& importing, const Document& document, size_t index, const Transform& transform) {
  const Json& lights = list_in(extension(document.json(), "KHR_lights_punctual"), "lights");
  if (index >= lights.size()) throw Error(fmt::format("there is no KHR_lights_punctual.lights[{}]", index));
  const Json& light = lights[index];
  return within(fmt::format("KHR_lights_punctual.lights[{}]", index), [&] {
    const Location at = importing.at();
    const std::string type = text(light, "type"), name = plain_name(text(light, "name"));
    auto color = numbers<3>(light, "color").value_or(std::array<double, 3>{1, 1, 1});
    for (double& c : color) c *= number(light, "intensity", 1);
    const bool spot = type == "spot", distant = type == "directional";
    if (!spot && !distant && type != "point") throw Error("a light of the type '" + type.substr(0, 20) + "' is unknown");
    Ref<Component> emission = importing.make(spot ? "ForeignSpotEmission" : "DiffuseEmission", at);
    set(*emission, "radiance", color_value(color, at));
    if (spot) {
      const Json& cone = object_in(light, "spot");
      const double outer = number(cone, "outerConeAngle", 45 / degrees), inner = number(cone, "innerConeAngle", 0);
      if (!(outer > 0 && outer <= 90.01 / degrees && inner >= 0 && inner <= outer)) throw Error("its cone has no right angles");
      set_member(*emission, "outer_angle", Number{outer, Dimension::angle}, at);
      set_member(*emission, "inner_angle", Number{inner, Dimension::angle}, at);
      set_member(*emission, "axis", vector(0, 0, -1), at);
      set_member(*emission, "edge", "square", at);
    }
    if (number(light, "range", 0) > 0) importing.inexact("a light reaches farther than its 'range', as light does", at);
    Ref<Component> object = importing.make(distant ? "Distant" : "Point", at, name);
    set(*object, "emission", Value(emission, at));
    if (distant) set_member(*object, "direction", vector(0, 0, -1), at);
    set(*object, "transform", Value(without_stretch(transform), at));
    return object;
  });
}

MadeCamera make_camera(Importing& importing, const Document& document, size_t index, const Transform& transform) {
  const Json& camera = document.element("cameras", index);
  return within(fmt::format("cameras[{}]", index), [&] {
    const Location at = importing.at();
    const std::string type = text(camera, "type");
    const Json& view = object_in(camera, type == "orthographic" ? "orthographic" : "perspective");
    MadeCamera made;
    const std::string name = plain_name(text(camera, "name"));
    if (type == "perspective") {
      made.camera = importing.make("PerspectiveCamera", at, name);
      const double angle = number(view, "yfov", 0) * degrees;
      if (!(angle > 0 && angle < 179)) throw Error(fmt::format("its 'yfov' is {} degrees", angle));
      set_member(*made.camera, "fov", Number{angle / degrees, Dimension::angle}, at);
      set_member(*made.camera, "fov_axis", "height", at);
      made.aspect = number(view, "aspectRatio", 0);
    } else if (type == "orthographic") {
      made.camera = importing.make("OrthographicCamera", at, name);
      const double half_width = number(view, "xmag", 0), half_height = number(view, "ymag", 0);
      if (!(half_width != 0 && half_height != 0)) throw Error("its 'xmag' or 'ymag' is 0");
      set_member(*made.camera, "width", 2 * std::abs(half_width), at);
      made.aspect = std::abs(half_width / half_height);
    } else {
      throw Error("a camera of the type '" + type.substr(0, 20) + "' is unknown");
    }
    // All glTF viewers clip at these planes, and so does Cycles, whose exported files state them.
    const double nearest = number(view, "znear", 0), farthest = number(view, "zfar", 0);
    if (!(nearest >= 0) || (farthest != 0 && !(farthest > nearest))) throw Error("its 'znear' and 'zfar' leave nothing to see");
    if (nearest > 0) set_member(*made.camera, "near_clip", nearest, at);
    if (farthest > 0) set_member(*made.camera, "far_clip", farthest, at);
    set_member(*made.camera, "from", vector(0, 0, 0), at);
    set_member(*made.camera, "to", vector(0, 0, -1), at);
    set(*made.camera, "transform", Value(without_stretch(transform), at));
    return made;
  });
}

}  // namespace etendue::gltf
