#pragma once
// Description: a class describes its members once, in its function `describe`. Parser, writer, command line, schema, manual and
// tests are derived from this description (compare ParameterDictionary in pbrt, Properties in Mitsuba).

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "etendue/describe/abi.h"
#include "etendue/describe/registry.h"

namespace etendue {

namespace detail {
std::vector<std::string> name_list(std::initializer_list<std::string_view>);

/// A value that a condition wants; it refers to texts and does not own them.
struct Wanted {
  enum class Kind : std::uint8_t { boolean, number, text } kind;
  double number = 0;  ///< or the boolean
  std::string_view text = {};
  Wanted(bool value) : kind(Kind::boolean), number(value) {}
  Wanted(double value) : kind(Kind::number), number(value) {}
  Wanted(float value) : kind(Kind::number), number(double(value)) {}
  Wanted(int value) : kind(Kind::number), number(value) {}
  Wanted(const char* value) : kind(Kind::text), text(value) {}
  Wanted(const std::string& value) : kind(Kind::text), text(value) {}
};
Condition condition(std::string_view member, std::initializer_list<Wanted> values, bool unless);
}  // namespace detail

// ---- options of a member ------------------------------------------------------------------------------------------

inline Range range(double low, double high) { return {low, high, false}; }
inline Range at_least(double low) { return {low, std::numeric_limits<double>::infinity(), false}; }
inline Range more_than(double low) { return {low, std::numeric_limits<double>::infinity(), true}; }
/// Marks a member that must be written.
struct Required {};
inline constexpr Required required{};
/// The names of an enum's values, in order: choices("both", "front") for values 0 and 1. For a string, or the strings of a
/// list, all allowed values.
template <class... S>
std::vector<std::string> choices(const S&... names) {
  return detail::name_list({std::string_view(names)...});
}

/// The ends of a slider: soft(0.01, 10). They lie within the range, and give the usual values, not the allowed ones.
inline SoftRange soft(double low, double high) { return {low, high}; }
/// Gives a number a logarithmic slider, as for a distance or an exponent.
struct Logarithmic {};
inline constexpr Logarithmic logarithmic{};

/// A condition: the member has an effect only if another member has one of these values: when("pigment", "color"), when("sun",
/// true). Without values, when("file"): if the other member is not empty (not false, 0, "", [], none, or a map that is 0
/// everywhere). All conditions of a member must hold. The user is warned if a scene sets a member that has no effect, so the
/// conditions must be correct for every value of all other members.
template <class... V>
Condition when(std::string_view member, const V&... values) {
  return detail::condition(member, {detail::Wanted(values)...}, false);
}
/// The negated condition: unless("file"), if no file is given.
template <class... V>
Condition unless(std::string_view member, const V&... values) {
  return detail::condition(member, {detail::Wanted(values)...}, true);
}

// ---- conversion between C++ types and values ----------------------------------------------------------------------

namespace detail {

// Defined in src/describe/conversion.cpp. All throw Error with the value's location.
bool to_bool(const Value&);
double to_number(const Value&, const Member&);
std::int64_t to_integer(const Value&, const Member&, std::int64_t low, std::int64_t high);
std::string to_string(const Value&, const Member&);
FilePath to_file(const Value&);
int to_choice(const Value&, const Member&);
void to_numbers(const Value&, const Member&, double* out, int count);
Color to_color(const Value&, const Member&);
AnimatedTransform to_transform(const Value&);
Ref<Component> to_component(const Value&, const Member&);
/// Calls `push` for each row of `width` numbers; accepts flat and nested lists.
void to_rows(const Value&, const Member&, int width, void (*push)(void* to, const double* row), void* to,
             void (*reserve)(void* to, size_t rows));
void to_integers(const Value&, const Member&, std::int64_t low, std::int64_t high, void (*push)(void* to, std::int64_t),
                 void* to, void (*reserve)(void* to, size_t count));
const Value::List& to_list(const Value&, Value::List& scratch);
Value from_number(double, const Member&);
Value from_numbers(const double*, int count, const Member&);

template <class T>
struct Convert;  // undefined for types that the language does not have

template <>
struct Convert<bool> {
  static constexpr Kind kind = Kind::boolean;
  static void read(const Value& value, const Member&, bool& out) { out = to_bool(value); }
  static Value write(bool value, const Member&) { return Value(value); }
};

template <class T>
  requires(std::is_integral_v<T> && !std::is_same_v<T, bool>)
struct Convert<T> {
  static constexpr Kind kind = Kind::integer;
  static constexpr std::int64_t low = std::is_signed_v<T> ? std::int64_t(std::numeric_limits<T>::min()) : 0;
  static constexpr std::int64_t high = sizeof(T) == 8 ? (std::int64_t(1) << 53) : std::int64_t(std::numeric_limits<T>::max());
  static void read(const Value& value, const Member& member, T& out) { out = T(to_integer(value, member, low, high)); }
  static Value write(T value, const Member&) { return Value(Number{double(value)}); }
};

template <class T>
  requires std::is_floating_point_v<T>
struct Convert<T> {
  static constexpr Kind kind = Kind::number;
  static void read(const Value& value, const Member& member, T& out) { out = T(to_number(value, member)); }
  static Value write(T value, const Member& member) { return from_number(double(value), member); }
};

template <class T>
  requires std::is_enum_v<T>
struct Convert<T> {
  static constexpr Kind kind = Kind::choice;
  static void read(const Value& value, const Member& member, T& out) { out = T(to_choice(value, member)); }
  static Value write(T value, const Member& member) { return Value(member.choices.at(size_t(value))); }
};

template <>
struct Convert<std::string> {
  static constexpr Kind kind = Kind::string;
  static void read(const Value& value, const Member& member, std::string& out) { out = to_string(value, member); }
  static Value write(const std::string& value, const Member&) { return Value(value); }
};

template <>
struct Convert<FilePath> {
  static constexpr Kind kind = Kind::file;
  static void read(const Value& value, const Member&, FilePath& out) { out = to_file(value); }
  static Value write(const FilePath& value, const Member&) { return value.empty() ? Value(std::string()) : Value(value); }
};

template <class T, Kind K, int N>
struct ConvertTuple {
  static constexpr Kind kind = K;
  static constexpr int width = N;
  using Scalar = decltype(T::x);
  static T make(const double* f) {
    if constexpr (N == 2)
      return T{Scalar(f[0]), Scalar(f[1])};
    else
      return T{Scalar(f[0]), Scalar(f[1]), Scalar(f[2])};
  }
  static void read(const Value& value, const Member& member, T& out) {
    double f[N];
    to_numbers(value, member, f, N);
    out = make(f);
  }
  static void get(const T& value, double* f) {
    f[0] = double(value.x);
    f[1] = double(value.y);
    if constexpr (N == 3) f[2] = double(value.z);
  }
  static Value write(const T& value, const Member& member) {
    double f[N];
    get(value, f);
    return from_numbers(f, N, member);
  }
};
template <>
struct Convert<Vector2> : ConvertTuple<Vector2, Kind::vector2, 2> {};
template <>
struct Convert<Point2> : ConvertTuple<Point2, Kind::vector2, 2> {};
template <>
struct Convert<Vector3> : ConvertTuple<Vector3, Kind::vector3, 3> {};
template <>
struct Convert<Point3> : ConvertTuple<Point3, Kind::point3, 3> {};
template <>
struct Convert<DoublePoint3> : ConvertTuple<DoublePoint3, Kind::point3, 3> {};
template <>
struct Convert<Normal3> : ConvertTuple<Normal3, Kind::normal3, 3> {};

template <>
struct Convert<Color> {
  static constexpr Kind kind = Kind::color;
  static void read(const Value& value, const Member& member, Color& out) { out = to_color(value, member); }
  static Value write(const Color& value, const Member&) { return value ? Value(value) : Value(); }
};

template <>
struct Convert<AnimatedTransform> {
  static constexpr Kind kind = Kind::transform;
  static void read(const Value& value, const Member&, AnimatedTransform& out) { out = to_transform(value); }
  static Value write(const AnimatedTransform& value, const Member&) {
    return value.animated() ? Value(AnimatedTransform(value.keys())) : Value(value.keys().front().transform);
  }
};

template <class C>
struct Convert<Ref<C>> {
  static constexpr Kind kind = Kind::component;
  static void read(const Value& value, const Member& member, Ref<C>& out) { out = ref_cast<C>(to_component(value, member)); }
  static Value write(const Ref<C>& value, const Member&) { return value ? Value(Ref<Component>(value)) : Value(); }
};

template <class T>
concept Tuple = requires { Convert<T>::width; };

template <class T>
struct Convert<std::vector<T>> {
  static constexpr Kind kind = Convert<T>::kind;
  using List = std::vector<T>;
  static void reserve(void* to, size_t count) { static_cast<List*>(to)->reserve(count); }

