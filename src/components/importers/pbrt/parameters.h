#pragma once
// The parameters of a pbrt directive: "type name" and a list.

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "etendue/describe/color.h"
#include "etendue/importer.h"
#include "lexer.h"

namespace etendue::pbrt {

struct Parameter {
  std::string type, name;
  Location at;
  std::vector<double> numbers;
  std::vector<std::string> strings;  ///< "true" or "false" for a bool
  mutable bool used = false;

  bool is(std::string_view t) const { return type == t; }
};

/// All parameters of a directive. tell_unused warns of those that were not read.
class Parameters {
 public:
  /// Reads the parameters that follow a directive's name.
  static Parameters read(Lexer&, std::string of, Location at);

  std::string of;                   ///< 'Shape "sphere"', for messages
  Location at;                      ///< of the directive
  std::string folder;               ///< of the file that contains the directive
  const RgbSpace* space = nullptr;  ///< colour space of "rgb" values
  Importing* lenient = nullptr;     ///< set for version 3, which ignores values that do not fit: receives the warnings
  std::vector<Parameter> own;
  std::vector<std::pair<std::string, Location>> overridden;  ///< overridden by a later parameter of the same name
  std::shared_ptr<const std::vector<Parameter>> defaults;    ///< from v4's Attribute directive

  /// The parameter of this name, which is marked as used. Null: there is none.
  const Parameter* find(std::string_view name) const;
  bool has(std::string_view name) const { return find(name) != nullptr; }
  /// The first of the names that is given: v3 and v4 often use different names for the same.
  const Parameter* first_of(std::initializer_list<std::string_view> names) const;

  // A single value. They throw Error at the parameter if the type or number of values differs.
  double number(std::string_view name, double otherwise) const;
  std::optional<double> number(std::string_view name) const;
  /// For a parameter that may also be a texture; version 3 uses the first of several numbers.
  double first_number(std::string_view name, double otherwise) const;
  int integer(std::string_view name, int otherwise) const;
  bool boolean(std::string_view name, bool otherwise) const;
  std::string text(std::string_view name, const std::string& otherwise = {}) const;
  DoublePoint3 point(std::string_view name, const DoublePoint3& otherwise) const;
  /// A list of numbers in groups of `width`; empty if not given.
  const std::vector<double>& numbers(std::string_view name, size_t width = 1) const;
  /// The same, moved out, so that a long list is stored only once.
  std::vector<double> take_numbers(std::string_view name, size_t width = 1);
  std::vector<std::string> texts(std::string_view name) const;
  Location place(std::string_view name) const;

  /// Whether a parameter of this name was queried.
  bool asked_for(std::string_view name) const;
  /// Adds a warning for each parameter that was never queried.
  void tell_unused(Importing&) const;
  /// Marks parameters as used that make no difference in this program.
  void ignore(std::initializer_list<std::string_view> names) const;
  /// Suppresses warnings about unused parameters, as a warning about their owner was added already.
  void forget() const;

 private:
  void add(Parameter);
  /// Throws Error at a parameter; in version 3 warns instead and continues as if the parameter were not given.
  void misfit(const Parameter&, const std::string& what) const;
  const Parameter* single(std::string_view name, bool text) const;
  mutable std::vector<std::string> asked_;  // names queried, for suggestions
};

}  // namespace etendue::pbrt
