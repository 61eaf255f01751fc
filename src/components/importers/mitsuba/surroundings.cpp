// The media on the two sides of shapes, and around the sensor.

#include "components/importers/surroundings.h"

#include <fmt/format.h>

#include <algorithm>

#include "converter.h"
#include "etendue/scene_object.h"

namespace etendue::mitsuba {

namespace {

std::string called(const Element& medium) {
  return medium.id.empty() ? fmt::format("of line {}", medium.at.line) : "'" + medium.id + "'";
}

}  // namespace

Ref<SceneObject> Converter::settle_media(const Element* sensor, bool seen, const std::vector<Ref<SceneObject>>& world) {
  const std::vector<const Element*> of_sensor = sensor ? sensor->all("medium") : std::vector<const Element*>{};
  const Element* const around = of_sensor.empty() ? nullptr : of_sensor.front();
  const auto is_somewhere = [&](const Element* medium) {
    return medium == around || std::ranges::any_of(sides_, [&](const MediumSides& s) { return s.interior == medium; });
  };
  for (const MediumSides& s : sides_)
    if (s.exterior && s.exterior != s.interior && !is_somewhere(s.exterior))
      importing_.inexact("a medium around a shape is left out that is neither around the sensor nor inside of anything", s.at);
  if (!around) return nullptr;
  if (!seen) {
    importing_.inexact("the medium around the sensor is left out, as Mitsuba's integrator does", sensor->at);
    return nullptr;
  }
  AroundCamera camera;
  camera.at = sensor->at;
  camera.name = called(*around);
  camera.program = "Mitsuba";
  const TransformValue t = sensor->transform();
  camera.camera = t.look_at ? t.look_at->from : t.transform.written(0)(DoublePoint3{});
  const Ref<Component> cube = make("Box", *around);  // at the origin: its object space is world space
  camera.medium = medium(*around, *cube);
  if (!camera.medium) return nullptr;
  if (camera.medium->class_info().name != "HomogeneousVolume") {
    camera.box = grid_box(*around);
    if (!camera.box) camera.box = box_of_constant(*around);
    set_member(*cube, "transform", *camera.box, around->at);
    camera.medium = medium(*around, *cube);
  }
  for (const MediumSides& s : sides_)
    if (s.interior == around && s.exterior != around && !s.in_group) camera.bodies.push_back(s.object);
  const Ref<SceneObject> all = surroundings_for(importing_, camera, world);
  const bool everywhere = all && all->surrounds();
  for (const MediumSides& s : sides_)
    if (!s.interior && !s.exterior) let_medium_go_on(importing_, camera, *s.object, everywhere, s.object->location_of());
  if (everywhere) {
    for (const MediumSides& s : sides_) {
      if (s.interior && !s.exterior && s.interior != around)
        importing_.inexact("beyond a shape without an exterior is the medium around the sensor, where Mitsuba has none", s.at);
    }
  }
  return all;
}

}  // namespace etendue::mitsuba
