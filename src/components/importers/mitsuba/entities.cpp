#include "entities.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

namespace etendue::mitsuba {

namespace {

constexpr size_t deepest = 16;             // nesting of entities in entities
constexpr size_t most = size_t(64) << 20;  // [bytes] added by all expansions: sizes can double with each declaration
constexpr std::string_view blanks = " \t\r\n";

using Entities = std::map<std::string, std::string, std::less<>>;

/// Reads the declarations of a document type: <!DOCTYPE scene [ <!ENTITY name "value"> … ]>.
class Declarations {
 public:
  explicit Declarations(std::string_view text) : text_(text) {}

  /// Returns the offset behind the document type; npos: there is none, or it declares no entities.
  size_t read(Entities& entities) {
    at_ = text_.find("<!DOCTYPE");
    if (at_ == text_.npos) return at_;
    const size_t open = text_.find_first_of("[>", at_);
    if (open == text_.npos || text_[open] == '>') return text_.npos;
    for (at_ = open + 1;;) {
      at_ = text_.find_first_not_of(blanks, at_);
      if (at_ == text_.npos) return at_;
      if (text_[at_] == ']') break;
      const std::string_view rest = text_.substr(at_);
      if (rest.starts_with("<!ENTITY"))
        entity(entities);
      else if (rest.starts_with("<!--"))
        skip_behind("-->");
      else
        skip_behind(">");
      if (at_ == text_.npos) return at_;
    }
    const size_t end = text_.find('>', at_);
    return end == text_.npos || entities.empty() ? text_.npos : end + 1;
  }
  size_t first = std::string_view::npos;  ///< offset of the first declaration

 private:
  void skip_behind(std::string_view end) {
    at_ = text_.find(end, at_);
    if (at_ != text_.npos) at_ += end.size();
  }

  std::string_view word() {
    at_ = std::min(text_.find_first_not_of(blanks, at_), text_.size());
    const size_t begin = at_;
    at_ = std::min(text_.find_first_of(" \t\r\n>\"'", at_), text_.size());
    return text_.substr(begin, at_ - begin);
  }

  void entity(Entities& entities) {
    const size_t begin = at_;
    first = std::min(first, begin);
    at_ += std::string_view("<!ENTITY").size();
    const std::string name(word());
    if (name == "%") throw EntityError("entities of the document type itself (<!ENTITY % …>) are not read", begin);
    const size_t value = text_.find_first_not_of(blanks, at_);
    if (value == text_.npos || (text_[value] != '"' && text_[value] != '\''))
      throw EntityError(
          fmt::format("the entity '{}' stands for another file, or for nothing: entities that are texts are read, "
                      "and files by <include>",
                      name),
          begin);
    const size_t end = text_.find(text_[value], value + 1);
    if (end == text_.npos) throw EntityError(fmt::format("the text of the entity '{}' has no end", name), begin);
    entities.emplace(name, std::string(text_.substr(value + 1, end - value - 1)));  // the first of a name counts
    at_ = end + 1;
    skip_behind(">");
  }

  std::string_view text_;
  size_t at_ = 0;
};

/// Replaces entity references by their texts.
class Expander {
 public:
  Expander(const Entities& entities, ExpandedText& to) : entities_(entities), to_(to) {}

  void document(std::string_view text, size_t from) {
    to_.text = text.substr(0, from);
    to_.expansions.push_back({0, 0, false});
    size_t done = from;
    for (size_t at = from; at < text.size();) {
      if (const size_t end = passed_over(text, at); end != at) {
        at = end;
        continue;
      }
      note_tag(text[at]);
      const std::string* value = text[at] == '&' ? find(text, at) : nullptr;
      if (!value) {
        ++at;
        continue;
      }
      to_.text.append(text.substr(done, at - done));
      to_.expansions.push_back({to_.text.size(), at, true});
      written_ = at;
      put(*value, 0);
      at = done = text.find(';', at) + 1;
      to_.expansions.push_back({to_.text.size(), at, false});
    }
    to_.text.append(text.substr(done));
  }

 private:
  /// The offset behind a comment or CDATA section that begins at `at`, where entities are not expanded; else `at`.
  static size_t passed_over(std::string_view text, size_t at) {
    constexpr std::pair<std::string_view, std::string_view> without[] = {{"<!--", "-->"}, {"<![CDATA[", "]]>"}};
    for (const auto& [begin, end] : without)
      if (text.substr(at).starts_with(begin)) return std::min(text.find(end, at), text.size());
    return at;
  }

  /// Tracks whether the position is inside a quoted attribute value; quotes that come from an entity do not end it.
  void note_tag(char c) {
    if (quote_ != 0)
      quote_ = c == quote_ ? '\0' : quote_;
    else if (in_tag_ && (c == '"' || c == '\''))
      quote_ = c;
    else if (c == '<' || c == '>')
      in_tag_ = c == '<';
  }

  const std::string* find(std::string_view text, size_t at) const {
    const size_t end = text.find(';', at);
    if (end == text.npos) return nullptr;
    const auto found = entities_.find(text.substr(at + 1, end - at - 1));
    return found == entities_.end() ? nullptr : &found->second;
  }

  void put(std::string_view value, size_t depth) {
    if (depth == deepest) throw EntityError(fmt::format("entities name one another more than {} deep", deepest), written_);
    for (size_t at = 0; at < value.size();) {
      if (const std::string* inner = value[at] == '&' ? find(value, at) : nullptr) {
        put(*inner, depth + 1);
        at = value.find(';', at) + 1;
        continue;
      }
      if (quote_ != 0 && value[at] == quote_)
        to_.text += quote_ == '"' ? "&quot;" : "&apos;";
      else
        to_.text += value[at];
      if (++added_ > most)
        throw EntityError(fmt::format("the entities of this file amount to more than {} MB", most >> 20), written_);
      ++at;
    }
  }

  const Entities& entities_;
  ExpandedText& to_;
  size_t written_ = 0, added_ = 0;
  bool in_tag_ = false;
  char quote_ = 0;
};

}  // namespace

std::optional<ExpandedText> expand_entities(std::string_view text) {
  Entities entities;
  Declarations declarations(text);
  const size_t end = declarations.read(entities);
  if (end == text.npos) return std::nullopt;
  ExpandedText expanded;
  expanded.declared = declarations.first;
  Expander(entities, expanded).document(text, end);
  return expanded;
}

size_t written_at(const std::vector<Expansion>& expansions, size_t offset) {
  const auto next = std::ranges::upper_bound(expansions, offset, {}, &Expansion::begin);
  if (next == expansions.begin()) return offset;
  const Expansion& e = *std::prev(next);
  return e.whole ? e.written : e.written + (offset - e.begin);
}

}  // namespace etendue::mitsuba
