// Collects the traits of a scene: visits all objects, with the shaders that instances give them.

#include "etendue/transport/scene_traits.h"

#include <set>

#include "etendue/reradiation.h"

namespace etendue {
namespace {

/// The name of an object for users: its name in the file, or its class and line.
std::string label(const SceneObject& object) {
  if (object.origin && !object.origin->name.empty()) return "'" + object.origin->name + "'";
  const int line = object.location_of().line;  // 0: in a file without lines, such as that of a model
  return "the " + object.class_info().name + (line > 0 ? " of line " + std::to_string(line) : "");
}

/// Visits each scene once per shader by which instances replace those of its objects, and adds each object once to a list.
class Look {
 public:
  explicit Look(SceneTraits& traits) : traits_(traits) {}

  /// `instead`: the shader of an instance that replaces those of all objects; null: their own.
  void at(const Scene& scene, const Shader* instead) {
    if (!seen_.insert({&scene, instead}).second) return;
    for (const Ref<SceneObject>& object : scene.objects) {
      if (const Scene* inner = scene_within(*object)) {
        const bool replaces = inner != object.get() && object->shader;  // an instance's shader does, that of a nested scene
                                                                        // does not
        at(*inner, instead ? instead : replaces ? object->shader.get() : nullptr);
      } else {
        at(*object, instead ? instead : object->shader.get());
      }
    }
  }

 private:
  void at(const SceneObject& object, const Shader* shader) {
    const auto note = [&](std::vector<std::string>& list) {
      if (noted_.insert({&list, &object}).second) list.push_back(label(object));
    };
    SceneTraits& t = traits_;
    if (shader) {
      const Lobes lobes = shader->possible_lobes();
      if (lobes & (specular_reflection | specular_transmission)) note(t.specular);
      if (lobes & specular_transmission) note(t.refracting);
      if (lobes & smooth_lobes) note(t.smooth);
      if (lobes & diffuse_lobes) note(t.diffuse);
      if (lobes & glossy_lobes) note(t.glossy);
      if (lobes & null_scattering) note(t.null_scattering);
      if (fluorescent(shader)) note(t.fluorescent);
      if (shader->has_subsurface_exit()) note(t.subsurface_exits);
    }
    if (object.interior) {
      note(t.media);
      if (object.interior->emits()) note(t.emissive_media);
      if (!object.interior->homogeneous()) note(t.heterogeneous_media);
      if (dyed(object.interior.get())) note(t.dyed_media);
    }
    if (object.luminaire()) {
      if (object.delta())
        note(object.infinite() ? t.distant : t.points);
      else
        note(object.infinite() ? t.environments : t.areas);
      if (!object.delta() && object.visible_to_camera) note(object.infinite() ? t.seen_environments : t.seen_areas);
    }
  }

  SceneTraits& traits_;
  std::set<std::pair<const Scene*, const Shader*>> seen_;
  std::set<std::pair<const void*, const SceneObject*>> noted_;  // pairs of list and object
};

}  // namespace

SceneTraits scene_traits(const Scene& scene, const Camera& camera) {
  SceneTraits traits;
  Look(traits).at(scene, nullptr);
  // The rays of a lens with an area start at different points.
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
