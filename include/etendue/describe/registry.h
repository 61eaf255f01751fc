#pragma once
// What is known of classes: their members, how to make them, how to read and set members by name.

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <typeindex>
#include <vector>

#include "etendue/describe/component.h"
#include "etendue/describe/value.h"

namespace etendue {

/// What an edit of a member forces to be done again.
enum class Effect : std::uint8_t { retone, rerender, rebuild };
std::string_view name(Effect);

/// The numbers a member may hold, in the member's unit, ends included unless said.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool open_low = false;
  /// A member may be a float: its ends count as what they are there.
  bool contains(double x) const {
    return (open_low ? x > low : x >= low || float(x) >= float(low)) && (x <= high || float(x) <= float(high));
  }
  std::string text() const;
};

enum class Kind : std::uint8_t {
  boolean,
  integer,
  number,
  string,
  file,
  choice,
  vector2,
  vector3,
  point3,
  normal3,
  color,
  transform,
  component
};
std::string_view name(Kind);

/// One described member of a class.
struct Member {
  std::string name, unit, text;
  Kind kind = Kind::number;
  bool list = false;
  bool required = false;   ///< must be written: it has no useful default
  bool in_double = false;  ///< its numbers are places in double; else they are floats
  Effect effect = Effect::rerender;
  std::optional<Range> range;
  std::vector<std::string> choices;
  std::string component_class;       ///< the interface a `component` member refers to
  const ClassInfo* owner = nullptr;  ///< the class that declares it
  Value default_value;               ///< of a default-constructed object; none for abstract classes

  Value (*get)(const Component&, const Member&) = nullptr;
  /// Converts and stores; throws Error without checking who asks. Call `set` below instead.
  void (*store)(Component&, const Member&, const Value&) = nullptr;
};

class ClassInfo {
 public:
  std::string name;
  const ClassInfo* parent = nullptr;  ///< null for interfaces that stand at the top
  std::string summary, source;
  std::vector<Member> members;           ///< inherited ones first
  Ref<Component> (*create)() = nullptr;  ///< null: abstract
  std::type_index type = typeid(void);
  std::string provider;  ///< "" for built-in parts, else the plugin's file
  std::string literal;   ///< a plain value where this class's interface is expected sets this member; "" when it has none

  bool abstract() const { return create == nullptr; }
  bool is_a(const ClassInfo& ancestor) const;
  const Member* find(std::string_view member) const;
};

class Registry {
 public:
  static Registry& instance();

  /// Null when unknown.
  const ClassInfo* find(std::string_view name) const;
  const ClassInfo* find(std::type_index) const;
  /// All classes by name.
  std::vector<const ClassInfo*> all() const;
  /// The concrete classes of an interface, by name.
  std::vector<const ClassInfo*> subclasses(const ClassInfo& of) const;
  /// Throws Error with a suggestion when there is no such class or it is abstract.
  Ref<Component> create(std::string_view name) const;

  /// Opens a shared library and adopts the classes it registers; throws Error when it cannot be opened, was built
  /// for another ABI, or one of its classes is badly described. Opening one twice does nothing.
  void load_plugin(const std::string& path);
  std::vector<std::string> plugins() const;

  /// Checks and takes in classes registered since the last call (all calls above do so first).
  void adopt();

 private:
  Registry();
  struct State;
  State* s;
};

/// Reads a member; throws Error (with a suggestion) when there is none of this name.
Value get(const Component&, std::string_view member);
/// Checks type, unit, range and choices and sets a member; the one way by which anything is ever set. Numbers without a
/// unit are in the member's unit. Throws Error with value.location.
void set(Component&, std::string_view member, const Value&);

/// A deep copy: every member copied, shared parts shared in the copy as well.
Ref<Component> copy(const Component&);

/// What must agree between the program and a plugin: interface version, compiler ABI, number of wavelengths.
const char* abi_string();

}  // namespace etendue
