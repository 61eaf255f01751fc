// TextEditor: classes and names of components in the text.

#include <fmt/format.h>

#include "etendue/language/language.h"
#include "language/lexer.h"
#include "language/writer.h"
#include "text_editor.h"

namespace etendue::studio {

using language::Node;
using language::NodeType;

namespace {

/// Whether the class has a member of this name that accepts the value.
bool fits(const ClassInfo& now, const Member& member, const Value& value) {
  const Member* there = now.find(member.name);
  if (!there) return false;
  try {
    const Ref<Component> tried = now.create();
    set(*tried, member.name, value);
    return true;
  } catch (const Error&) {
    return false;
  }
}

std::string snake_case(const std::string& class_name) {
  std::string text;
  for (const char c : class_name) {
    const bool capital = c >= 'A' && c <= 'Z';
    if (capital && !text.empty()) text += '_';
    text += capital ? char(c - 'A' + 'a') : c;
  }
  return text;
}

Member one_of(const Member& list) {
  Member one = list;
  one.list = false;
  return one;
}

/// A value for a required member.
std::string required_text(const Member& member) {
  if (!member.choices.empty()) return member.choices.front();
  switch (member.kind) {
    case Kind::component: {
      if (member.list) return "[]";
      const ClassInfo* wanted = Registry::instance().find(member.component_class);
      for (const ClassInfo* candidate : Registry::instance().subclasses(*wanted))
        if (!candidate->literal.empty()) return "0.5";
      // The class with the fewest required members.
      const ClassInfo* best = nullptr;
      size_t least = 0;
      for (const ClassInfo* candidate : Registry::instance().subclasses(*wanted)) {
        if (candidate->abstract()) continue;
        size_t needs = 0;
        for (const Member& m : candidate->members) needs += m.required;
        if (!best || needs < least) best = candidate, least = needs;
      }
      return best ? new_component_text(*best) : "none";
    }
    case Kind::file:
    case Kind::string: return member.list ? "[]" : "\"\"";
    case Kind::color: return "0.5";
    case Kind::boolean: return "false";
    case Kind::transform: return "translate(0, 0, 0)";
    case Kind::number:
    case Kind::integer: {
      if (member.list) return "[]";
      double x = 1;
      if (member.soft) x = member.soft->low;
      if (member.range && !member.range->contains(x)) x = member.range->open_low ? member.range->high : member.range->low;
      return fmt::format("{}", x);
    }
    default: return member.list ? (member.kind == Kind::point3 ? "[[0, 0, 0], [1, 0, 0], [0, 1, 0]]" : "[]") : "[0, 0, 1]";
  }
}

/// Entries for a list that is empty by default but may have to be nonempty: a component, or the vertices of a triangle. Empty:
/// no suitable entries are known.
std::string entries_text(const Member& member) {
  const auto* numbers = member.default_value.as<Numbers>();
  const auto* list = member.default_value.as<Value::List>();
  if (!member.list || (numbers && !numbers->values.empty()) || (list && !list->empty())) return {};
  if (member.kind == Kind::component) return "[" + required_text(one_of(member)) + "]";
  if (member.kind == Kind::point3) return "[[0, 0, 0], [1, 0, 0], [0, 1, 0]]";
  if (member.name == "triangles") return "[[0, 1, 2]]";
  if (member.name == "indices") return "[0, 1, 2]";
  if (member.name == "face_sizes") return "[3]";
  return {};
}

bool can_be_prepared(const std::string& text) {
  try {
    prepare_tree(*parse_component(text, "new part"));
    return true;
  } catch (const std::exception&) {  // Error and Errors
    return false;
  }
}

std::string component_text(const ClassInfo& info, const std::vector<std::string>& members) {
  return members.empty() ? info.name + " {}" : fmt::format("{} {{ {} }}", info.name, fmt::join(members, ", "));
}

}  // namespace

std::string new_component_text(const ClassInfo& info) {
  std::vector<std::string> members;
  for (const Member& member : info.members)
    if (member.required) members.push_back(member.name + ": " + required_text(member));
  const std::string text = component_text(info, members);
  if (can_be_prepared(text)) return text;
  for (const bool parts : {true, false}) {
    std::vector<std::string> more;
    bool points = false;  // only the first list of points is filled: others have times, or other positions
    for (const Member& member : info.members) {
      const std::string entries = entries_text(member);
      const bool again = member.kind == Kind::point3 && std::exchange(points, points || !entries.empty());
      if (!entries.empty() && (member.kind == Kind::component) == parts && !again)
        more.push_back(member.name + ": " + entries);
      else if (member.required)
        more.push_back(member.name + ": " + required_text(member));
    }
    if (const std::string filled = component_text(info, more); can_be_prepared(filled)) return filled;
  }
  // A list that accepts only some classes, such as the operands of a solid: tries the first class that works.
  for (const Member& list : info.members) {
    if (list.kind != Kind::component || entries_text(list).empty()) continue;
    for (const ClassInfo* entry : Registry::instance().subclasses(*Registry::instance().find(list.component_class))) {
      if (entry->abstract() || entry == &info) continue;
      const bool simple =
          std::none_of(entry->members.begin(), entry->members.end(), [](const Member& m) { return m.required; });
      if (!simple) continue;
      std::vector<std::string> more = members;
      std::erase_if(more, [&](const std::string& m) { return m.starts_with(list.name + ":"); });
      more.push_back(fmt::format("{}: [{} {{}}]", list.name, entry->name));
      if (const std::string filled = component_text(info, more); can_be_prepared(filled)) return filled;
    }
  }
  return text;  // adding it reports what is missing
}

void TextEditor::replace_class(const Ref<Component>& part, const ClassInfo& now) {
  if (now.abstract()) throw Error(fmt::format("{} is abstract: there is nothing of this class alone", now.name));
  const Node* written = node(*part);
  if (!written) {  // a default, or a plain value, is written out where it is used
    const Slot use = use_of(*part);
    set_value(use, written_out(*part));
    const Node* value = value_node(use);
    const Node* list = value && use.index ? outline_->resolve(*value) : nullptr;
    if (value) begins_[part.get()] = list ? outline_->entries(*list).items.at(*use.index).begin : value->begin;
    written = node(*part);
    if (!written) {  // it is still a plain value
      const Node* there = value_node(use);
      const std::string plain = there ? outline_->text({there->begin, there->end}) : "";
      const Member* literal = part->class_info().find(part->class_info().literal);
      const bool keeps = literal && fits(now, *literal, literal->get(*part, *literal));
      return set_value(use, keeps ? fmt::format("{} {{ {}: {} }}", now.name, literal->name, plain) : new_component_text(now));
    }
  }
  for (const Member& member : part->class_info().members)
    if (!fits(now, member, member.get(*part, member)) && Outline::member(*node(*part), member.name))
      set_text(without_member(*outline_, *node(*part), member.name));
  for (const Member& member : now.members)
    if (member.required && !Outline::member(*node(*part), member.name))
      set_text(with_member(*outline_, *node(*part), member.name, required_text(member)));
  const size_t begin = node(*part)->begin;
  set_text(with_span(*outline_, {begin, begin + part->class_info().name.size()}, now.name));
  begins_[part.get()] = begin;
}

std::string TextEditor::free_name(const std::string& stem) const {
  std::string name = stem;
  for (int i = 2; outline_->definition(name) || !outline_->uses(name).empty(); ++i) name = fmt::format("{}_{}", stem, i);
  return name;
}

std::string TextEditor::name_of(const Ref<Component>& part) {
  const Node* written = node(*part);
  for (const language::Definition& d : outline_->syntax().definitions)
    if (written && outline_->resolve(d.value) == written) return d.name.text;
  if (part->origin && !part->origin->name.empty() && !written) return part->origin->name;  // it is in an included file
  const std::string name = free_name(snake_case(part->class_info().name));
  const std::string whole = written_out(*part);
  std::unordered_map<const Component*, size_t> within;  // offsets from the beginning of the component
  size_t at = 0;
  if (written) {
    const Span gone{written->begin, written->end};
    at = gone.begin;
    for (const auto& [other, begin] : begins_)
      if (gone.contains(begin)) within.emplace(other, begin - gone.begin);
    set_text(with_span(*outline_, gone, name));
  } else {
    const Slot use = use_of(*part);
    set_value(use, name);
    if (const Node* value = value_node(use)) at = value->begin;
    within.emplace(part.get(), 0);
  }
  set_text(with_definition(*outline_, name, whole, at));
  if (const language::Definition* d = outline_->definition(name))
    for (const auto& [other, offset] : within) begins_[other] = d->value.begin + offset;
  return name;
}

void TextEditor::rename(const std::string& old, const std::string& now) {
  const language::Definition* d = outline_->definition(old);
  if (!d) throw Error(fmt::format("there is no name '{}' in this text", old));
  if (now == old) return;
  std::vector<Span> uses = outline_->uses(old);
  if (now.empty()) {
    if (uses.size() != 1)
      throw Error(fmt::format("'{}' is used {} times: what has no name can be used once", old, uses.size()));
    const std::string value = outline_->text({d->value.begin, d->value.end});
    const std::string whole = outline_->text();
    // The line of the definition is removed; a comment after it stays.
    size_t begin = whole.rfind('\n', d->name.begin);
    begin = begin == std::string::npos ? 0 : begin + 1;
    size_t end = d->value.end;
    while (end < whole.size() && (whole[end] == ' ' || whole[end] == '\t' || whole[end] == '\r' || whole[end] == ';')) ++end;
    if (end < whole.size() && whole[end] == '\n') ++end;
    const Span line{begin, end}, use = uses[0];
    if (use.begin > line.begin) {
      set_text(with_span(*outline_, use, value));
      set_text(with_span(*outline_, line, ""));
    } else {
      set_text(with_span(*outline_, line, ""));
      set_text(with_span(*outline_, use, value));
    }
    return;
  }
  if (!language::is_name(now)) throw Error(fmt::format("'{}' is no name: letters, digits and _, and no digit first", now));
  for (const char* reserved : {"true", "false", "none", "pi", "param", "include", "plugin"})
    if (now == reserved) throw Error(fmt::format("'{}' is reserved and cannot be a name", now));
  if (outline_->definition(now)) throw Error(fmt::format("'{}' is defined already", now));
  uses.push_back({d->name.begin, d->name.begin + old.size()});
  std::sort(uses.begin(), uses.end(), [](Span a, Span b) { return a.begin > b.begin; });
  for (const Span& s : uses) set_text(with_span(*outline_, s, now));
}

}  // namespace etendue::studio
