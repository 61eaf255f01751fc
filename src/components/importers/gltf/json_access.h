#pragma once
// Typed access to members of JSON objects. Errors name the member; `within` adds the location of the object.

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "etendue/core/error.h"

namespace etendue::gltf {

using Json = nlohmann::json;

/// Calls a function and prepends the location to its errors: "materials[2]: 'alphaMode' is not a text".
template <class Call>
auto within(const std::string& where, Call call) {
  try {
    return call();
  } catch (const Error& error) {
    throw Error(where + ": " + error.what(), error.location);
  }
}

/// The member, or null if it is missing.
inline const Json* find(const Json& object, const char* key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

[[noreturn]] inline void wrong(const char* key, const char* wanted) {
  throw Error(std::string("'") + key + "' is not " + wanted);
}

inline double number(const Json& object, const char* key, double otherwise) {
  const Json* member = find(object, key);
  if (!member) return otherwise;
  if (!member->is_number()) wrong(key, "a number");
  return member->get<double>();
}

/// A nonnegative integer; nothing if the member is missing.
inline std::optional<size_t> whole(const Json& object, const char* key) {
  const Json* member = find(object, key);
  if (!member) return std::nullopt;
  if (member->is_number_unsigned()) return member->get<size_t>();
  const double value = member->is_number() ? member->get<double>() : -1;  // 3.0 is an integer too
  if (!(value >= 0 && value < 9e15 && value == double(size_t(value)))) wrong(key, "a whole number from 0 on");
  return size_t(value);
}
inline size_t needed_whole(const Json& object, const char* key) {
  const auto value = whole(object, key);
  if (!value) throw Error(std::string("there is no '") + key + "'");
  return *value;
}

inline bool truth(const Json& object, const char* key, bool otherwise) {
  const Json* member = find(object, key);
  if (!member) return otherwise;
  if (!member->is_boolean()) wrong(key, "true or false");
  return member->get<bool>();
}

inline std::string text(const Json& object, const char* key, const std::string& otherwise = {}) {
  const Json* member = find(object, key);
  if (!member) return otherwise;
  if (!member->is_string()) wrong(key, "a text");
  return member->get<std::string>();
}

/// An object; an empty one if the member is missing.
inline const Json& object_in(const Json& object, const char* key) {
  static const Json none = Json::object();
  const Json* member = find(object, key);
  if (!member) return none;
  if (!member->is_object()) wrong(key, "an object");
  return *member;
}

/// A list; an empty one if the member is missing.
inline const Json& list_in(const Json& object, const char* key) {
  static const Json none = Json::array();
  const Json* member = find(object, key);
  if (!member) return none;
  if (!member->is_array()) wrong(key, "a list");
  return *member;
}

template <size_t n>
std::optional<std::array<double, n>> numbers(const Json& object, const char* key) {
  const Json* member = find(object, key);
  if (!member) return std::nullopt;
  std::array<double, n> values{};
  const bool right = member->is_array() && member->size() == n;
  for (size_t i = 0; right && i < n; ++i) {
    if (!(*member)[i].is_number()) wrong(key, "a list of numbers");
    values[i] = (*member)[i].get<double>();
  }
  if (!right) throw Error(std::string("'") + key + "' is not a list of " + std::to_string(n) + " numbers");
  return values;
}

inline std::array<double, 3> rgb(const Json& object, const char* key, double otherwise) {
  return numbers<3>(object, key).value_or(std::array<double, 3>{otherwise, otherwise, otherwise});
}

/// A list of indices into another list of `count` elements. Throws Error if one is out of range.
inline std::vector<size_t> places(const Json& object, const char* key, size_t count) {
  std::vector<size_t> all;
  for (const Json& one : list_in(object, key)) {
    if (!one.is_number_unsigned() || one.get<size_t>() >= count)
      throw Error(std::string("'") + key + "' names " + one.dump().substr(0, 20) + " of " + std::to_string(count));
    all.push_back(one.get<size_t>());
  }
  return all;
}

inline const Json& extension(const Json& object, const char* name) { return object_in(object_in(object, "extensions"), name); }
inline bool has_extension(const Json& object, const char* name) {
  return find(object_in(object, "extensions"), name) != nullptr;
}

}  // namespace etendue::gltf