  static void read(const Value& value, const Member& member, List& out) {
    List list;
    if constexpr (Tuple<T>) {
      to_rows(
          value, member, Convert<T>::width,
          [](void* to, const double* f) { static_cast<List*>(to)->push_back(Convert<T>::make(f)); }, &list, reserve);
    } else if constexpr (std::is_floating_point_v<T>) {
      to_rows(value, member, 1, [](void* to, const double* f) { static_cast<List*>(to)->push_back(T(*f)); }, &list, reserve);
    } else if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>) {
      to_integers(
          value, member, Convert<T>::low, Convert<T>::high,
          [](void* to, std::int64_t i) { static_cast<List*>(to)->push_back(T(i)); }, &list, reserve);
    } else {
      Value::List scratch;
      for (const Value& item : to_list(value, scratch)) Convert<T>::read(item, member, list.emplace_back());
    }
    out = std::move(list);
  }

  static Value write(const List& value, const Member& member) {
    if constexpr (Tuple<T>) {
      Numbers numbers;
      numbers.width = Convert<T>::width;
      numbers.values.reserve(value.size() * size_t(numbers.width));
      for (const T& item : value) {
        double f[3];
        Convert<T>::get(item, f);
        numbers.values.insert(numbers.values.end(), f, f + numbers.width);
      }
      return Value(std::move(numbers));
    } else if constexpr (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>) {
      Numbers numbers;
      numbers.values.assign(value.begin(), value.end());
      return Value(std::move(numbers));
    } else {
      Value::List list;
      for (const T& item : value) list.push_back(Convert<T>::write(item, member));
      return Value(std::move(list));
    }
  }
};

template <class T>
struct IsVector : std::false_type {};
template <class T>
struct IsVector<std::vector<T>> : std::true_type {};

/// The unqualified name of a class, from its mangled name.
std::string bare_class_name(const std::type_info&);

template <class T>
std::string referred_class() {
  return {};
}
template <class T>
  requires requires { typename T::Referred; }
std::string referred_class() {
  return bare_class_name(typeid(typename T::Referred));
}
template <class T>
struct Referee {};
template <class C>
struct Referee<Ref<C>> {
  using Referred = C;
};
template <>
struct Referee<Color> {};
template <class C>
struct Referee<std::vector<C>> : Referee<C> {};

template <class T>
constexpr bool in_double = std::is_same_v<T, double> || std::is_same_v<T, DoublePoint3>;
template <class T>
constexpr bool in_double<std::vector<T>> = in_double<T>;

/// A list whose rows are numbers that lie one after the other.
template <class T>
constexpr bool list_of_numbers = false;
template <class T>
constexpr bool list_of_numbers<std::vector<T>> = Tuple<T> || (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>);

template <class T>
constexpr ListInMemory::Scalar scalar_type() {
  using Scalar = ListInMemory::Scalar;
  if constexpr (std::is_same_v<T, float>) return Scalar::float32;
  if constexpr (std::is_same_v<T, double>) return Scalar::float64;
  if constexpr (std::is_integral_v<T> && sizeof(T) == 4) return std::is_signed_v<T> ? Scalar::int32 : Scalar::uint32;
  if constexpr (std::is_integral_v<T> && sizeof(T) == 8) return std::is_signed_v<T> ? Scalar::int64 : Scalar::uint64;
  return Scalar::other;
}

template <class T>
ListInMemory view_list(const std::vector<T>& list) {
  if constexpr (Tuple<T>)
    return {list.data(), list.size(), Convert<T>::width, scalar_type<typename Convert<T>::Scalar>()};
  else
    return {list.data(), list.size(), 1, scalar_type<T>()};
}

template <class List>
void exchange_list(List& list, std::shared_ptr<void>& kept) {
  if (!kept) kept = std::make_shared<List>();
  std::swap(list, *static_cast<List*>(kept.get()));
}

template <auto P>
struct PointerTo;
template <class C, class T, T C::* P>
struct PointerTo<P> {
  using Class = C;
  using Type = T;
};

}  // namespace detail

