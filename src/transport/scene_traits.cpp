// What kinds of light transport a scene asks for.

#include "etendue/scene_traits.h"

namespace etendue {
namespace {

/// As the user knows it: the name it has in the file, or what it is and where.
std::string label(const SceneObject& object) {
  if (object.origin && !object.origin->name.empty()) return "'" + object.origin->name + "'";
  return "the " + object.class_info().name + (object.origin ? " of line " + std::to_string(object.origin->location.line) : "");
}

void look(const Scene& scene, bool nested, SceneTraits& traits) {
  for (const Ref<SceneObject>& object : scene.objects) {
    if (const auto* inner = scene_within(*object)) {
      look(*inner, true, traits);
      continue;
    }
    const std::string name = label(*object);
    const auto note = [&](std::vector<std::string>& list) { list.push_back(name); };
    if (object->shader) {
      const Lobes lobes = object->shader->possible_lobes();
      if (lobes & (specular_reflection | specular_transmission)) note(traits.specular);
      if (lobes & specular_transmission) note(traits.refracting);
      if (lobes & smooth_lobes) note(traits.smooth);
      if (lobes & glossy_lobes) note(traits.glossy);
      if (lobes & pass_through) note(traits.pass_through);
      if (object->shader->moves_exit()) note(traits.moved_exits);
    }
    if (object->unbounded()) note(traits.endless);
    if (object->interior) {
      note(traits.media);
      if (object->interior->emits()) note(traits.emissive_media);
    }
    if (object->luminaire()) {
      if (nested)
        note(traits.nested_luminaires);
      else if (object->delta())
        note(object->infinite() ? traits.distant : traits.points);
      else
        note(object->infinite() ? traits.environments : traits.areas);
    }
  }
}

}  // namespace

SceneTraits scene_traits(const Scene& scene, const Camera& camera) {
  SceneTraits traits;
  look(scene, false, traits);
  // Rays of a lens with an extent begin at different places.
  const Ray a = camera.ray({0.25f, 0.25f}, {0.1f, 0.2f}, camera.shutter_open);
  const Ray b = camera.ray({0.25f, 0.25f}, {0.9f, 0.7f}, camera.shutter_open);
  traits.pinhole = a.origin == b.origin;
  return traits;
}

std::string some_of(const std::vector<std::string>& names) {
  constexpr size_t most = 3;
  std::string text;
  const size_t shown = names.size() <= most ? names.size() : most - 1;
  for (size_t i = 0; i < shown; ++i) text += (i == 0 ? "" : (i + 1 == names.size() ? " and " : ", ")) + names[i];
  if (shown < names.size()) text += " and " + std::to_string(names.size() - shown) + " more";
  return text;
}

}  // namespace etendue
