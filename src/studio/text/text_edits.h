#pragma once
// Edits of a description's text that change what they must and leave comments and layout elsewhere as they are.

#include <string>

#include "outline.h"

namespace etendue::studio {

/// One replacement: the bytes [begin, end) become `insert`.
struct TextChange {
  size_t begin = 0, end = 0;
  std::string insert;
};

/// The smallest single replacement that makes one text the other: what is the same at the begin and at the end stays. It never
/// parts the bytes of a character.
TextChange difference(const std::string& before, const std::string& after);
std::string applied_to(const std::string& text, const TextChange&);

/// An expression without blanks and comments around it. Throws Errors when it is none by itself, so that nothing but the value
/// of a member changes, whatever was typed.
std::string lone_expression(const std::string& text);

// Each gives the whole text as it is to be.

/// Sets a member of a component, written or not.
std::string with_member(const Outline&, const language::Node& component, const std::string& member, const std::string& value);
/// Without a member; as it was when it is not written.
std::string without_member(const Outline&, const language::Node& component, const std::string& member);
/// With an item before the one at `index`, or behind the last.
std::string with_item(const Outline&, const Sequence&, size_t index, const std::string& item);
std::string without_item(const Outline&, const Sequence&, size_t index);
/// With other bytes at a place.
std::string with_span(const Outline&, Span, const std::string& insert);
/// With a definition before the statement in which `before` stands: on a line of its own, below comments that belong to none.
std::string with_definition(const Outline&, const std::string& name, const std::string& value, size_t before);

}  // namespace etendue::studio
