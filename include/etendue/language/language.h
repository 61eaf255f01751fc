#pragma once
// The render description language: files into components and back.

#include <string>
#include <utility>
#include <vector>

#include "etendue/describe/component.h"
#include "etendue/describe/value.h"

namespace etendue {

/// What is said to importers, which read the files of other programs (etendue/importer.h).
struct ImportOptions {
  bool strict = false;                       ///< what cannot be expressed exactly is an error, not a warning
  std::vector<std::string> allowed_folders;  ///< whose files a source may name, besides those in its own folder
  double time = 0;                           ///< of what is animated [s]
};

struct LoadOptions {
  std::vector<std::pair<std::string, std::string>> defines;  ///< `-D name=value`: replace `param`s
  bool allow_files = true;  ///< false: include, plugin and spectrum("file") are errors, for texts from strangers
  ImportOptions import = {};
  double frame = 0;       ///< what `frame` means in the description: which picture of a film it is read for
  double time = 0;        ///< what `time` means [s]
  bool animated = false;  ///< it is read once for each frame: there is a warning when it asks for neither
};

/// Any one component, such as "Sphere { radius: 2 m }", which definitions may precede; for tests and tools.
Ref<Component> parse_component(const std::string& text, const std::string& name = "text", const std::string& folder = {});
/// Any value written as an expression.
Value parse_value(const std::string& text, const std::string& name = "text", const std::string& folder = {});

/// Sets a member found by a path of names and list places from a component: "renderer.max_depth", "scene.objects[2].radius".
/// The value is an expression; a bare word is taken as a string or choice when it names nothing.
void set_path(Component& root, const std::string& path, const std::string& expression);

/// A render description that reads back as an equal component. What is used twice is written once and named. Only what
/// differs from its default is written, or everything when `all`. File paths are rewritten relative to `folder` (empty:
/// as they were written, made absolute if they came from elsewhere).
std::string write_description(const Component&, bool all = false, const std::string& folder = {});
/// One value as an expression.
std::string write_value(const Value&);

/// The error with its place, the line it is in and a caret: what a person should see.
///   box.etd:7:27: PathTracer has no member 'max_dept' (did you mean 'max_depth'?)
///       7 |     renderer: PathTracer { max_dept: 4 }
///         |                            ^
std::string show(const Error&);

}  // namespace etendue
