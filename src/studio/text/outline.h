#pragma once
// A description's text, and where its parts stand in it. Places are bytes; src/studio/text/places.h counts as browsers do.

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

/// What stands between brackets and is separated by commas or new lines: members of a component, entries of a list.
struct Sequence {
  Span inside;  ///< between the brackets
  std::vector<Span> items;
};

/// A text with its syntax. What cannot be read is left out, so that an outline of a wrong text serves as far as it goes.
class Outline {
 public:
  /// `name` stands for the text in the places of its parts; interned.
  Outline(std::string text, const char* name);

  const std::string& text() const { return source_.text; }
  const char* name() const { return source_.name; }
  const language::Document& syntax() const { return syntax_; }

  /// The component whose class name stands at a place; null when there is none in this text.
  const language::Node* component(const Location&) const;
  /// All components, by where they begin.
  const std::map<size_t, const language::Node*>& components() const { return by_begin_; }
  /// The byte where a component's class name stands.
  static size_t begin(const language::Node& component) { return component.begin; }

  /// The value of a member as it is written; null when it is not.
  static const language::Node* member(const language::Node& component, const std::string& name);
  /// Where "member: value" stands.
  static Span member_span(const language::Node& component, size_t index);
  const language::Definition* definition(const std::string& name) const;
  /// The value itself when it is a name, however often that leads to another; null when it leads out of this text.
  const language::Node* resolve(const language::Node&) const;
  /// All places where a name is used, its definition aside.
  std::vector<Span> uses(const std::string& name) const;

  Sequence members(const language::Node& component) const;
  /// Of a list. Throws Error when it is none.
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
