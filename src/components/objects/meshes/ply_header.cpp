#include "ply_header.h"

#include <bit>
#include <charconv>
#include <optional>

#include "etendue/core/error.h"
#include "etendue/describe/component.h"

namespace etendue::ply {
namespace {

std::optional<Type> find_type(std::string_view name) {
  constexpr std::string_view names[] = {"int8", "uint8", "int16", "uint16", "int32", "uint32", "float32", "float64",
                                        "char", "uchar", "short", "ushort", "int",   "uint",   "float",   "double"};
  for (size_t i = 0; i < 16; ++i)
    if (names[i] == name) return Type(i % 8);
  return {};
}

}  // namespace

size_t size_of(Type t) {
  constexpr size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[size_t(t)];
}

std::string shown(std::string_view s) {
  std::string t(s.substr(0, 40));
  for (char& c : t)
    if (c < 32 || c > 126) c = '?';
  return "'" + t + "'";
}

Header read_header(std::string_view file) {
  Header header;
  size_t at = 0;
  bool format_known = false;
  for (int line_number = 1;; ++line_number) {
    const auto fail = [&](const std::string& message) { throw Error("line " + std::to_string(line_number) + ": " + message); };
    if (at >= file.size()) fail("the file ends within the header");
    size_t end = file.find('\n', at);
    if (end == std::string_view::npos) end = file.size();
    std::string_view line = file.substr(at, std::min<size_t>(end - at, 4096));
    at = std::min(end + 1, file.size());
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    std::vector<std::string_view> words;
    for (size_t i = 0; i < line.size();) {
      const size_t begin = line.find_first_not_of(" \t", i);
      if (begin == std::string_view::npos) break;
      const size_t stop = std::min(line.find_first_of(" \t", begin), line.size());
      words.push_back(line.substr(begin, stop - begin));
      i = stop;
    }
    if (line_number == 1) {
      if (words.size() != 1 || words[0] != "ply") fail("a PLY file must begin with 'ply'");
      continue;
    }
    if (words.size() > 2 && words[0] == "comment" && words[1] == "TextureFile" && header.texture.empty())
      header.texture = line.substr(size_t(words[2].data() - line.data()));
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") break;
    if (words[0] == "format") {
      const std::string_view kind = words.size() > 1 ? words[1] : "";
      header.text = kind == "ascii";
      header.swap = kind == (std::endian::native == std::endian::little ? "binary_big_endian" : "binary_little_endian");
      if (!header.text && kind != "binary_little_endian" && kind != "binary_big_endian") fail("unknown format " + shown(kind));
      format_known = true;
    } else if (words[0] == "element") {
      Element element;
      if (words.size() != 3) fail("an element needs a name and a count");
      element.name = words[1];
      const auto [stop, code] = std::from_chars(words[2].data(), words[2].data() + words[2].size(), element.count);
      if (code != std::errc() || stop != words[2].data() + words[2].size())
        fail("no valid count of " + shown(words[1]) + ": " + shown(words[2]));
      for (const Element& other : header.elements)
        if (other.name == element.name) fail("element " + shown(words[1]) + " is declared twice");
      header.elements.push_back(std::move(element));
    } else if (words[0] == "property") {
      if (header.elements.empty()) fail("a property before any element");
      Property property;
      property.list = words.size() == 5 && words[1] == "list";
      if (!property.list && words.size() != 3) fail("a property needs a type and a name");
      const std::optional<Type> type = find_type(words[property.list ? 3 : 1]);
      const std::optional<Type> count = property.list ? find_type(words[2]) : Type::uint8;
      if (!type || !count) fail("unknown type in property " + shown(words.back()));
      if (property.list && (*count == Type::float32 || *count == Type::float64))
        fail("the length of a list must be an integer");
      property.type = *type;
      property.count_type = *count;
      property.name = words.back();
      header.elements.back().properties.push_back(std::move(property));
    } else if (format_known && header.elements.empty()) {
      warn("a PLY file's header has a line that begins with " + shown(words[0]) +
           ", which says nothing here: it is passed over");
    } else {
      fail("unknown header word " + shown(words[0]));
    }
  }
  if (!format_known) throw Error("the header names no format");
  header.size = at;
  return header;
}

}  // namespace etendue::ply
