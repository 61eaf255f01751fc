#pragma once
// Outline: a description's text, and the positions of its components. Positions are in bytes; src/studio/text/places.h converts
// to the units of browsers.

#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "language/syntax.h"

namespace etendue::studio {

/// Bytes [begin, end) of a text.
struct Span {
  size_t begin = 0, end = 0;
  size_t size() const { return end - begin; }
  bool contains(size_t at) const { return at >= begin && at < end; }
};

/// The contents of brackets, separated by commas or new lines: members of a component, entries of a list.
struct Sequence {
  Span inside;  ///< between the brackets
  std::vector<Span> items;
};

/// A text with its syntax. Parts that cannot be parsed are left out, so that a text with errors still has an outline.
class Outline {
 public:
  /// `name` is the name of the text in locations; interned.
  Outline(std::string text, const char* name);

  const std::string& text() const { return source_.text; }
  const char* name() const { return source_.name; }
  const language::Document& syntax() const { return syntax_; }

  /// The component whose class name is at a location; null if there is none in this text.
  const language::Node* component(const Location&) const;
  /// All components, by the position where they begin.
  const std::map<size_t, const language::Node*>& components() const { return by_begin_; }
  /// The byte position of a component's class name.
  static size_t begin(const language::Node& component) { return component.begin; }

  /// The written value of a member; null if it is not written.
  static const language::Node* member(const language::Node& component, const std::string& name);
  /// The position of "member: value".
  static Span member_span(const language::Node& component, size_t index);
  const language::Definition* definition(const std::string& name) const;
  /// The value itself; names are followed through all definitions. Null if a name is not defined in this text.
  const language::Node* resolve(const language::Node&) const;
  /// All uses of a name, except its definition.
  std::vector<Span> uses(const std::string& name) const;

  Sequence members(const language::Node& component) const;
  /// The entries of a list. Throws Error if the value is not a plain list.
  Sequence entries(const language::Node& list) const;
  std::string text(Span s) const { return source_.text.substr(s.begin, s.size()); }

 private:
  void note(const language::Node&);
  language::Source source_;
  language::Document syntax_;
  std::unordered_map<std::uint64_t, const language::Node*> by_place_;
  std::map<size_t, const language::Node*> by_begin_;
  std::unordered_map<std::string, const language::Definition*> definitions_;
  std::unordered_map<std::string, std::vector<Span>> uses_;
};

}  // namespace etendue::studio
