#include "render/imported.h"

#include <algorithm>
#include <set>

#include "describe/expansion.h"
#include "etendue/import_by.h"
#include "etendue/object_map.h"
#include "etendue/render/job.h"
#include "etendue/scene.h"
#include "etendue/shader.h"

namespace etendue {
namespace {

/// Whether a shader is fully transparent everywhere, so that all light is null-scattered.
bool lets_all_through(const Shader& shader) {
  const std::string& kind = shader.class_info().name;
  const char* const member = kind == "MaskShader" ? "opacity" : (kind == "Principled" ? "geometry_opacity" : nullptr);
  if (!member) return false;
  const Value value = get(shader, member);
  const Ref<Component>* const part = value.as<Ref<Component>>();
  const Ref<ObjectMap> map = part ? ref_cast<ObjectMap>(*part) : nullptr;
  const Color opacity = map ? map->constant() : nullptr;
  return opacity && !opacity->varies() && opacity->at(550, ColorUse::coefficient) <= 0;
}

struct Surfaces {
  bool any = false, seen = false;
  std::set<const Component*> known;

  void add(const Scene& scene) {
    if (!known.insert(&scene).second) return;
    for (const Ref<SceneObject>& object : scene.objects)
      if (!seen) add(*object);
  }

 private:
  // An object without a shader is black, unless it only emits; an object with a medium inside is visible by this medium.
  void add(const SceneObject& object) {
    if (const auto* const scene = dynamic_cast<const Scene*>(&object)) return add(*scene);
    bool holds_others = false;
    for (const Component* part : components_of(object)) {
      const auto* const scene = dynamic_cast<const Scene*>(part);
      const auto* const inner = dynamic_cast<const SceneObject*>(part);
      holds_others = holds_others || inner;
      if (scene)
        add(*scene);
      else if (inner)
        add(*inner);
    }
    if (object.shader) {
      any = true;
      seen = seen || object.interior || !lets_all_through(*object.shader);
    } else if (!holds_others && !object.emission) {
      any = seen = true;
    }
  }
};

}  // namespace

Ref<Component> imported(const Importer& importer, Importing& importing) {
  Ref<Component> read = import_by(importer, importing);
  const Ref<Job> job = ref_cast<Job>(read);
  const Ref<Scene> scene = job ? job->scene : ref_cast<Scene>(read);
  if (!scene) return read;
  Surfaces surfaces;
  surfaces.add(*scene);
  if (surfaces.any && !surfaces.seen)
    importing.inexact("it is fully transparent (an opacity of 0) and therefore invisible: is that intended?", importing.at());
  return read;
}

}  // namespace etendue
