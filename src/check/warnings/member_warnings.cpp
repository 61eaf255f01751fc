// Warns of members that were written in the file but have no effect, according to their component's conditions (`matters`).

#include <fmt/format.h>

#include <unordered_set>

#include "etendue/describe/registry.h"
#include "scene_warnings.h"

namespace etendue {
namespace {

/// All components that a component refers to, itself included, each once, depth first in the order of their members.
void collect(const Component& c, std::unordered_set<const Component*>& seen, std::vector<const Component*>& all) {
  std::vector<const Component*> rest = {&c};
  while (!rest.empty()) {
    const Component* next = rest.back();
    rest.pop_back();
    if (!seen.insert(next).second) continue;
    all.push_back(next);
    std::vector<const Component*> below;
    for (const Member& m : next->class_info().members) {
      if (m.kind != Kind::component) continue;
      const Value value = m.get(*next, m);
      if (const auto* part = value.as<Ref<Component>>(); part && *part) below.push_back(part->get());
      if (const auto* list = value.as<Value::List>())
        for (const Value& item : *list)
          if (const auto* part = item.as<Ref<Component>>(); part && *part) below.push_back(part->get());
    }
    rest.insert(rest.end(), below.rbegin(), below.rend());
  }
}

}  // namespace

void warn_of_members(const Component& root, std::vector<SceneWarning>& list) {
  std::unordered_set<const Component*> seen;
  std::vector<const Component*> all;
  collect(root, seen, all);
  for (const Component* c : all) {
    if (!c->origin) continue;
    const ClassInfo& info = c->class_info();
    for (const auto& [name, place] : c->origin->members) {
      const Member* m = info.find(name);
      // A member that was written with its default value is not reported: nothing is lost.
      if (!m || matters(*c, *m) || equal(m->get(*c, *m), m->default_value)) continue;
      for (const Condition& condition : m->conditions)
        if (!condition.holds(*c)) {
          list.push_back({"does not matter",
                          fmt::format("{}.{} has no effect: it matters only when {}", info.name, name, condition.text(info)),
                          place});
          break;
        }
    }
  }
}

}  // namespace etendue
