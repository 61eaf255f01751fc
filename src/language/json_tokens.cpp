#include "json_tokens.h"

#include <fmt/format.h>

#include "json.h"

namespace etendue::language {

namespace {

bool continues_character(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

}  // namespace

JsonPlaces::JsonPlaces(const Source& source) : name_(source.name), text_(source.text) {
  if (text_.starts_with("\xEF\xBB\xBF")) position_ = 3;  // a byte order mark is not a character
}

void JsonPlaces::step() {
  const char c = text_[position_++];
  if (c == '\n') {
    ++line_;
    column_ = 1;
  } else if (!continues_character(c)) {
    ++column_;
  }
}

Location JsonPlaces::next() {
  while (position_ < text_.size() && std::string_view(" \t\r\n,:").find(text_[position_]) != std::string_view::npos) step();
  const Location at{name_, line_, column_};
  begin_ = position_;
  if (position_ >= text_.size()) return at;
  const char first = text_[position_];
  step();
  if (first == '"') {
    while (position_ < text_.size() && text_[position_] != '"') {
      if (text_[position_] == '\\') step();
      if (position_ < text_.size()) step();
    }
    if (position_ < text_.size()) step();
  } else if (std::string_view("{}[]").find(first) == std::string_view::npos) {
    while (position_ < text_.size() && std::string_view(" \t\r\n,:{}[]\"").find(text_[position_]) == std::string_view::npos)
      step();
  }
  return at;
}

Location JsonPlaces::place(const Source& source, size_t byte) {
  Location at{source.name, 1, 1};
  for (size_t i = source.text.starts_with("\xEF\xBB\xBF") ? 3 : 0; i < byte && i < source.text.size(); ++i) {
    if (source.text[i] == '\n') {
      ++at.line;
      at.column = 1;
    } else if (!continues_character(source.text[i])) {
      ++at.column;
    }
  }
  return at;
}

std::string JsonPath::text() const {
  std::string text;
  for (const Part& part : parts_) {
    if (part.list)
      text += fmt::format("[{}]", part.entry);
    else if (!part.name.empty())
      text += (text.empty() ? "" : ".") + part.name;
  }
  return text;
}

bool is_json(std::string_view name) { return name.ends_with(".json") || name.ends_with(".JSON"); }

namespace {

/// Stops at the first token that does not end before a location.
class PathFinder : public nlohmann::json_sax<nlohmann::json> {
 public:
  PathFinder(const Source& source, const Location& wanted) : places_(source), wanted_(wanted) {}

  bool null() override { return value(); }
  bool boolean(bool) override { return value(); }
  bool number_integer(number_integer_t) override { return value(); }
  bool number_unsigned(number_unsigned_t) override { return value(); }
  bool number_float(number_float_t, const string_t&) override { return value(); }
  bool string(string_t&) override { return value(); }
  bool binary(binary_t&) override { return value(); }
  bool start_object(size_t) override { return open(false); }
  bool start_array(size_t) override { return open(true); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t& name) override {
    const Location at = places_.next();
    path_.key(name);
    return before(at);
  }
  bool parse_error(size_t, const std::string&, const nlohmann::json::exception&) override { return false; }

  std::string path() const { return path_.text(); }

 private:
  /// Whether the token ends before the location.
  bool before(const Location& at) {
    const int end = at.column + int(places_.written().size());
    return at.line < wanted_.line || (at.line == wanted_.line && end <= wanted_.column);
  }
  bool value() {
    const bool on = before(places_.next());
    if (on) path_.passed();
    return on;
  }
  bool open(bool list) {
    const bool on = before(places_.next());
    if (on) path_.open(list);
    return on;
  }
  bool close() {
    if (!before(places_.next())) return false;
    path_.close();
    path_.passed();
    return true;
  }

  JsonPlaces places_;
  Location wanted_;
  JsonPath path_;
};

}  // namespace

std::string json_path(const std::string& text, const Location& at) {
  const Source source{at.file, {}, text};
  PathFinder finder(source, at);
  nlohmann::json::sax_parse(text, &finder);
  return finder.path();
}

}  // namespace etendue::language