// ---- the description itself ---------------------------------------------------------------------------------------

/// The facts about a member that follow from its C++ type.
struct MemberType {
  Kind kind;
  bool list, in_double;
  Value (*get)(const Component&, const Member&);
  void (*store)(Component&, const Member&, const Value&);
  ListInMemory (*view)(const Component&);
  void (*exchange)(Component&, std::shared_ptr<void>& kept);
};

/// The part of a description that does not depend on the class; it is compiled once.
class AnyDescription {
 public:
  /// Throws Error for a group without members; called at the end of the description.
  void finish() const;

 protected:
  explicit AnyDescription(ClassInfo& info) : info_(info) {}
  void set_summary(std::string_view text, std::string_view source);
  void open_group(std::string_view name);
  Member& add_member(std::string_view name, std::string_view unit, std::string_view text, const MemberType&,
                     std::string component_class);
  void remove_member(std::string_view name, std::string_view why);
  void set_literal(std::string_view member);

  static void option(Member& m, Range r) { m.range = r; }
  static void option(Member& m, Effect e) { m.effect = e; }
  static void option(Member& m, Required) { m.required = true; }
  static void option(Member& m, std::vector<std::string> names);
  static void option(Member& m, SoftRange r) { m.soft = r; }
  static void option(Member& m, Logarithmic) { m.logarithmic = true; }
  static void option(Member& m, Meaning meaning) { m.meaning = meaning; }
  static void option(Member& m, Condition c);

