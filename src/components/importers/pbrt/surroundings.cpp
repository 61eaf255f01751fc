// The media on the two sides of surfaces, and around the camera.

#include "components/importers/surroundings.h"

#include <fmt/format.h>

#include <algorithm>

#include "reader.h"

namespace etendue::pbrt {

Ref<SceneObject> Reader::settle_media() {
  const auto has_outside = [&](const std::string& medium) {
    return medium == around_camera || std::ranges::any_of(sides_, [&](const MediumSides& s) { return s.inside == medium; });
  };
  for (const MediumSides& s : sides_)
    if (!s.outside.empty() && s.outside != s.inside && !has_outside(s.outside))
      importing.inexact(
          fmt::format(
              "the medium '{}' outside of an object is left out: it is neither around the camera nor inside of anything",
              s.outside),
          s.at);
  if (around_camera.empty()) return nullptr;
  if (!knows_media(*this)) {
    importing.inexact(fmt::format("the medium '{}' around the camera is left out, as pbrt's integrator '{}' does",
                                  around_camera, integrator.type.empty() ? "path" : integrator.type),
                      around_camera_at);
    return nullptr;
  }
  AroundCamera around;
  around.medium = medium_for(*this, around_camera, Transform(), around_camera_at);
  around.name = "'" + around_camera + "'";
  around.program = "pbrt";
  around.at = around_camera_at;
  around.camera = camera_to_world.written(float(times[0]))(DoublePoint3{});
  if (const auto box = boxes.find(around_camera); box != boxes.end()) {
    around.box = box->second;
    if (around.medium) around.medium = medium_for(*this, around_camera, box->second, around_camera_at);
  }
  for (const MediumSides& s : sides_)
    if (s.inside == around_camera && s.outside != around_camera && !s.in_group)
      around.bodies.push_back(ref_cast<SceneObject>(s.object));
  const Ref<SceneObject> all = surroundings_for(importing, around, objects_);
  const bool everywhere = all && all->surrounds();
  for (const MediumSides& s : sides_)
    if (s.inside.empty() && s.outside.empty())
      let_medium_go_on(importing, around, *ref_cast<SceneObject>(s.object), everywhere, s.at);
  if (everywhere)
    for (const MediumSides& s : sides_) {
      if (s.outside.empty() && !s.inside.empty() && s.inside != around_camera)
        importing.inexact(
            fmt::format("beyond an object that names no medium outside is '{}', where pbrt has none", around_camera), s.at);
    }
  return all;
}

}  // namespace etendue::pbrt
