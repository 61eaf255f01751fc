// TextEditor: members and list entries in the text.

#include "text_editor.h"

#include <fmt/format.h>

#include "language/lexer.h"
#include "language/writer.h"

namespace etendue::studio {

using language::Node;
using language::NodeType;

namespace {

constexpr const char* stand_in = "x = ";

/// The text of a component with one member set, as a separate text.
std::string component_with(const std::string& component, const std::string& member, const std::string& value) {
  const Outline outline(stand_in + component, intern("component"));
  const language::Definition* d = outline.definition("x");
  if (!d || d->value.type != NodeType::component) throw Error("this part cannot be written as text");
  return with_member(outline, d->value, member, value).substr(std::string_view(stand_in).size());
}

std::string list_with_entry(const std::string& list, size_t index, const std::string& value) {
  const Outline outline(stand_in + list, intern("list"));
  const language::Definition* d = outline.definition("x");
  if (!d) throw Error("this list cannot be written as text");
  const Sequence all = outline.entries(d->value);
  if (index >= all.items.size()) throw Error(fmt::format("there is no entry {}: the list has {}", index, all.items.size()));
  return with_span(outline, all.items[index], value).substr(std::string_view(stand_in).size());
}

}  // namespace

Slot slot(const Ref<Component>& part, const std::string& member, std::optional<size_t> index) {
  const Member* found = part->class_info().find(member);
  if (!found) static_cast<void>(get(*part, member));  // throws Error with the list of members
  if (index && !found->list && found->kind != Kind::vector2 && found->kind != Kind::vector3 && found->kind != Kind::point3 &&
      found->kind != Kind::normal3)
    throw Error(fmt::format("{}.{} is no list: it has no entries", part->class_info().name, member));
  return {part, found, index};
}

TextEditor::TextEditor(const Document& document)
    : document_(document), outline_(std::make_unique<Outline>(document.text(), document.name())) {
  for (const Ref<Component>& part : document.components())
    if (const Node* written = document.written(*part)) begins_.emplace(part.get(), written->begin);
}

const Node* TextEditor::node(const Component& part) const {
  const auto begin = begins_.find(&part);
  if (begin == begins_.end()) return nullptr;
  const auto found = outline_->components().find(begin->second);
  return found == outline_->components().end() ? nullptr : found->second;
}

void TextEditor::set_text(std::string text) {
  const TextChange change = difference(outline_->text(), text);
  for (auto at = begins_.begin(); at != begins_.end();) {
    size_t& begin = at->second;
    const bool gone = begin >= change.begin && begin < change.end;
    if (begin >= change.end && begin >= change.begin) begin = begin - change.end + change.begin + change.insert.size();
    at = gone ? begins_.erase(at) : std::next(at);
  }
  outline_ = std::make_unique<Outline>(std::move(text), document_.name());
}

/// The only use of a component that has no text of its own.
Slot TextEditor::use_of(const Component& part) const {
  if (part.origin && part.origin->location.known() && part.origin->location.file != document_.name())
    throw Error(fmt::format("this {} is written in {}, which is included: it can be edited there", part.class_info().name,
                            part.origin->location.file));
  const auto& uses = document_.uses(part);
  if (uses.size() != 1)
    throw Error(fmt::format("this {} is used in {} places and written in none of them: write it out first",
                            part.class_info().name, uses.size()));
  return {document_.component(uses[0].holder), uses[0].member, uses[0].index};
}

const Node* TextEditor::value_node(const Slot& s) const {
  const Node* holder = node(*s.part);
  return holder ? Outline::member(*holder, s.member->name) : nullptr;
}

std::string TextEditor::default_text(const Slot& s) const {
  return language::Writer(false, document_.folder()).value(s.member->get(*s.part, *s.member), s.member, 0, 0);
}

std::string TextEditor::written(const Slot& s) const {
  const Node* value = value_node(s);
  if (!s.index) return value ? outline_->text({value->begin, value->end}) : default_text(s);
  if (const Node* list = value ? outline_->resolve(*value) : nullptr) {
    const Sequence all = outline_->entries(*list);
    if (*s.index < all.items.size()) return outline_->text(all.items[*s.index]);
  }
  const Value whole = s.member->get(*s.part, *s.member);
  if (const auto* list = whole.as<Value::List>(); list && *s.index < list->size())
    return language::Writer(false, document_.folder()).value((*list)[*s.index], s.member, 0, 0);
  throw Error(fmt::format("{} has no entry {}", s.member->name, *s.index));
}

std::string TextEditor::written_out(const Component& part) const {
  if (const Node* n = node(part)) return outline_->text({n->begin, n->end});
  return language::Writer(false, document_.folder()).value(Value(Ref<Component>(const_cast<Component*>(&part))), nullptr, 0, 0);
}

std::string TextEditor::name_in(const Slot& s) const {
  std::string text;
  try {
    text = written(s);
  } catch (const Error&) {
    return {};
  }
  return language::is_name(text) && outline_->definition(text) ? text : std::string();
}

void TextEditor::set(const Slot& s, const std::string& value) { set_value(s, lone_expression(value)); }

void TextEditor::set_value(const Slot& s, const std::string& value) {
  if (const Node* holder = node(*s.part)) {
    const Node* now = Outline::member(*holder, s.member->name);
    if (!s.index) return set_text(with_member(*outline_, *holder, s.member->name, value));
    if (!now)
      return set_text(with_member(*outline_, *holder, s.member->name, list_with_entry(default_text(s), *s.index, value)));
    const Node* list = outline_->resolve(*now);
    if (!list) throw Error("this list is written in another file, or by a name that is not in this text");
    const Sequence all = outline_->entries(*list);
    if (*s.index >= all.items.size())
      throw Error(fmt::format("there is no entry {}: the list has {}", *s.index, all.items.size()));
    return set_text(with_span(*outline_, all.items[*s.index], value));
  }
  // The component has no text of its own: it is a default or given by a plain value. It is written out where it is used.
  const Slot use = use_of(*s.part);
  const std::string& literal = s.part->class_info().literal;
  const Value held = use.member->get(*use.part, *use.member);
  const bool plain = literal == s.member->name && !s.index && value_node(use);
  const std::string entry = s.index ? list_with_entry(default_text(s), *s.index, value) : value;
  set_value(use, plain ? value : component_with(written_out(*s.part), s.member->name, entry));
  if (plain) return;
  const Node* now = value_node(use);
  if (now && use.index) {
    const Node* list = outline_->resolve(*now);
    const Sequence all = list ? outline_->entries(*list) : Sequence{};
    if (*use.index < all.items.size()) begins_[s.part.get()] = all.items[*use.index].begin;
  } else if (now) {
    begins_[s.part.get()] = now->begin;
  }
}

void TextEditor::reset(const Slot& s) {
  if (const Node* holder = node(*s.part)) set_text(without_member(*outline_, *holder, s.member->name));
}

void TextEditor::add(const Slot& s, std::optional<size_t> index, const std::string& value) {
  const std::string item = lone_expression(value);
  const Node* now = value_node(s);
  const Node* list = now ? outline_->resolve(*now) : nullptr;
  if (now && !list) throw Error("this list is written in another file, or by a name that is not in this text");
  if (!now) {
    const std::string before = default_text(s);
    if (before == "[]" || before == "none") return set_value(s, "[" + item + "]");
    const Outline mini(stand_in + before, intern("list"));
    const Sequence all = mini.entries(mini.definition("x")->value);
    return set_value(s, with_item(mini, all, std::min(index.value_or(all.items.size()), all.items.size()), item)
                            .substr(std::string_view(stand_in).size()));
  }
  if (list->type == NodeType::none) return set_value(s, "[" + item + "]");
  const Sequence all = outline_->entries(*list);
  if (index && *index > all.items.size())
    throw Error(fmt::format("there is no place {} in a list of {}", *index, all.items.size()));
  set_text(with_item(*outline_, all, index.value_or(all.items.size()), item));
}

void TextEditor::remove(const Slot& s) {
  const Node* now = value_node(s);
  const Node* list = now ? outline_->resolve(*now) : nullptr;
  if (!list) throw Error(fmt::format("the entries of {} are not written here", s.member->name));
  const Sequence all = outline_->entries(*list);
  if (!s.index || *s.index >= all.items.size())
    throw Error(fmt::format("there is no such entry: the list has {}", all.items.size()));
  set_text(without_item(*outline_, all, *s.index));
}

}  // namespace etendue::studio
