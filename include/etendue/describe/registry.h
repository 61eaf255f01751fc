#pragma once
// Registry: the registered classes with their members. It creates components by class name, and reads and sets members by name.

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <typeindex>
#include <variant>
#include <vector>

#include "etendue/describe/component.h"
#include "etendue/describe/value.h"

namespace etendue {

/// The work that an edit of a member makes necessary. An edit also affects the components that refer to the edited one, with
/// the Effect of the member that refers to it: editing a colour of a map that displaces a mesh rebuilds the mesh.
enum class Effect : std::uint8_t {
  none,      ///< none: the member is a limit, or a number of samples
  retone,    ///< the collected samples are kept, and displayed differently
  rerender,  ///< samples are collected anew; acceleration structures are kept
  rebuild,   ///< shapes and acceleration structures are built anew
};
std::string_view name(Effect);

/// The allowed range of a number, in the member's unit; it includes its ends, unless open_low is set.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool open_low = false;
  /// The ends are also compared as floats, as the member may be a float.
  bool contains(double x) const {
    return (open_low ? x > low : x >= low || float(x) >= float(low)) && (x <= high || float(x) <= float(high));
  }
  std::string text() const;
};

/// The ends of a slider for a member, in the member's unit: the usual range. Values outside of it are allowed within the Range.
struct SoftRange {
  double low = 0, high = 0;
};

/// The quantity that a colour, or a map used as one, represents.
enum class Meaning : std::uint8_t {
  plain,        ///< depends on the component that uses it
  number,       ///< for a map: only its scalar is used (a roughness, a fraction, a height)
  reflectance,  ///< a fraction of light, from 0 to 1, per wavelength
  radiance,     ///< emitted light, or its spectrum's shape
  coefficient,  ///< non-negative and unbounded, per wavelength: an absorption or scattering coefficient, a mean free path
  index,        ///< a refractive index
};
std::string_view name(Meaning);

/// A condition on another member of the same component: a member has an effect only if all its conditions hold.
struct Condition {
  using Wanted = std::variant<bool, double, std::string>;
  // Compiled once, in src/describe/description.cpp.
  Condition();
  Condition(const Condition&);
  Condition(Condition&&) noexcept;
  Condition& operator=(const Condition&);
  Condition& operator=(Condition&&) noexcept;
  ~Condition();

  std::string member;
  /// The other member must have one of these values; numbers are in its unit. If the list is empty, any value except false, 0,
  /// "", an empty list, none, and a map that is 0 everywhere.
  std::vector<Wanted> values;
  bool unless = false;  ///< negates the condition
  bool holds(const Component&) const;
  /// "'pigment' is color or melanin", "'file' is not given"
  std::string text(const ClassInfo&) const;
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

/// The numbers of a list as they lie in memory, in the member's unit, row after row.
struct ListInMemory {
  enum class Scalar : std::uint8_t { float32, float64, int32, uint32, int64, uint64, other };
  const void* data = nullptr;
  size_t rows = 0;
  int width = 1;
  Scalar scalar = Scalar::float32;
};

/// One described member of a class.
struct Member {
  // Compiled once, in src/describe/description.cpp.
  Member();
  Member(const Member&);
  Member(Member&&) noexcept;
  Member& operator=(const Member&);
  Member& operator=(Member&&) noexcept;
  ~Member();

  std::string name, unit, text;
  Kind kind = Kind::number;
  bool list = false;
  bool required = false;   ///< must be written, as it has no useful default
  bool in_double = false;  ///< the numbers are doubles; else floats
  Effect effect = Effect::rerender;
  std::optional<Range> range;
  std::optional<SoftRange> soft;
  bool logarithmic = false;          ///< the slider is logarithmic
  std::vector<std::string> choices;  ///< all allowed values of a choice, a string, or the strings of a list
  Meaning meaning = Meaning::plain;
  std::string group;  ///< members of one group are shown together in a panel; "" for the first members of a class
  std::vector<Condition> conditions;  ///< all must hold for the member to have an effect; see `matters`
  std::string component_class;        ///< the interface that a `component` member refers to
  const ClassInfo* owner = nullptr;   ///< the class that declares the member
  Value default_value;                ///< that of a default-constructed object; none for abstract classes

