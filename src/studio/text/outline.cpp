#include "outline.h"

#include <algorithm>

#include "etendue/describe/registry.h"
#include "etendue/language/language.h"
#include "language/lexer.h"

namespace etendue::studio {

using language::Node;
using language::NodeType;

namespace {

std::uint64_t key(const Location& at) { return std::uint64_t(std::uint32_t(at.line)) << 32 | std::uint32_t(at.column); }

}  // namespace

Outline::Outline(std::string text, const char* name) : source_{name, {}, std::move(text)} {
  language::Diagnostics unheard;
  try {
    if (!language::invalid_utf8(source_.text)) syntax_ = language::parse_document(source_, unheard);
  } catch (const language::TooManyErrors&) {  // nothing can be found in this text
  }
  for (const language::Definition& d : syntax_.definitions) {
    definitions_.emplace(d.name.text, &d);
    note(d.value);
  }
  for (const Node& c : syntax_.components) note(c);
}

// Uses an explicit stack, since lists, chains and brackets may be long.
void Outline::note(const Node& root) {
  std::vector<const Node*> rest{&root};
  while (!rest.empty()) {
    const Node& node = *rest.back();
    rest.pop_back();
    if (node.type == NodeType::component && node.inside > 0) {
      by_place_.emplace(key(node.at), &node);
      by_begin_.emplace(node.begin, &node);
    }
    if (node.type == NodeType::name) uses_[node.text].push_back({node.begin, node.begin + node.text.size()});
    const ClassInfo* info = node.type == NodeType::component ? Registry::instance().find(node.text) : nullptr;
    for (size_t i = 0; i < node.children.size(); ++i) {
      const Node& child = node.children[i];
      const Member* member = info && i < node.labels.size() ? info->find(node.labels[i].text) : nullptr;
      // A choice is not a use of a name, even if a name equal to it is defined.
      const bool choice = member && member->kind == Kind::choice && child.type == NodeType::name &&
                          std::find(member->choices.begin(), member->choices.end(), child.text) != member->choices.end();
      if (!choice) rest.push_back(&child);
    }
  }
}

const Node* Outline::component(const Location& at) const {
  if (at.file != source_.name) return nullptr;
  const auto found = by_place_.find(key(at));
  return found == by_place_.end() ? nullptr : found->second;
}

const Node* Outline::member(const Node& component, const std::string& name) {
  for (size_t i = 0; i < component.labels.size() && i < component.children.size(); ++i)
    if (component.labels[i].text == name) return &component.children[i];
  return nullptr;
}

Span Outline::member_span(const Node& component, size_t index) {
  return {component.labels[index].begin, component.children[index].end};
}

const language::Definition* Outline::definition(const std::string& name) const {
  const auto found = definitions_.find(name);
  return found == definitions_.end() ? nullptr : found->second;
}

const Node* Outline::resolve(const Node& node) const {
  const Node* at = &node;
  for (size_t steps = 0; at && at->type == NodeType::name; ++steps) {
    const language::Definition* d = definition(at->text);
    if (!d || steps > definitions_.size()) return nullptr;
    at = &d->value;
  }
  return at;
}

std::vector<Span> Outline::uses(const std::string& name) const {
  const auto found = uses_.find(name);
  return found == uses_.end() ? std::vector<Span>{} : found->second;
}

Sequence Outline::members(const Node& component) const {
  Sequence all{{component.inside, component.end - 1}, {}};
  for (size_t i = 0; i < component.children.size(); ++i) all.items.push_back(member_span(component, i));
  return all;
}

Sequence Outline::entries(const Node& written) const {
  // In [1, 2] mm the unit applies to all entries.
  const Node& list = written.type == NodeType::unit ? written.children.front() : written;
  // The list may be in brackets or have a unit: only a plain list has entries that can be edited.
  const bool plain = list.end > list.begin + 1 && source_.text[list.begin] == '[' && source_.text[list.end - 1] == ']';
  if (!plain || (list.type != NodeType::list && list.type != NodeType::numbers))
    throw Error("what is written there is no list whose entries could be edited: edit the whole value");
  Sequence all{{list.begin + 1, list.end - 1}, {}};
  if (list.type == NodeType::list) {
    for (const Node& child : list.children) all.items.push_back({child.begin, child.end});
    return all;
  }
  // Packed numbers have no nodes: their positions are found with the lexer.
  language::Diagnostics unheard;
  language::Lexer lexer(source_, unheard, all.inside.begin);
  int depth = 0;
  bool fresh = true;  // the next token begins an entry
  for (language::Token token = lexer.next(); token.end <= all.inside.end && token.type != language::TokenType::end;
       token = lexer.next()) {
    if (depth == 0 && token.is(',')) {
      fresh = true;
      continue;
    }
    if (depth == 0 && (fresh || token.first_in_line)) all.items.push_back({token.begin, token.end});
    fresh = false;
    if (token.is('[')) ++depth;
    if (token.is(']')) --depth;
    all.items.back().end = token.end;
  }
  return all;
}

}  // namespace etendue::studio
