#include "osl_part.h"

#include <algorithm>

#include "etendue/object_map.h"
#include "parameter_values.h"

namespace etendue::osl {

// A default that is a map is one object of the class's description, so each object has a copy of its own.
OslPart::OslPart(const ClassInfo& info) : info_(info), of_(*static_cast<const OslClass*>(info.declared.get())) {
  for (const Member& m : info.members) {
    if (m.kind != Kind::component || m.list) continue;
    const auto* map = m.default_value.as<Ref<Component>>();
    if (map && *map) declared_values.emplace(m.name, etendue::Value(copy(**map)));
  }
}

bool OslPart::lets_in() const {
  if (!of_.uses.interior || of_.opaque.empty()) return of_.uses.interior;
  const auto is = [this](const std::pair<std::string, float>& setting) {
    const auto given = declared_values.find(setting.first);
    const auto* part = given == declared_values.end() ? nullptr : given->second.as<Ref<Component>>();
    const auto* map = part ? dynamic_cast<const ObjectMap*>(part->get()) : nullptr;
    const Color all = map ? map->constant() : nullptr;
    if (!all) return false;
    const bool number = info_.find(setting.first)->meaning == Meaning::number;
    return number ? map->scalar({}) == setting.second : rgb_of(*all) == Triple(setting.second);
  };
  return !std::ranges::all_of(of_.opaque, is);
}

}  // namespace etendue::osl
