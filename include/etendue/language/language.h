#pragma once
// The render description language (scene file format): parsing files into components, and writing components to files.

#include <string>
#include <utility>
#include <vector>

#include "etendue/describe/component.h"
#include "etendue/describe/value.h"

namespace etendue {

/// Options of importers, which read the files of other programs (etendue/importer.h).
struct ImportOptions {
  bool strict = false;                       ///< anything that cannot be expressed exactly is an error, not a warning
  std::vector<std::string> allowed_folders;  ///< folders from which files may be read, besides the imported file's own folder
  double time = 0;                           ///< the time at which animated values are read [s]
};

struct LoadOptions {
  std::vector<std::pair<std::string, std::string>> defines;  ///< `-D name=value`: replace `param`s
  bool allow_files = true;  ///< false: include, plugin and spectrum("file") are errors, for descriptions from untrusted sources
  ImportOptions import = {};
  double frame = 0;       ///< the value of `frame` in the description: the index of the image in an animation
  double time = 0;        ///< the value of `time` in the description [s]
  bool animated = false;  ///< the description is read once for each frame: warns if it uses neither `frame` nor `time`
};

/// Parses one component, such as "Sphere { radius: 2 m }", which may be preceded by definitions; for tests and tools.
Ref<Component> parse_component(const std::string& text, const std::string& name = "text", const std::string& folder = {});
/// Parses a value written as an expression.
Value parse_value(const std::string& text, const std::string& name = "text", const std::string& folder = {});

/// Sets a member, given by a path of member names and list indices from a component: "renderer.max_depth",
/// "scene.objects[2].radius". The value is an expression; a bare word that is not a defined name is taken as a string or
/// choice.
void set_path(Component& root, const std::string& path, const std::string& expression);

/// A render description that reads back as an equal component. Components that are used twice are written once, with a name.
/// Only members that differ from their defaults are written, or with `all` every member. File paths are rewritten relative to
/// `folder` (empty: as they were written, and made absolute if they were relative to another folder).
std::string write_description(const Component&, bool all = false, const std::string& folder = {});
/// One value as an expression.
std::string write_value(const Value&);

/// The error message for the user: with its location, the line of the file and a caret.
///   box.etd:7:27: PathTracer has no member 'max_dept' (did you mean 'max_depth'?)
///       7 |     renderer: PathTracer { max_dept: 4 }
///         |                            ^
std::string show(const Error&);

}  // namespace etendue
