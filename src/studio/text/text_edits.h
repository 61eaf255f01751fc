#pragma once
// Edits of a description's text that change only what is necessary, and keep comments and layout elsewhere.

#include <string>

#include "outline.h"

namespace etendue::studio {

/// A replacement of the bytes [begin, end) by `insert`.
struct TextChange {
  size_t begin = 0, end = 0;
  std::string insert;
};

/// The smallest single replacement that turns one text into the other: the common beginning and end are kept. It never splits a
/// character.
TextChange difference(const std::string& before, const std::string& after);
std::string applied_to(const std::string& text, const TextChange&);

/// An expression without surrounding blanks and comments. Throws Errors if the text is not exactly one expression, so that
/// typed text can only change the value of a member.
std::string lone_expression(const std::string& text);

// Each function returns the whole new text.

/// Sets a member of a component, whether it is written or not.
std::string with_member(const Outline&, const language::Node& component, const std::string& member, const std::string& value);
/// Removes a member; the text is unchanged if the member is not written.
std::string without_member(const Outline&, const language::Node& component, const std::string& member);
/// Inserts an item before the one at `index`, or after the last.
std::string with_item(const Outline&, const Sequence&, size_t index, const std::string& item);
std::string without_item(const Outline&, const Sequence&, size_t index);
/// Replaces the bytes of a span.
std::string with_span(const Outline&, Span, const std::string& insert);
/// Inserts a definition before the statement that contains `before`: on a line of its own, after comments that precede the
/// statement.
std::string with_definition(const Outline&, const std::string& name, const std::string& value, size_t before);

}  // namespace etendue::studio
