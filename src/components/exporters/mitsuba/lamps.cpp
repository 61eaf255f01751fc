// Writes light sources that are not surfaces.

#include <cmath>
#include <numbers>

#include "components/exporters/baked_images.h"
#include "writer.h"

namespace etendue::mitsuba_export {

/// The radiance of an EnvironmentEmission that is the same in all directions, before its scale; null: it is not.
static Color constant_environment(const Component& emission) {
  const Ref<Component> map = part_of(emission, "radiance");
  return map ? constant_of(*map) : nullptr;
}

bool Writer::light_source(const SceneObject& o, const Transform& placed) {
  const std::string& type = class_of(o);
  if (type != "Point" && type != "Distant" && type != "Environment") return false;
  const Ref<Component> e = part_of(o, "emission");
  if (!e) return true;
  const std::string& kind = class_of(*e);
  const auto note_illuminance = [&] {
    if (number_of(*e, "illuminance") > 0)
      exporting.inexact("the illuminance of an environment is left out: it is as strong as its scale says", e.get());
  };
  if (type == "Point") {
    point(o, *e, placed);
  } else if (type == "Distant") {
    Node n = plugin(scene_, "emitter", "directional");
    light(n, "irradiance", o, *e, Uv::as_is);
    const std::vector<double> d = numbers_of(o, "direction");
    const DoublePoint3 from = placed(DoublePoint3{}), to = placed(DoublePoint3{d[0], d[1], d[2]});
    value(n, "vector", "direction", fmt::format("{} {} {}", to.x - from.x, to.y - from.y, to.z - from.z));
  } else if (kind == "EnvironmentEmission" && !word_of(*e, "file").empty()) {
    note_illuminance();
    Node n = plugin(scene_, "emitter", "envmap");
    // Read by get(), which does not record it as read, so that AskedMembers warns that the transfer function is left out.
    const std::string file = word_of(*e, "file"),
                      laid_out = baked_cube(exporting, file, *get(*e, "transfer").as<std::string>());
    text(n, "filename", laid_out.empty() ? exporting.copy_beside(file) : laid_out);
    number(n, "scale", number_of(*e, "scale"));
    transform(n, "to_world", placed);
    if (word_of(*e, "rows") != "poles")
      exporting.inexact("the rows of an environment lie half a texel apart in Mitsuba", e.get());
  } else if (kind == "DiffuseEmission") {
    light(plugin(scene_, "emitter", "constant"), "radiance", o, *e, Uv::as_is);
  } else if (const Color c = kind == "EnvironmentEmission" ? constant_environment(*e) : nullptr) {
    note_illuminance();
    const double scale = number_of(*e, "scale");
    spectrum(plugin(scene_, "emitter", "constant"), "radiance", scale == 1 ? c : scaled_spectrum(scale, c), ColorUse::radiance);
  } else {
    exporting.inexact(fmt::format("Mitsuba has no environment like {}: it is left out", kind), e.get());
  }
  return true;
}

void Writer::point(const SceneObject& o, const Component& e, const Transform& placed) {
  const std::string& kind = class_of(e);
  if (is_spot(e)) return spot(o, e, placed);
  if (kind == "ProjectorEmission") return projector(o, e, placed);
  if (kind != "DiffuseEmission") exporting.inexact(fmt::format("{} shines alike in all directions in Mitsuba", kind), &e);
  const std::vector<double> p = numbers_of(o, "position");
  Node n = plugin(scene_, "emitter", "point");
  light(n, "intensity", o, e, Uv::as_is);
  const DoublePoint3 at = placed(DoublePoint3{p[0], p[1], p[2]});
  value(n, "point", "position", fmt::format("{} {} {}", at.x, at.y, at.z));
}

void Writer::spot(const SceneObject& o, const Component& e, const Transform& placed) {
  const std::vector<double> p = numbers_of(o, "position"), a = numbers_of(e, "axis");
  Node n = plugin(scene_, "emitter", "spot");
  light(n, "intensity", o, e, Uv::as_is);
  number(n, "cutoff_angle", number_of(e, "outer_angle"));
  number(n, "beam_width", number_of(e, "inner_angle"));
  const bool along_z = a[0] == 0 && a[1] == 0 && a[2] > 0;  // as in Mitsuba, with the image upright
  const DoubleVector3 up = std::abs(a[1]) < 0.9 ? DoubleVector3{0, 1, 0} : DoubleVector3{1, 0, 0};
  transform(n, "to_world",
            placed * (along_z ? Transform::translate({p[0], p[1], p[2]})
                              : Transform::look_at({p[0], p[1], p[2]}, {p[0] + a[0], p[1] + a[1], p[2] + a[2]}, up)));
  if (const Ref<Component> picture = part_of(e, "picture")) {
    map(n, "texture", e, "picture", ColorUse::reflectance, Uv::as_is);
    if (!along_z) exporting.inexact("the picture of a spot lies about its axis in Mitsuba", &e);
  }
  if (spot_edge(e) != "linear") exporting.inexact("the edge of a spot is linear in angle in Mitsuba", &e);
}

void Writer::projector(const SceneObject& o, const Component& e, const Transform& placed) {
  const std::vector<double> p = numbers_of(o, "position");
  Node n = plugin(scene_, "emitter", "projector");
  if (const std::string file = word_of(e, "file"); !file.empty()) {
    const Ref<Component> image = made_.emplace_back(Registry::instance().create("ImageMap"));
    set(*image, "file", Value(FilePath{file, {}}));
    for (const char* member : {"transfer", "color_space"}) set(*image, member, value_of(e, member));
    texture(n, "irradiance", *image, ColorUse::radiance, {}, Uv::from_top);
  } else if (const Ref<Component> picture = part_of(e, "picture")) {
    map(n, "irradiance", e, "picture", ColorUse::radiance, Uv::from_top);
    // In Mitsuba the projected image has the aspect ratio of its file.
    const Component* inner = picture.get();
    Ref<Component> held;
    while (inner->class_info().find("map")) {
      held = part_of(*inner, "map");
      if (!held) break;
      inner = held.get();
    }
    number_of(e, "aspect");
    if (class_of(*inner) != "ImageMap" && number_of(e, "aspect") != 1)
      exporting.inexact("a picture that is no image is projected over a square in Mitsuba", &e);
  }
  // Mitsuba's scale is 1/pi of ours for the same light.
  number(n, "scale", number_of(e, "scale") * strength_of(o, e) / std::numbers::pi);
  const std::string axis = word_of(e, "fov_axis");
  number(n, "fov", number_of(e, "fov"));
  text(n, "fov_axis", axis == "width" ? "x" : (axis == "height" ? "y" : axis));
  transform(n, "to_world", placed * Transform::translate({p[0], p[1], p[2]}));
  if (word_of(e, "even") != "screen") exporting.inexact("a projector is even on a screen in Mitsuba", &e);
}

}  // namespace etendue::mitsuba_export
