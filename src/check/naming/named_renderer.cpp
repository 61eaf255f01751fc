#include "named_renderer.h"

#include <algorithm>

#include "describe/guard.h"
#include "etendue/describe/declared_class.h"
#include "etendue/language/language.h"

namespace etendue {

bool written(const Component& component, const std::string& member) {
  if (!component.origin) return false;
  const auto& members = component.origin->members;
  return std::any_of(members.begin(), members.end(), [&](const auto& m) { return m.first == member; });
}

void take_over(Renderer& to, const Renderer& from) {
  for (const char* member : {"sampler", "light_sampler", "max_depth"})
    if (!written(to, member) && to.class_info().find(member) && from.class_info().find(member))
      set(to, member, get(from, member));
  for (const Member& member : to.class_info().members) {
    const Value value = get(to, member.name);
    if (const auto* part = value.as<Ref<Component>>())
      if (const Ref<Renderer> inner = ref_cast<Renderer>(*part)) take_over(*inner, from);
  }
}

Ref<Renderer> named_renderer(const Job& job, const std::string& expression, const std::string& option) {
  if (expression == job.renderer->class_info().name) return job.renderer;
  const bool bare = expression.find('{') == std::string::npos;
  Ref<Renderer> renderer = ref_cast<Renderer>(parse_component(bare ? expression + " {}" : expression, option));
  if (!renderer) throw Error("'" + expression + "' is no renderer; see etendue classes Renderer", {intern(option), 0, 0});
  return renderer;
}

}  // namespace etendue