  Value (*get)(const Component&, const Member&) = nullptr;
  /// Converts, checks and stores a value. Throws Error with a message that does not contain the class and the member. Call
  /// `set` below instead, which prepends them.
  void (*store)(Component&, const Member&, const Value&) = nullptr;
  /// Views a list of numbers without a copy; null for all other members. The view is valid until the member changes.
  ListInMemory (*view)(const Component&) = nullptr;
  /// Exchanges the list with the one that was kept (null: an empty one), without a copy: what was viewed stays valid as long
  /// as `kept` lives. Null where `view` is.
  void (*exchange)(Component&, std::shared_ptr<void>& kept) = nullptr;
};

/// A member of the interface that a class does not have.
struct AbsentMember {
  std::string name, why;  ///< why: the reason in the error message if it is set, "its paths come from luminaires"
};

class ClassInfo {
 public:
  std::string name;
  const ClassInfo* parent = nullptr;  ///< null for top-level interfaces
  std::string summary, source;
  std::vector<Member> members;                         ///< inherited members first
  std::vector<AbsentMember> absent;                    ///< inherited members that have no effect in this class
  Ref<Component> (*make)(const ClassInfo&) = nullptr;  ///< makes an object; null: abstract
  std::type_index type = typeid(void);
  std::string provider;  ///< "" for built-in classes, else the plugin's file
  std::string literal;   ///< the member that a plain value sets where this class's interface is expected; "" if there is none

  /// For classes that were declared at run time: what `make` needs, such as a class of a script.
  std::shared_ptr<void> declared;

  bool abstract() const { return make == nullptr; }
  Ref<Component> create() const { return make(*this); }
  bool is_a(const ClassInfo& ancestor) const;
  const Member* find(std::string_view member) const;
};

class Registry {
 public:
  static Registry& instance();

  /// Null if there is no such class.
  const ClassInfo* find(std::string_view name) const;
  const ClassInfo* find(std::type_index) const;
  /// All classes, sorted by name.
  std::vector<const ClassInfo*> all() const;
  /// The same without those of the library of formats, unless it has been needed before.
  std::vector<const ClassInfo*> loaded() const;
  /// The concrete classes of an interface, sorted by name.
  std::vector<const ClassInfo*> subclasses(const ClassInfo& of) const;
  /// Creates a component. Throws Error with a suggestion if there is no such class or it is abstract.
  Ref<Component> create(std::string_view name) const;

  /// Opens a shared library and registers its classes. Throws Error if the library cannot be opened, was built for another ABI,
  /// or if the description of one of its classes is invalid. Opening a library again has no effect.
  void load_plugin(const std::string& path);
  std::vector<std::string> plugins() const;
  /// From now on plugins whose files end so (".py") are not opened as libraries: `read` declares their classes.
  void read_plugins(const std::string& ending, std::function<void(const std::string& file)> read);

  /// Adds a class that is made at run time, with its inherited members first (describe/declared_class.h helps with that). It
  /// replaces an earlier declaration of the same name, whose objects keep their description. Throws Error if the description is
  /// invalid, or the name is that of a compiled class.
  const ClassInfo& declare(std::unique_ptr<ClassInfo>);

  /// Checks and adds the classes that enlisted themselves since the last call (all functions above call it first).
  void adopt();

 private:
  Registry();
  struct State;
  State* state_;
};

/// Reads a member; throws Error with a suggestion if there is no member of this name.
Value get(const Component&, std::string_view member);
/// Sets a member, after checking type, unit, range and choices. Members are set in no other way. Numbers without a unit
/// are in the member's unit. Throws Error with value.location.
void set(Component&, std::string_view member, const Value&);

/// Whether a member has any effect, given the current values of the component's other members.
bool matters(const Component&, const Member&);

/// A deep copy: every member is copied; components that are shared in the original are shared in the copy as well.
Ref<Component> copy(const Component&);

/// The text that must be equal in program and plugin (describe/abi.h): interface version, compiler ABI, number of wavelengths.
const char* abi_string();

}  // namespace etendue
