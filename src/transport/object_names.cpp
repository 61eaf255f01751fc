#include "object_names.h"

#include <set>

#include "etendue/shader.h"

namespace etendue {

ObjectNames::ObjectNames(const Scene& scene) { add(scene, true); }

void ObjectNames::add(const Scene& scene, bool outermost) {
  int index = 0;
  for (const Ref<SceneObject>& object : scene.objects) {
    add(*object);
    if (++index; outermost) objects_.try_emplace(object.get(), index);
    if (object->shader) {
      add(*object->shader);
      materials_.try_emplace(object->shader.get(), int(materials_.size()) + 1);
    }
    if (const Scene* inner = scene_within(*object)) add(*inner, false);
  }
}

void ObjectNames::add(const Component& part) {
  if (names_.contains(&part)) return;
  const std::string& type = part.class_info().name;
  const bool named = part.origin && !part.origin->name.empty();
  names_[&part] = named ? part.origin->name : type + " " + std::to_string(++counts_[type]);
  if (part.origin) written_[place_of(part)] = names_[&part];
}

ObjectNames::Place ObjectNames::place_of(const Component& part) {
  const Location& at = part.origin->location;
  return {at.file, at.line, at.column};
}

// Where an instance has replaced the shader, another object stands for the one of the list: it has the same origin.
std::string ObjectNames::name_of(const SceneObject& object) const {
  if (const auto found = names_.find(&object); found != names_.end()) return found->second;
  if (!object.origin) return object.class_info().name;
  const auto found = written_.find(place_of(object));
  return found != written_.end() ? found->second : object.class_info().name;
}

NamePath ObjectNames::path(const Hit& hit) const {
  NamePath names;
  for (int i = hit.depth; i-- > 0;)
    if (const auto found = names_.find(hit.scenes[i]); found != names_.end()) names.push_back(found->second);
  names.push_back(name_of(*hit.object));
  return names;
}

std::string ObjectNames::material(const SceneObject& object) const {
  const auto found = names_.find(object.shader.get());
  return found == names_.end() ? "none" : found->second;
}

int ObjectNames::object_number(const Hit& hit) const {
  const SceneObject* const outermost = hit.depth > 0 ? hit.scenes[hit.depth - 1] : hit.object;
  const auto found = objects_.find(outermost);
  return found == objects_.end() ? 0 : found->second;
}

int ObjectNames::material_number(const SceneObject& object) const {
  const auto found = materials_.find(object.shader.get());
  return found == materials_.end() ? 0 : found->second;
}

std::vector<std::string> ObjectNames::all() const {
  std::set<std::string> names;
  for (const auto& [part, name] : names_)
    if (dynamic_cast<const SceneObject*>(part)) names.insert(name);
  return {names.begin(), names.end()};
}

}  // namespace etendue
