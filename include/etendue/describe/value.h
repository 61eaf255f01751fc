#pragma once
// Value: a value of the render description language, for setting and reading the members of components.

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "etendue/core/error.h"
#include "etendue/core/ref.h"
#include "etendue/core/spectral_function.h"
#include "etendue/core/transform.h"

namespace etendue {

class Component;

enum class Dimension : std::uint8_t {
  none,
  length,
  angle,
  temperature,
  power,
  luminous_flux,
  luminous_intensity,
  illuminance,
  time
};

/// A unit of the language: `value in base units = factor * number`. Base units: m, rad, K, W, lm, cd, lx, s.
struct Unit {
  std::string_view name;
  Dimension dimension;
  double factor;
};

/// Null if there is no unit of this name.
const Unit* find_unit(std::string_view name);
const std::vector<Unit>& units();
std::string_view name(Dimension);
/// "a length", "an angle"
std::string with_article(std::string_view);

/// A number in base units, with the dimension of its unit; `none` for a number without a unit.
struct Number {
  double value = 0;
  Dimension dimension = Dimension::none;
  bool operator==(const Number&) const = default;
};

/// A list of numbers, or of rows of 2 to 4 numbers each, stored compactly for lists of millions. A vector such as
/// [1, 2, 3] is three rows of width 1; [[1,2,3],[4,5,6]] is two rows of width 3. In base units.
struct Numbers {
  std::vector<double> values;
  int width = 1;
  Dimension dimension = Dimension::none;
  size_t rows() const { return values.size() / size_t(width); }
  bool operator==(const Numbers&) const = default;
};

/// A file name, and the folder that it is relative to: that of the file in which it was written.
struct FilePath {
  std::string text;    ///< as written
  std::string folder;  ///< empty: the working folder
  /// The path to open.
  std::string resolved() const;
  bool empty() const { return text.empty(); }
  bool operator==(const FilePath& b) const { return resolved() == b.resolved(); }
};

struct Value {
  using List = std::vector<Value>;
  /// monostate is `none`.
  std::variant<std::monostate, bool, Number, std::string, Numbers, FilePath, Color, Transform, AnimatedTransform,
               Ref<Component>, List>
      data;
  Location location;
  std::string folder;  ///< the folder of the file in which a string was written

  // Compiled once, in src/describe/value.cpp, and not in each file that describes a class: that halves the time to build these
  // files.
  Value();
  Value(const Value&);
  Value(Value&&) noexcept;
  Value& operator=(const Value&);
  Value& operator=(Value&&) noexcept;
  ~Value();
  template <class T>
  explicit Value(T v, Location at = {});

  template <class T>
  const T* as() const {
    return std::get_if<T>(&data);
  }
  bool none() const { return data.index() == 0; }
  /// "a number [length]", "a list", … for messages.
  std::string kind() const;
};

/// Whether two values are equal. Components are equal if their classes and all their members are equal, whether or not they are
/// shared.
bool equal(const Value&, const Value&);
inline bool operator==(const Value& a, const Value& b) { return equal(a, b); }

template <class T>
Value::Value(T v, Location at) : data(std::move(v)), location(at) {}
extern template Value::Value(bool, Location);
extern template Value::Value(Number, Location);
extern template Value::Value(std::string, Location);
extern template Value::Value(Numbers, Location);
extern template Value::Value(FilePath, Location);
extern template Value::Value(Color, Location);
extern template Value::Value(Transform, Location);
extern template Value::Value(AnimatedTransform, Location);
extern template Value::Value(Ref<Component>, Location);
extern template Value::Value(Value::List, Location);

}  // namespace etendue
