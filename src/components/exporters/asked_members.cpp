#include "asked_members.h"

#include <fmt/format.h>

#include "describe/expansion.h"
#include "etendue/describe/registry.h"
#include "etendue/render/job.h"

namespace etendue {

namespace {

thread_local AskedMembers* asking = nullptr;

/// All components below a component, each once, including the objects of scenes, described or imported.
void collect(const Component& part, std::unordered_set<const Component*>& known, std::vector<const Component*>& all) {
  if (!known.insert(&part).second) return;
  all.push_back(&part);
  if (const auto* scene = dynamic_cast<const Scene*>(&part))
    for (const Ref<SceneObject>& object : scene->objects) collect(*object, known, all);
  for (const Component* inner : components_of(part)) collect(*inner, known, all);
}

}  // namespace

AskedMembers::AskedMembers() : outer_(std::exchange(asking, this)) {}
AskedMembers::~AskedMembers() { asking = outer_; }

void AskedMembers::note(const Component& of, std::string_view member) {
  if (asking) asking->asked_[&of].emplace(member);
}

void AskedMembers::note_shape(const SceneObject& object) {
  const ClassInfo* every = Registry::instance().find("SceneObject");
  for (const Member& m : object.class_info().members)
    if (!every->find(m.name)) note(object, m.name);
}

void AskedMembers::tell(const Job& job, Exporting& exporting) const {
  std::unordered_set<const Component*> known;
  std::vector<const Component*> parts;
  if (job.camera) collect(*job.camera, known, parts);
  collect(*job.scene, known, parts);
  for (const Component* part : parts) tell_part(*part, exporting);
}

void AskedMembers::tell_part(const Component& part, Exporting& exporting) const {
  const auto asked = asked_.find(&part);
  // A scene itself is only a list of objects with an acceleration structure.
  if (asked == asked_.end() || dynamic_cast<const Scene*>(&part)) return;
  const bool object = dynamic_cast<const SceneObject*>(&part);
  for (const Member& m : part.class_info().members) {
    if (asked->second.contains(m.name) || (object && m.name == "transform") || equal(m.get(part, m), m.default_value)) continue;
    exporting.inexact(fmt::format("'{}' of {} is left out", m.name, part.class_info().name), &part, m.name);
  }
}

}  // namespace etendue
