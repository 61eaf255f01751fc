// Closures as text, as the reference implementation's printf shows them.

#include "closure.h"

#include <fmt/format.h>

namespace etendue::osl {

void ClosureShape::add(const Type& type, const String* keyword) {
  const std::size_t to = type.alignment();
  const std::size_t offset = (size + to - 1) / to * to;
  arguments.push_back({keyword, type, offset});
  size = offset + type.size();
}

const ClosureShape::Argument* ClosureShape::find(const String* keyword) const {
  for (std::size_t i = arguments.size(); i-- > 0;)
    if (arguments[i].keyword == keyword) return &arguments[i];
  return nullptr;
}

namespace {

void append_triple(std::string& text, const Triple& t) { text += fmt::format("({:.6g}, {:.6g}, {:.6g})", t.x, t.y, t.z); }

void append_value(std::string& text, const Type& type, const std::byte* at) {
  if (type.is_array()) {
    text += "[";
    for (int i = 0; i < type.elements(); ++i) {
      if (i) text += ", ";
      append_value(text, type.element(), at + std::size_t(i) * type.element_size());
    }
    text += "]";
  } else if (type.is_closure()) {
    text += to_text(*reinterpret_cast<const ClosureNode* const*>(at));
  } else if (type.is_triple()) {
    append_triple(text, *reinterpret_cast<const Triple*>(at));
  } else if (type.is_string()) {
    text += "\"" + (*reinterpret_cast<const String* const*>(at))->text() + "\"";
  } else if (type.is_int()) {
    text += std::to_string(*reinterpret_cast<const int*>(at));
  } else {
    const float* numbers = reinterpret_cast<const float*>(at);
    if (type.floats() > 1) text += "(";
    for (int i = 0; i < type.floats(); ++i) text += fmt::format("{}{:.6g}", i ? ", " : "", numbers[i]);
    if (type.floats() > 1) text += ")";
  }
}

void append_component(std::string& text, const ClosureComponent& c, const Triple& weight) {
  if (!text.empty()) text += "\n\t+ ";
  append_triple(text, weight);
  text += " * " + c.shape->name->text() + " (";
  bool first = true;
  for (const ClosureShape::Argument& a : c.shape->arguments) {
    if (a.keyword && c.shape->find(a.keyword) != &a) continue;
    if (!first) text += ", ";
    first = false;
    if (a.keyword) text += "\"" + a.keyword->text() + "\", ";
    append_value(text, a.type, c.arguments + a.offset);
  }
  // reflection(N) is reflection(N, 0) there.
  static const String* const reflection = intern_string("reflection");
  if (c.shape->name == reflection && c.shape->arguments.size() == 1) text += ", 0";
  // The reference implementation gives these an empty label where a call gives none.
  static const String *const label = intern_string("label"), *const diffuse = intern_string("diffuse"),
                             *const phong = intern_string("phong");
  const String* name = c.shape->name;
  if ((name == diffuse || name == phong) && !c.shape->find(label)) text += ", \"label\", \"\"";
  text += ")";
}

/// Sums may be as deep as a shader's loop is long: so there is a stack of its own instead of recursion.
void append(std::string& text, const ClosureNode* root, Triple root_weight) {
  struct Part {
    const ClosureNode* node;
    Triple weight;
  };
  std::vector<Part> open{{root, root_weight}};
  while (!open.empty() && text.size() < string_limit) {
    const auto [node, weight] = open.back();
    open.pop_back();
    switch (node->kind) {
      case ClosureNode::Kind::component: append_component(text, *static_cast<const ClosureComponent*>(node), weight); break;
      case ClosureNode::Kind::sum: {
        const auto* sum = static_cast<const ClosureSum*>(node);
        open.push_back({sum->b, weight});
        open.push_back({sum->a, weight});
        break;
      }
      case ClosureNode::Kind::product: {
        const auto* product = static_cast<const ClosureProduct*>(node);
        open.push_back({product->closure, weight * product->weight});
        break;
      }
    }
  }
}

}  // namespace

std::string to_text(const ClosureNode* closure) {
  std::string text;
  if (closure) append(text, closure, Triple(1));
  return text;
}

}  // namespace etendue::osl
