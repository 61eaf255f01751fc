// Stated values of parameters, and their parts.

#include <fmt/format.h>

#include <cstdlib>
#include <cstring>

#include "group_builder.h"
#include "osl/values/interned_string.h"

namespace etendue::osl {
namespace {

/// "color[3]" as a type; void if it is none.
Type parse_type(std::string text) {
  std::erase(text, ' ');
  int array = 0;
  if (const size_t bracket = text.find('['); bracket != std::string::npos) {
    array = text.substr(bracket) == "[]" ? Type::unsized : std::atoi(text.c_str() + bracket + 1);
    if (array == 0) return {};
    text.resize(bracket);
  }
  static constexpr std::pair<const char*, Base> names[] = {
      {"int", Base::int_},      {"float", Base::float_},  {"color", Base::color},   {"point", Base::point},
      {"vector", Base::vector}, {"normal", Base::normal}, {"matrix", Base::matrix}, {"string", Base::string}};
  for (const auto& [name, base] : names)
    if (text == name) return {base, array};
  return {};
}

std::string wrong_type(const std::string& name, const std::string& expected, const std::string& given) {
  return fmt::format("attempting to set parameter with wrong type: {} (expected '{}', received '{}')", name, expected, given);
}

bool same_kind(const Type& a, const Type& b) { return a.base == b.base || (a.triple_based() && b.triple_based()); }

}  // namespace

bool find_part(const Shader& shader, const std::string& path, const std::function<Type(const Symbol&)>& whole,
               ParameterPart& out, std::string& reason) {
  const size_t end = std::min(path.find_first_of(".["), path.size());
  const std::string name = path.substr(0, end);
  out.symbol = shader.find_parameter(name);
  if (!out.symbol)
    return reason = fmt::format("\"{}\" is not a parameter or global of shader \"{}\"", name, shader.name), false;
  out.offset = 0;
  out.type = whole(*out.symbol);
  for (size_t at = end; at < path.size();) {
    if (path[at] == '.') {
      const size_t stop = std::min(path.find_first_of(".[", at + 1), path.size());
      const std::string field_name = path.substr(at + 1, stop - at - 1);
      const Field* field = out.type.is_structure() && !out.type.is_array() ? out.type.structure->find(field_name) : nullptr;
      if (!field) return reason = fmt::format("'{}' has no field '{}'", path.substr(0, at), field_name), false;
      out.offset += std::uint32_t(field->offset);
      out.type = field->type;
      at = stop;
      continue;
    }
    const size_t close = path.find(']', at);
    if (close == std::string::npos) return reason = fmt::format("'{}' has '[' without ']'", path), false;
    const int index = std::atoi(path.substr(at + 1, close - at - 1).c_str());
    const int count = out.type.is_array() ? out.type.elements() : (out.type.is_triple() ? 3 : 0);
    if (index < 0 || index >= count) return reason = fmt::format("'{}' has no element {}", path.substr(0, at), index), false;
    out.type = out.type.is_array() ? out.type.element() : Type(Base::float_);
    out.offset += std::uint32_t(index) * std::uint32_t(out.type.size());
    at = close + 1;
  }
  return true;
}

/// A value that is given as it lies in memory.
static bool take_value(const ParameterText& text, Type& type, std::vector<std::byte>& bytes, std::string& reason) {
  const Type& given = text.value->type;
  const bool same = given.closure == type.closure && same_kind(given, type) && given.structure == type.structure &&
                    given.is_array() == type.is_array() && (type.array == given.array || type.array == Type::unsized);
  if (!same) {
    reason = wrong_type(text.name, type.name(), given.name());
    return false;
  }
  type.array = given.array;
  bytes = text.value->bytes;
  return true;
}

bool parse_value(const ParameterText& text, Type& type, std::vector<std::byte>& bytes, std::string& reason) {
  if (text.value) return take_value(text, type, bytes, reason);
  std::vector<std::string> words = text.words;
  const std::string stated = text.type.empty() ? infer_type(words) : text.type;
  const Type given = parse_type(stated);
  // "0.5,0.5,0.5" of a type that was stated.
  if (!text.type.empty() && given.base != Base::string && words.size() == 1 && words[0].find(',') != std::string::npos) {
    std::string rest = std::move(words[0]);
    words.clear();
    for (size_t begin = 0; begin <= rest.size();) {
      const size_t comma = std::min(rest.find(',', begin), rest.size());
      words.push_back(rest.substr(begin, comma - begin));
      begin = comma + 1;
    }
  }
  const bool float_array = given.base == Base::float_ && given.array == 3 && type.is_triple();
  if (given.is_void() || type.is_closure() || type.is_structure() || (!same_kind(given, type) && !float_array) ||
      (!float_array && given.is_array() != type.is_array())) {
    reason = wrong_type(text.name, type.name(), stated);
    return false;
  }
  const int numbers = std::max(1, type.floats());
  if (type.array == Type::unsized)
    type.array = given.array > 0 ? given.array : std::max(1, int((words.size() + size_t(numbers) - 1) / size_t(numbers)));
  else if (given.array > 0 && type.is_array() && given.array != type.array) {
    reason = wrong_type(text.name, type.name(), stated);
    return false;
  }
  bytes.resize(type.size());
  MemoryLayout::clear(type, bytes.data());
  const size_t count = std::min(words.size(), size_t(type.elements()) * size_t(numbers));
  for (size_t i = 0; i < count; ++i) {
    const char* word = words[i].c_str();
    if (type.base == Base::string) {
      reinterpret_cast<const String**>(bytes.data())[i] = intern_string(words[i]);
      continue;
    }
    char* end = nullptr;
    if (type.base == Base::int_)
      reinterpret_cast<int*>(bytes.data())[i] = int(std::strtol(word, &end, 0));
    else
      reinterpret_cast<float*>(bytes.data())[i] = std::strtof(word, &end);
    if (end == word) return reason = fmt::format("'{}' is not a number, for the parameter '{}'", words[i], text.name), false;
  }
  return true;
}

}  // namespace etendue::osl
