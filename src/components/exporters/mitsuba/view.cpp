// Writes the sensor, its film, and the integrator.

#include <algorithm>
#include <cmath>

#include "components/exporters/asked_members.h"
#include "writer.h"

namespace etendue::mitsuba_export {

void Writer::view() {
  integrator();
  const std::string& type = class_of(*job.camera);
  const bool lens = type == "PerspectiveCamera" && number_of(*job.camera, "lens_radius") > 0;
  Node sensor = plugin(scene_, "sensor", type == "OrthographicCamera" ? "orthographic" : (lens ? "thinlens" : "perspective"));
  camera(sensor);
  film(sensor);
  Node sampler = plugin(sensor, "sampler", "independent");
  integer(sampler, "sample_count", long(job.renderer->samples));
}

void Writer::camera(Node n) {
  const Component& c = *job.camera;
  const std::vector<double> from = numbers_of(c, "from"), to = numbers_of(c, "to"), up = numbers_of(c, "up");
  Transform placed = still(transform_of(c, "transform"), c) *
                     Transform::look_at({from[0], from[1], from[2]}, {to[0], to[1], to[2]}, {up[0], up[1], up[2]});
  if (class_of(c) == "OrthographicCamera") {
    const double half = number_of(c, "width") / 2;
    placed = placed * Transform::scale({half, half, 1});
  } else if (class_of(c) == "PerspectiveCamera") {
    const std::string axis = word_of(c, "fov_axis");
    number(n, "fov", field_of_view(c));
    text(n, "fov_axis", axis == "width" ? "x" : (axis == "height" ? "y" : axis));
    const std::vector<double> middle = numbers_of(c, "principal_point");
    const double distance = number_of(c, "focus_distance"), radius = number_of(c, "lens_radius");
    if (radius > 0 && (middle[0] != 0 || middle[1] != 0)) {  // Mitsuba refuses to load such a sensor
      exporting.inexact("the middle of a picture through a lens is in its axis in Mitsuba", &c, "principal_point");
    } else {
      if (middle[0] != 0) number(n, "principal_point_offset_x", -middle[0]);
      if (middle[1] != 0) number(n, "principal_point_offset_y", -middle[1]);
    }
    if (radius > 0) {
      number(n, "aperture_radius", radius);
      number(n, "focus_distance", distance > 0 ? distance : std::hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]));
    }
  } else {
    exporting.inexact(fmt::format("Mitsuba has no sensor like {}: a perspective one stands for it", class_of(c)), &c);
  }
  // Mitsuba has a default for both: if nothing is clipped here, they are set so near and so far that they cut nothing.
  const double near_clip = number_of(c, "near_clip"), far_clip = number_of(c, "far_clip");
  number(n, "near_clip", near_clip > 0 ? near_clip : (far_clip > 0 ? std::min(1e-4, far_clip / 2) : 1e-4));
  number(n, "far_clip", far_clip > 0 ? far_clip : std::max(1e7, 2 * near_clip));
  transform(n, "to_world", placed);
  for (const Ref<SceneObject>& object : job.scene->objects) {
    if (!object->surrounds()) continue;
    if (part_of(*object, "shader")) exporting.inexact("the index of surroundings is left out", object.get());
    around_ = part_of(*object, "interior");
    if (around_) medium(n, *around_, "medium", {});
    if (around_ && number_of(*object, "reach") > 0) exporting.inexact("surroundings go on for ever in Mitsuba", object.get());
  }
}

void Writer::film(Node sensor) {
  const Component& image = *job.image;
  Node n = plugin(sensor, "film", "hdrfilm");
  integer(n, "width", long(number_of(image, "width")));
  integer(n, "height", long(number_of(image, "height")));
  const std::vector<double> crop = numbers_of(image, "crop");
  if (crop.size() == 4) {
    integer(n, "crop_offset_x", long(crop[0]));
    integer(n, "crop_offset_y", long(crop[1]));
    integer(n, "crop_width", long(crop[2] - crop[0]));
    integer(n, "crop_height", long(crop[3] - crop[1]));
  }
  text(n, "component_format", "float32");
  const Ref<Component> f = part_of(image, "filter");
  const std::string& type = class_of(*f);
  const double radius = number_of(*f, "radius");
  if (type == "GaussianFilter") {
    const double deviation = number_of(*f, "deviation");
    number(plugin(n, "rfilter", "gaussian"), "stddev", deviation);
    if (radius != 4 * deviation) exporting.inexact("a Gaussian filter ends at four standard deviations in Mitsuba", f.get());
  } else if (type == "TriangleFilter") {
    number(plugin(n, "rfilter", "tent"), "radius", radius);
  } else if (type == "MitchellFilter") {
    Node filter = plugin(n, "rfilter", "mitchell");
    number(filter, "B", number_of(*f, "b"));
    number(filter, "C", number_of(*f, "c"));
  } else if (type == "LanczosFilter") {
    integer(plugin(n, "rfilter", "lanczos"), "lobes", std::lround(radius));
  } else {
    plugin(n, "rfilter", "box");
    if (type != "BoxFilter" || radius != 0.5) exporting.inexact("the filter becomes a box of one pixel", f.get());
  }
}

// In Mitsuba the camera sees all emitters or none.
void Writer::hide_emitters(Node integrator) {
  std::vector<const SceneObject*> seen, unseen;
  const auto sort = [&](const Scene& scene, const auto& again) -> void {
    for (const Ref<SceneObject>& o : scene.objects)
      if (const Scene* inner = scene_within(*o))
        again(*inner, again);
      else if (!truth_of(*o, "visible_to_camera") && !o->delta())
        unseen.push_back(o.get());
      else if (o->luminaire() && !o->delta())
        seen.push_back(o.get());
  };
  sort(*job.scene, sort);
  if (unseen.empty()) return;
  const bool all = seen.empty() && std::ranges::all_of(unseen, [](const SceneObject* o) { return o->luminaire(); });
  if (all) return truth(integrator, "hide_emitters", true);
  for (const SceneObject* o : unseen)
    exporting.inexact("the camera sees this: Mitsuba hides all luminaires or none, and nothing else", o, "visible_to_camera");
}

void Writer::integrator() {
  const Component& r = *job.renderer;
  const std::string& type = class_of(r);
  if (type == "DirectRenderer") {
    hide_emitters(plugin(scene_, "integrator", "direct"));
    return;
  }
  const bool media =
      std::ranges::any_of(job.scene->objects, [](const Ref<SceneObject>& o) { return bool(part_of(*o, "interior")); });
  Node n = plugin(scene_, "integrator", media ? "volpath" : "path");
  const double depth = r.class_info().find("max_depth") ? number_of(r, "max_depth") : 64;
  integer(n, "max_depth", depth >= 100000 ? -1 : long(depth));
  hide_emitters(n);
  if (type != "PathTracer") exporting.inexact(fmt::format("paths are traced from the camera instead of {}", type), &r);
}

std::string Writer::write() {
  const AskedMembers asked;
  scene_ = document_.append_child("scene");
  scene_.append_attribute("version") = "3.0.0";
  view();
  objects(scene_, *job.scene, {});
  asked.tell(job, exporting);
  struct Text final : pugi::xml_writer {
    std::string text;
    void write(const void* data, size_t size) override { text.append(static_cast<const char*>(data), size); }
  } out;
  document_.save(out, "    ", pugi::format_default, pugi::encoding_utf8);
  return out.text;
}

}  // namespace etendue::mitsuba_export
