#include "group_description.h"

#include <fmt/format.h>

#include <cstdlib>

namespace etendue::osl {
namespace {

/// The words of the text form. '#' and '//' begin comments.
class GroupReader {
 public:
  GroupReader(std::string_view text, const std::string& file) : text_(text), file_(intern(file)) {}

  GroupDescription read() {
    GroupDescription group;
    std::vector<ParameterText> pending;
    for (std::string word = next(); !word.empty(); word = next()) {
      const Location at = start_;
      if (ends_statement(word)) continue;
      if (word == "param" || word == "parameter")
        pending.push_back(parameter(at));
      else if (word == "shader") {
        std::string shader = needed("the shader's name"), layer = next();
        if (ends_statement(layer) && !quoted_)
          layer = fmt::format("{}_{}", shader, group.layers.size());
        else
          finish();
        group.layers.push_back({std::move(shader), std::move(layer), std::move(pending), at});
        pending.clear();
      } else if (word == "connect") {
        ConnectionText connection;
        std::tie(connection.from_layer, connection.from) = end_of_connection();
        std::tie(connection.to_layer, connection.to) = end_of_connection();
        connection.at = at;
        finish();
        group.connections.push_back(std::move(connection));
      } else {
        throw Error(fmt::format("'{}' begins no statement of a shader group; 'param', 'shader' and 'connect' do", word), at);
      }
    }
    return group;
  }

 private:
  static bool ends_statement(const std::string& word) { return word == ";" || word == ","; }

  ParameterText parameter(Location at) {
    ParameterText result;
    result.at = at;
    result.type = needed("the parameter's type");
    result.name = needed("the parameter's name");
    // "color [2]" is a type as well.
    if (result.name.starts_with('[')) result.type += std::exchange(result.name, needed("the parameter's name"));
    for (std::string word = next(); !ends_statement(word) || quoted_; word = next()) {
      if (word.empty() && !quoted_) throw Error(fmt::format("the value of '{}' has no end", result.name), at);
      if (word == "[[" && !quoted_) {
        hints(result);
        break;
      }
      result.words.push_back(std::move(word));
    }
    return result;
  }

  /// "[[ int lockgeom=0, ... ]]". Other hints do not change what a shader computes.
  void hints(ParameterText& parameter) {
    std::string text;
    for (std::string word = next(); word != "]]"; word = next()) {
      if (word.empty()) throw Error("'[[' without ']]'", parameter.at);
      text += word;
    }
    parameter.interpolated = text.find("lockgeom=0") != std::string::npos || text.find("interpolated=1") != std::string::npos;
    finish();
  }

  std::pair<std::string, std::string> end_of_connection() {
    const std::string word = needed("a layer and its parameter, as in 'layer.parameter'");
    const size_t dot = word.find('.');
    if (dot == std::string::npos || dot == 0 || dot + 1 == word.size())
      throw Error(fmt::format("'{}' is not a layer and its parameter, as in 'layer.parameter'", word), start_);
    return {word.substr(0, dot), word.substr(dot + 1)};
  }

  void finish() {
    const std::string word = next();
    if (!word.empty() && !ends_statement(word)) throw Error(fmt::format("expected ';', not '{}'", word), start_);
  }

  std::string needed(const char* what) {
    std::string word = next();
    if ((word.empty() || ends_statement(word)) && !quoted_) throw Error(fmt::format("expected {}", what), start_);
    return word;
  }

  /// The next word, empty at the end of the text.
  std::string next() {
    quoted_ = false;
    skip_blanks();
    start_ = {file_, line_, column()};
    if (at_ >= text_.size()) return {};
    const char c = text_[at_];
    if (c == '"') return quoted();
    if (c == ';' || c == ',') return std::string(1, text_[at_++]);
    for (const char* bracket : {"[[", "]]"})
      if (text_.substr(at_, 2) == bracket) return at_ += 2, bracket;
    const size_t begin = at_;
    while (at_ < text_.size() && !std::isspace(static_cast<unsigned char>(text_[at_])) && text_[at_] != ';' &&
           text_[at_] != ',' && text_[at_] != '"' && text_.substr(at_, 2) != "[[" && text_.substr(at_, 2) != "]]")
      ++at_;
    return std::string(text_.substr(begin, at_ - begin));
  }

  std::string quoted() {
    quoted_ = true;
    std::string result;
    for (++at_; at_ < text_.size() && text_[at_] != '"'; ++at_) {
      char c = text_[at_];
      if (c == '\n') break;
      if (c == '\\' && at_ + 1 < text_.size()) {
        c = text_[++at_];
        c = c == 'n' ? '\n' : c == 't' ? '\t' : c;
      }
      result += c;
    }
    if (at_ >= text_.size() || text_[at_] != '"') throw Error("a text without its closing quotation mark", start_);
    ++at_;
    return result;
  }

  void skip_blanks() {
    while (at_ < text_.size()) {
      if (text_[at_] == '\n')
        ++line_, line_start_ = ++at_;
      else if (std::isspace(static_cast<unsigned char>(text_[at_])))
        ++at_;
      else if (text_[at_] == '#' || text_.substr(at_, 2) == "//")
        at_ = std::min(text_.find('\n', at_), text_.size());
      else
        break;
    }
  }

  int column() const { return int(at_ - line_start_) + 1; }

  std::string_view text_;
  const char* file_;
  size_t at_ = 0, line_start_ = 0;
  int line_ = 1;
  bool quoted_ = false;
  Location start_;
};

bool is_number(const std::string& word, bool whole) {
  if (word.empty()) return false;
  char* end = nullptr;
  whole ? void(std::strtol(word.c_str(), &end, 10)) : void(std::strtof(word.c_str(), &end));
  return *end == 0 || (!whole && std::string_view(end) == "f");
}

}  // namespace

GroupDescription parse_group(std::string_view text, const std::string& file) { return GroupReader(text, file).read(); }

std::string infer_type(std::vector<std::string>& words) {
  if (words.size() != 1) return "string";
  const std::string word = words[0];
  if (is_number(word, true)) return "int";
  if (is_number(word, false)) return "float";
  std::vector<std::string> parts;
  for (size_t begin = 0; begin <= word.size();) {
    const size_t comma = std::min(word.find(',', begin), word.size());
    parts.push_back(word.substr(begin, comma - begin));
    if (!is_number(parts.back(), false)) return "string";
    begin = comma + 1;
  }
  if (parts.size() != 3 && parts.size() != 16) return "string";
  words = parts;
  return words.size() == 3 ? "color" : "matrix";
}

}  // namespace etendue::osl
