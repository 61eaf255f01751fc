#pragma once
// A Mitsuba scene as its parser leaves it: plugins with properties, references resolved, nothing interpreted yet.

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "etendue/core/error.h"
#include "etendue/core/spectral_function.h"
#include "etendue/core/transform.h"

namespace etendue::mitsuba {

struct Element;

/// A colour or a spectrum that is written out.
struct ColorValue {
  enum class Kind { rgb, flat, table, blackbody } kind = Kind::rgb;
  Color color;
  double rgb[3] = {0, 0, 0};  ///< linear sRGB, of an rgb; the number, of what is flat
};

/// A transform, and how it was said when that is one `lookat` alone.
struct TransformValue {
  AnimatedTransform transform;
  struct LookAt {
    DoublePoint3 from, to;
    DoubleVector3 up;
  };
  std::optional<LookAt> look_at;
};

/// A nested plugin or a reference to one. The reader owns all plugins, which may refer to one another in circles.
struct Nested {
  std::string reference;  ///< the id it is referred to by; "" when it stands where it is used
  Element* element = nullptr;
};

struct Property {
  std::string name;  ///< in the spelling of Mitsuba 3; "" of a nested plugin without a name
  Location at;
  std::variant<bool, std::int64_t, double, std::string, DoubleVector3, TransformValue, ColorValue, Nested> value;
  mutable bool asked = false;
};

/// A plugin: `<bsdf type="diffuse" id="white">` and what is in it. Whoever reads it asks for properties by name; those that
/// nobody has asked for are told at the end.
struct Element {
  std::string tag, type, id;
  Location at;
  bool old = false;    ///< written for a Mitsuba before 2: colours are RGB alone, some defaults differ
  std::string folder;  ///< of the file it stands in, where the files it names are looked for first
  std::vector<Property> properties;
  mutable std::vector<std::string> known;  ///< names asked for so far
  mutable bool read = false, being_read = false;
  mutable bool dismissed = false;  ///< it has been told that something else stands for it

  const Property* find(const std::string& name) const;
  bool has(const std::string& name) const { return find(name); }
  /// Of a type, else an Error at its place; the default when there is none of this name.
  double number(const std::string& name, double otherwise) const;
  std::int64_t integer(const std::string& name, std::int64_t otherwise) const;
  bool boolean(const std::string& name, bool otherwise) const;
  std::string string(const std::string& name, const std::string& otherwise) const;
  DoubleVector3 vector(const std::string& name, const DoubleVector3& otherwise) const;
  TransformValue transform(const std::string& name = "to_world") const;
  /// The nested plugin of this name with one of these tags (separated by spaces; "" for any).
  const Element* nested(const std::string& name) const;
  /// All nested plugins with this tag, whatever their names.
  std::vector<const Element*> all(const std::string& nested_tag) const;
  /// Properties that make no difference here.
  void ignore(std::initializer_list<const char*> names) const {
    for (const char* name : names) find(name);
  }
  /// Has what it says told no more where nothing reads it.
  void dismiss() const { dismissed = true; }
  Location location_of(const std::string& name) const;
};

/// "a number", "a colour", for messages.
std::string kind_of(const Property&);

}  // namespace etendue::mitsuba
