#pragma once
// A parsed Mitsuba scene: plugins with properties, references resolved, nothing interpreted yet.

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "etendue/core/error.h"
#include "etendue/core/spectral_function.h"
#include "etendue/core/transform.h"

namespace etendue::mitsuba {

struct Element;

/// A colour or spectrum stated by value.
struct ColorValue {
  enum class Kind { rgb, flat, table, blackbody } kind = Kind::rgb;
  Color color;
  double rgb[3] = {0, 0, 0};  ///< linear sRGB if `kind` is rgb; the number if it is flat
};

/// A transform; if it consists of a single `lookat`, also its arguments.
struct TransformValue {
  AnimatedTransform transform;
  struct LookAt {
    DoublePoint3 from, to;
    DoubleVector3 up;
  };
  std::optional<LookAt> look_at;
};

/// A nested plugin or a reference to one. The reader owns all plugins, which may refer to one another in cycles.
struct Nested {
  std::string reference;  ///< the id of a reference; "" for a plugin nested in place
  Element* element = nullptr;
};

struct Property {
  std::string name;  ///< in the spelling of Mitsuba 3; "" for a nested plugin without a name
  Location at;
  std::variant<bool, std::int64_t, double, std::string, DoubleVector3, TransformValue, ColorValue, Nested> value;
  mutable bool asked = false;
};

/// A plugin: `<bsdf type="diffuse" id="white">` and its contents. The converter queries properties by name; properties that
/// were never queried are reported at the end.
struct Element {
  std::string tag, type, id;
  Location at;
  bool old = false;    ///< written for a Mitsuba before version 2: colours are RGB only, some defaults differ
  std::string folder;  ///< of the file that contains the plugin; files that it names are searched there first
  std::vector<Property> properties;
  mutable std::vector<std::string> known;  ///< names queried so far
  mutable bool read = false, being_read = false;
  mutable bool dismissed = false;  ///< a warning already states that something replaces the plugin

  const Property* find(const std::string& name) const;
  bool has(const std::string& name) const { return find(name); }
  /// Throw Error at the property if its type is wrong; return the default if there is no property of this name.
  double number(const std::string& name, double otherwise) const;
  std::int64_t integer(const std::string& name, std::int64_t otherwise) const;
  bool boolean(const std::string& name, bool otherwise) const;
  std::string string(const std::string& name, const std::string& otherwise) const;
  DoubleVector3 vector(const std::string& name, const DoubleVector3& otherwise) const;
  TransformValue transform(const std::string& name = "to_world") const;
  /// The nested plugin of this name with one of these tags (separated by spaces; "" for any tag).
  const Element* nested(const std::string& name) const;
  /// All nested plugins with this tag, whatever their names.
  std::vector<const Element*> all(const std::string& nested_tag) const;
  /// Marks properties as used that make no difference in this program.
  void ignore(std::initializer_list<const char*> names) const {
    for (const char* name : names) find(name);
  }
  /// Suppresses the warnings about unused properties of this plugin.
  void dismiss() const { dismissed = true; }
  Location location_of(const std::string& name) const;
};

/// "a number", "a colour", for messages.
std::string kind_of(const Property&);

}  // namespace etendue::mitsuba
