#pragma once
// Where the tokens of a JSON text are.

#include <nlohmann/json.hpp>
#include <string>

#include "source.h"

namespace etendue::language {

/// Walks over a text from token to token, as a parser tells of them in order; commas and colons go by unasked.
class JsonPlaces {
 public:
  explicit JsonPlaces(const Source& source);

  /// Goes on to the next token and behind it; gives its place.
  Location next();
  /// The last token, as it is written.
  std::string_view written() const { return std::string_view(text_).substr(begin_, position_ - begin_); }
  /// The place of a byte.
  static Location place(const Source&, size_t byte);

 private:
  void step();

  const char* name_;
  const std::string& text_;
  size_t begin_ = 0, position_ = 0;
  int line_ = 1, column_ = 1;
};

/// Names the way from the root of a JSON text to where a parser is.
class JsonPath {
 public:
  void key(const std::string& name) { parts_.back().name = name; }
  void open(bool list) { parts_.push_back({list, 0, {}}); }
  void close() { parts_.pop_back(); }
  /// Behind a value: in a list the next one is the next entry.
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