 private:
  struct Opened {
    std::string name;
    size_t members = 0;  ///< number of members described before the group
  };
  ClassInfo& info_;
  std::optional<Opened> opened_;
};

/// The description of a component class, filled by its function `static void describe(Description<T>&)`.
template <class T>
class Description : public AnyDescription {
 public:
  explicit Description(ClassInfo& info) : AnyDescription(info) {}

  /// A sentence that says what the class is, and its source (a paper, a standard), if any.
  Description& summary(std::string_view text, std::string_view source = {}) {
    set_summary(text, source);
    return *this;
  }

  /// Starts a group: the following members, up to the next group, are shown together in a panel under this name.
  Description& group(std::string_view name) {
    open_group(name);
    return *this;
  }

  /// A member: its name in files, its unit ("1" for a dimensionless number, "" if it is not a number), its documentation, and
  /// any of range(), at_least(), more_than(), soft(), logarithmic, choices(), when(), unless(), required, Effect, Meaning. The
  /// C++ member stores its value in this unit.
  template <auto P, class... Options>
  Description& member(std::string_view name, std::string_view unit, std::string_view text, Options... options) {
    using Type = typename detail::PointerTo<P>::Type;
    static constexpr MemberType type{
        detail::Convert<Type>::kind,
        detail::IsVector<Type>::value,
        detail::in_double<Type>,
        [](const Component& c, const Member& self) { return detail::Convert<Type>::write(static_cast<const T&>(c).*P, self); },
        [](Component& c, const Member& self, const Value& v) { detail::Convert<Type>::read(v, self, static_cast<T&>(c).*P); },
        view<P, Type>(),
        exchange<P, Type>()};
    Member& m = add_member(name, unit, text, type, detail::referred_class<detail::Referee<Type>>());
    (option(m, std::move(options)), ...);
    return *this;
  }

  /// Removes an inherited member that would have no effect in this class; `why` is the reason in the error message if it is
  /// set.
  Description& without(std::string_view name, std::string_view why) {
    remove_member(name, why);
    return *this;
  }

  /// A plain value (a number, a colour) where this class's interface is expected is converted to an object of this class with
  /// that member set.
  Description& literal(std::string_view member) {
    set_literal(member);
    return *this;
  }

 private:
  template <auto P, class Type>
  static constexpr ListInMemory (*view())(const Component&) {
    if constexpr (detail::list_of_numbers<Type>)
      return [](const Component& c) { return detail::view_list(static_cast<const T&>(c).*P); };
    else
      return nullptr;
  }
  template <auto P, class Type>
  static constexpr void (*exchange())(Component&, std::shared_ptr<void>&) {
    if constexpr (detail::list_of_numbers<Type>)
      return [](Component& c, std::shared_ptr<void>& kept) { detail::exchange_list(static_cast<T&>(c).*P, kept); };
    else
      return nullptr;
  }
};

// ---- registration -------------------------------------------------------------------------------------------------

/// A node in the linked list of classes to be registered. Interfaces define the type `Interface` as themselves and `Parent` as
/// their parent class; concrete classes inherit `Interface`, which is their parent in the registry.
struct RegistrationNode {
  const std::type_info& type;
  const std::type_info& parent;
  void (*describe)(ClassInfo&);
  Ref<Component> (*make)(const ClassInfo&);
  RegistrationNode* next;
};

void enlist(RegistrationNode&) noexcept;

template <class T>
const std::type_info& parent_type() {
  if constexpr (std::is_same_v<T, Component>)
    return typeid(void);
  else if constexpr (std::is_same_v<T, typename T::Interface>)
    return typeid(typename T::Parent);
  else
    return typeid(typename T::Interface);
}

/// `static const Register<PhongShader> registered;` registers a class. The constructor only links a node into a list.
template <class T>
class Register {
 public:
  Register() noexcept { enlist(node_); }

 private:
  static Ref<Component> (*factory())(const ClassInfo&) {
    // An interface without pure virtual functions has a protected constructor, so that it counts as abstract.
    if constexpr (std::is_abstract_v<T> || !std::is_default_constructible_v<T>)
      return nullptr;
    else
      return [](const ClassInfo&) { return Ref<Component>(make<T>()); };
  }
  static void describe(ClassInfo& info) {
    Description<T> d(info);
    T::describe(d);
    d.finish();
  }
  static inline RegistrationNode node_{typeid(T), parent_type<T>(), describe, factory(), nullptr};
};

}  // namespace etendue
