#pragma once
// Fluorescent shaders within other shaders, which would lose their fluorescence.

#include <unordered_set>

#include "etendue/describe/registry.h"
#include "etendue/reradiation.h"

namespace etendue {

class HiddenFluorescence {
 public:
  /// Throws Error at a shader that fluoresces and stands within the given one, as a layer or a part of a mixture: only the
  /// shader of an object itself is asked for its reradiation. What is within a shader is looked at once.
  void refuse(const Shader& shader) { look_within(shader, shader); }

 private:
  void look_within(const Component& part, const Shader& whole) {
    if (!seen_.insert(&part).second) return;
    for (const Member& member : part.class_info().members)
      if (member.kind == Kind::component) look(member.get(part, member), whole);
  }
  void look(const Value& value, const Shader& whole) {
    if (const auto* list = value.as<Value::List>())
      for (const Value& each : *list) look(each, whole);
    const auto* part = value.as<Ref<Component>>();
    const auto* shader = part ? dynamic_cast<const Shader*>(part->get()) : nullptr;
    if (!shader) return;
    // A shader may be within another and the shader of an object itself.
    if (fluorescent(shader))
      shader->fail({}, "fluoresces within a " + whole.class_info().name +
                           ", where its fluorescence would be lost: it must be the shader of the object itself");
    look_within(*shader, whole);
  }

  std::unordered_set<const Component*> seen_;
};

}  // namespace etendue
