#include "osl_part.h"

namespace etendue::osl {

// A default that is a map is one object of the class's description, so each object has a copy of its own.
OslPart::OslPart(const ClassInfo& info) : info_(info), of_(*static_cast<const OslClass*>(info.declared.get())) {
  for (const Member& m : info.members) {
    if (m.kind != Kind::component || m.list) continue;
    const auto* map = m.default_value.as<Ref<Component>>();
    if (map && *map) declared_values.emplace(m.name, etendue::Value(copy(**map)));
  }
}

}  // namespace etendue::osl
