#pragma once
// The locations of the tokens in a JSON text.

#include <nlohmann/json.hpp>
#include <string>

#include "source.h"

namespace etendue::language {

/// Advances through a text token by token, in step with the events of a JSON parser; commas and colons are skipped.
class JsonPlaces {
 public:
  explicit JsonPlaces(const Source& source);

  /// Advances past the next token; returns its location.
  Location next();
  /// The text of the last token.
  std::string_view written() const { return std::string_view(text_).substr(begin_, position_ - begin_); }
  /// The location of a byte.
  static Location place(const Source&, size_t byte);

 private:
  void step();

  const char* name_;
  const std::string& text_;
  size_t begin_ = 0, position_ = 0;
  int line_ = 1, column_ = 1;
};

/// The path from the root of a JSON text to the parser's current position.
class JsonPath {
 public:
  void key(const std::string& name) { parts_.back().name = name; }
  void open(bool list) { parts_.push_back({list, 0, {}}); }
  void close() { parts_.pop_back(); }
  /// Called after a value: in a list the index advances.
  void passed() {
    if (!parts_.empty()) ++parts_.back().entry;
  }
  std::string text() const;

 private:
  struct Part {
    bool list;
    size_t entry;
    std::string name;
  };
  std::vector<Part> parts_;
};

}  // namespace etendue::language
