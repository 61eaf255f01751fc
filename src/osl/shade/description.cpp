#include "description.h"

#include <fmt/format.h>

namespace etendue::osl {
namespace {

/// A constant as text: numbers with blanks, texts quoted.
std::string value_text(const Constant& c) {
  std::string text;
  const int count = c.type.elements() * (c.type.base == Base::string || c.type.base == Base::int_ ? 1 : c.type.floats());
  for (int i = 0; i < count; ++i) {
    if (i) text += ' ';
    if (c.type.base == Base::string)
      text += fmt::format("\"{}\"", c.at<const String*>(std::size_t(i))->text());
    else if (c.type.base == Base::int_)
      text += fmt::format("{}", c.at<int>(std::size_t(i)));
    else
      text += fmt::format("{:g}", c.at<float>(std::size_t(i)));
  }
  return count > 1 ? "[ " + text + " ]" : text;
}

}  // namespace

void print_description(const Shader& shader) {
  fmt::print("{} \"{}\"\n", name_of(shader.kind), shader.name);
  for (const Metadatum& m : shader.metadata)
    fmt::print("    metadata: {} {} = {}\n", m.value.type.name(), m.name, value_text(m.value));
  for (const Symbol* parameter : shader.parameters) {
    fmt::print("    \"{}\" \"{}{}\"\n", parameter->name, parameter->role == Symbol::Role::output ? "output " : "",
               parameter->type.name());
    if (parameter->initial && parameter->initial->kind == Expression::Kind::constant && !parameter->type.is_structure())
      fmt::print("\t\tDefault value: {}\n", value_text(parameter->initial->constant));
    else
      fmt::print("\t\tUnknown default value\n");
    for (const Metadatum& m : parameter->metadata)
      fmt::print("\t\tmetadata: {} {} = {}\n", m.value.type.name(), m.name, value_text(m.value));
  }
}

void print_group(const GroupDescription& group, const ShaderGroup& built) {
  fmt::print("Shader group:\n---\n");
  for (int i = 0; i < built.layer_count(); ++i) {
    for (const ParameterText& p : group.layers[std::size_t(i)].parameters) {
      fmt::print("param {} {}", p.type, p.name);
      for (const std::string& word : p.words) fmt::print(" {}", word);
      fmt::print(" ;\n");
    }
    fmt::print("shader {} {} ;\n", built.shader_name(i)->text(), built.layer_name(i)->text());
    for (const ConnectionText& c : group.connections)
      if (c.to_layer == built.layer_name(i)->text())
        fmt::print("connect {}.{} {}.{} ;\n", c.from_layer, c.from, c.to_layer, c.to);
  }
  fmt::print("\n---\n\n");
}

void print_layers(const ShaderGroup& group) {
  fmt::print("Shader group \"{}\" layers are:\n", group.name()->text());
  for (int i = 0; i < group.layer_count(); ++i) {
    fmt::print("    {}\n", group.layer_name(i)->text());
    for (const Symbol* p : group.shader(i).parameters)
      fmt::print("\t{}{} {}\n", p->role == Symbol::Role::output ? "output " : "", p->type.name(), p->name);
  }
}

}  // namespace etendue::osl
