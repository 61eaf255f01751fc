#pragma once
// From syntax to values: names, arithmetic, calls, components.

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>

#include "etendue/describe/registry.h"
#include "source.h"
#include "syntax.h"

namespace etendue::language {

/// Arithmetic on values; each throws Error at the place of the operator when it has no meaning.
Value add(const Value&, const Value&, Location);
Value subtract(const Value&, const Value&, Location);
Value multiply(const Value&, const Value&, Location);
Value divide(const Value&, const Value&, Location);
Value power(const Value& base, const Value& exponent, Location);
Value negate(const Value&, Location);
/// A plain number or packed plain numbers in this unit.
Value with_unit(Value, const Unit&, Location);
/// Items as packed numbers when they are numbers, or rows of numbers, of one dimension and width; else as a list.
Value packed(Value::List, Location);

/// Calls a function of the language; throws Error at the argument that does not fit.
Value call(const std::string& function, const std::vector<Value>& arguments, Location, bool allow_files);
bool is_function(const std::string& name);

/// Evaluates expressions in one namespace of definitions. Each definition is evaluated once, when first used, so that
/// order does not matter and components are shared. What is wrong is reported; an absent result means that it was.
class Evaluator {
 public:
  Evaluator(Diagnostics& diagnostics, bool allow_files) : diagnostics_(diagnostics), allow_files_(allow_files) {}

  /// Paths in the text of this name start from a folder.
  void set_folder(const char* source, std::string folder) { folders_[source] = std::move(folder); }
  /// Some definitions or classes could not be read: names that are missing are no news.
  void set_incomplete() { incomplete_ = true; }
  void define(Definition);
  /// Replaces the value of a param.
  void redefine(const std::string& name, const std::string& text);

  /// Where an expression stands.
  struct Context {
    const Member* member = nullptr;  ///< that it is for: makes bare words choices
    bool words = false;              ///< bare words that name nothing are strings
    bool lenient = false;            ///< bare words that name nothing are ignored: their member is unknown
  };
  std::optional<Value> evaluate(Node&, const Context&);
  /// Evaluates what was not used, for the errors in it, and warns of it if it was defined in the text of this name.
  void check_unused(const char* source);

 private:
  enum class State : std::uint8_t { waiting, active, done, failed };
  struct Entry {
    Definition definition;
    State state = State::waiting;
    bool used = false;
    bool replaced = false;  // by -D
    bool pending = false;   // on the way from the name that is settled to what it needs first
    int height = 0;         // of the tree of all that it is made of, where that remains: of components
    Value value;
  };
  // Bounds recursion here, and later wherever components are walked or destroyed.
  static constexpr int height_limit = 1000;
  // Bounds what lists within lists hold, as each use of a name copies its list.
  static constexpr size_t nested_limit = 1'000'000;

  std::optional<Value> value_of(Node&, const Context&);
  std::optional<Value> name(Node&, const Context&);
  std::optional<Value> named(Entry&, Location);
  void settle(Entry&);
  void settle_with_all_it_needs(Entry&);
  std::vector<Entry*> waiting_names(const Node&);
  std::optional<Value> list(Node&, const Context&);
  std::optional<Value> json_text(Node&, const Context&);
  std::optional<Value> json_numbers(Node&, const Member&);
  void check_size(const Node&, const Value::List&) const;
  std::optional<Value> chain(Node&, const Context&);
  std::optional<Value> call_function(Node&, const Context&);
  std::optional<Value> component(Node&, const std::string& given_name);
  bool set_members(Component&, Node&);

  Entry* find(const std::string&);
  void undefined(const std::string&, Location);
  /// Runs what may throw Error; an error is reported at `at` unless it has a place.
  template <class F>
  std::optional<Value> reporting(Location at, F&& make) {
    try {
      return make();
    } catch (const Errors& list) {
      for (const Error& e : list.errors) diagnostics_.add(located(e, at));
    } catch (const Error& e) {
      diagnostics_.add(located(e, at));
    }
    return std::nullopt;
  }

  Diagnostics& diagnostics_;
  bool allow_files_, incomplete_ = false;
  std::deque<Entry> entries_;
  std::unordered_map<std::string, Entry*> by_name_;
  std::vector<Entry*> active_;  // being evaluated, outermost first
  bool circle_ = false;         // what is settled now is defined by itself
  std::unordered_map<const char*, std::string> folders_;
  std::deque<Source> replacements_;
  int depth_ = 0, reach_ = 0;  // nesting now, and the deepest within the definition being evaluated
};

}  // namespace etendue::language
