#pragma once
// What is known of classes: their members, how to make them, how to read and set members by name.

#include <limits>
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

/// What an edit of a member forces to be done again. What holds the edited component is concerned as much, as far as the member
/// that holds it says: a colour of a map by which a mesh is displaced rebuilds the mesh.
enum class Effect : std::uint8_t {
  none,      ///< nothing: it is a limit, or how many samples are wanted
  retone,    ///< what was collected is shown in another way
  rerender,  ///< samples are collected anew; what is searched by rays stays
  rebuild,   ///< shapes are made anew, and what finds them
};
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

/// Where a slider for a member ends, in the member's unit: what is usual. More may be written, as far as the Range goes.
struct SoftRange {
  double low = 0, high = 0;
};

/// What a colour, or a map that stands for one, is read as.
enum class Meaning : std::uint8_t {
  plain,        ///< whoever uses it says
  number,       ///< of a map: only its scalar counts (a roughness, a share, a height)
  reflectance,  ///< a fraction of light, from 0 to 1, per wavelength
  radiance,     ///< emitted light, or its spectrum's shape
  coefficient,  ///< per wavelength, not negative, of any size: of absorption, of scattering; a distance for each wavelength
  index,        ///< of refraction
};
std::string_view name(Meaning);

/// What another member of the same component must hold for a member to matter.
struct Condition {
  using Wanted = std::variant<bool, double, std::string>;
  std::string member;
  /// One of these, numbers in that member's unit. None: anything but false, 0, "", an empty list, none or a map that is 0
  /// everywhere.
  std::vector<Wanted> values;
  bool unless = false;  ///< the opposite
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

/// One described member of a class.
struct Member {
  std::string name, unit, text;
  Kind kind = Kind::number;
  bool list = false;
  bool required = false;   ///< must be written: it has no useful default
  bool in_double = false;  ///< its numbers are doubles; else they are floats
  Effect effect = Effect::rerender;
  std::optional<Range> range;
  std::optional<SoftRange> soft;
  bool logarithmic = false;          ///< a slider goes by ratios, not by differences
  std::vector<std::string> choices;  ///< of a choice, a string or the strings of a list: all there are
  Meaning meaning = Meaning::plain;
  std::string group;                  ///< members of one group stand together in a panel; "" for the first of a class
  std::vector<Condition> conditions;  ///< all must hold for the member to matter; see `matters`
  std::string component_class;        ///< the interface a `component` member refers to
  const ClassInfo* owner = nullptr;   ///< the class that declares it
  Value default_value;                ///< of a default-constructed object; none for abstract classes

  Value (*get)(const Component&, const Member&) = nullptr;
  /// Converts and stores; throws Error without checking who asks. Call `set` below instead.
  void (*store)(Component&, const Member&, const Value&) = nullptr;
};

/// A member of its interface that a class does not have.
struct AbsentMember {
  std::string name, why;  ///< why: what is told whoever sets it, "its paths come from luminaires"
};

class ClassInfo {
 public:
  std::string name;
  const ClassInfo* parent = nullptr;  ///< null for interfaces that stand at the top
  std::string summary, source;
  std::vector<Member> members;           ///< inherited ones first
  std::vector<AbsentMember> absent;      ///< those of its parents that mean nothing to it
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

/// Whether a member's value makes any difference while the component's other members are what they are.
bool matters(const Component&, const Member&);

/// A deep copy: every member copied, shared parts shared in the copy as well.
Ref<Component> copy(const Component&);

/// What must agree between the program and a plugin: interface version, compiler ABI, number of wavelengths.
const char* abi_string();

}  // namespace etendue
