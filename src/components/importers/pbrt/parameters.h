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
  std::vector<std::string> strings;  ///< of a bool "true" or "false"
  mutable bool used = false;

  bool is(std::string_view t) const { return type == t; }
};

/// All parameters of a directive. What was not asked for is told by tell_unused.
class Parameters {
 public:
  /// Reads what follows a directive's name.
  static Parameters read(Lexer&, std::string of, Location at);

  std::string of;                   ///< 'Shape "sphere"', for messages
  Location at;                      ///< of the directive
  std::string folder;               ///< of the file it stands in
  const RgbSpace* space = nullptr;  ///< of its "rgb" numbers
  Importing* lenient = nullptr;     ///< of version 3, which takes a value that does not fit for none: whom it is told
  std::vector<Parameter> own;
  std::vector<std::pair<std::string, Location>> overridden;  ///< which were given again, with another value
  std::shared_ptr<const std::vector<Parameter>> defaults;    ///< from v4's Attribute directive

  /// By name; it counts as used then. Null: there is none.
  const Parameter* find(std::string_view name) const;
  bool has(std::string_view name) const { return find(name) != nullptr; }
  /// The first of the names that there is: v3 and v4 often have other names for the same.
  const Parameter* first_of(std::initializer_list<std::string_view> names) const;

  // One value of a type. Throws Error at the parameter for another type or number of values.
  double number(std::string_view name, double otherwise) const;
  std::optional<double> number(std::string_view name) const;
  /// What may be a texture as well, of which version 3 takes the first number of several.
  double first_number(std::string_view name, double otherwise) const;
  int integer(std::string_view name, int otherwise) const;
  bool boolean(std::string_view name, bool otherwise) const;
  std::string text(std::string_view name, const std::string& otherwise = {}) const;
  DoublePoint3 point(std::string_view name, const DoublePoint3& otherwise) const;
  /// A list of numbers, `width` for each of them; nothing: an empty one.
  const std::vector<double>& numbers(std::string_view name, size_t width = 1) const;
  /// The same, moved out: a long list is kept once only.
  std::vector<double> take_numbers(std::string_view name, size_t width = 1);
  std::vector<std::string> texts(std::string_view name) const;
  Location place(std::string_view name) const;

  /// Whether something asked for a parameter of this name.
  bool asked_for(std::string_view name) const;
  /// Notes each parameter that nothing asked for.
  void tell_unused(Importing&) const;
  /// Parameters that make no difference here, which is not worth a word.
  void ignore(std::initializer_list<std::string_view> names) const;
  /// They say nothing, as what they belong to was noted already.
  void forget() const;

 private:
  void add(Parameter);
  /// An Error at a parameter; version 3 goes on as if it were not given, which is told.
  void misfit(const Parameter&, const std::string& what) const;
  const Parameter* single(std::string_view name, bool text) const;
  mutable std::vector<std::string> asked_;  // for suggestions
};

}  // namespace etendue::pbrt
