#pragma once
// Importer: reads a scene file of another program (pbrt, Mitsuba, glTF, …) into components. pbrt and Mitsuba have no such
// plugin type.
//
// A new importer must implement `extensions` and `import`. It finds files, makes components and reports warnings through the
// class Importing.

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "etendue/describe/component.h"
#include "etendue/describe/description.h"
#include "etendue/language/language.h"

namespace etendue {

/// The acceleration structure of imported scenes: the fastest one on most scenes (docs/performance.md, "Structures").
inline constexpr const char* imported_structure = "BvhScene";

/// The context of importing one file: the files that may be read, and the warnings so far. All importers find files, make
/// components and report what they could not express through this class, so that this is the same for every format.
class Importing {
 public:
  /// `path` is the file; `parameters` are values for the source's own parameters, from `-D name=value`.
  Importing(std::string path, ImportOptions options, std::vector<std::pair<std::string, std::string>> parameters = {});

  const std::string& path() const { return path_; }
  const ImportOptions& options() const { return options_; }
  /// All bytes of the file; if its name ends in ".gz", those that were compressed. Throws Error with the file's location if it
  /// cannot be read, or is damaged.
  std::string contents() const { return contents(path_, at()); }
  /// The same for another file, by the path that `file` has returned; `at` is where the source refers to it.
  std::string contents(const std::string& path, Location at) const;
  /// The location of a line and column in the file, or of the file as a whole (line 0).
  Location at(int line = 0, int column = 0) const { return {name_, line, column}; }

  /// The value given by the user to a parameter of the source ("spp" for Mitsuba's $spp), which is marked as used; empty: no
  /// value was given.
  std::optional<std::string> parameter(const std::string& name);

  /// Adds a search folder for files that are not in the folder of the file that refers to them. Relative to the imported file's
  /// folder.
  void add_search_folder(const std::string& folder, Location at);
  /// The path of a file that the source refers to. It is searched in the folder of the referring file (`beside`; empty: the
  /// imported file's folder) and in the search folders; if it is not found, as the folders on the author's machine were
  /// different, by its name without folders, ignoring case. Throws Error with the location if the file does not exist, or lies
  /// outside of the imported file's folder and the allowed folders.
  std::string file(const std::string& named, Location at, const std::string& beside = {}) const;
  /// The same for an optional file, such as a texture: if it is not found, returns empty and notes a warning.
  std::optional<std::string> optional_file(const std::string& named, Location at, const std::string& beside = {});

  /// The names of an image's channels. The result is cached, so that a file used by many materials is opened once. Throws Error
  /// if the file cannot be read.
  const std::vector<std::string>& image_channels(const std::string& path);

  /// Notes something in the source that this program cannot express, or only approximately: a warning, or an error with
  /// ImportOptions::strict. The same text at several locations is reported once, with their number. Call it at most once for
  /// each location and text.
  void inexact(const std::string& what, Location at);
  /// All notes in the order of their first calls, one for each text; then the parameters that the file does not have.
  std::vector<Error> notes() const;

  /// Makes a component of a class, with its location and name in the source ("": no name). Throws as Registry::create.
  Ref<Component> make(const std::string& class_name, Location at, const std::string& name = {}) const;

  /// Whether the file contains lights. Set by importers of model formats, whose viewers supply their own lighting. If false,
  /// lights are added. If empty, lights are added to an imported Scene in which nothing emits, and never to a Job.
  std::optional<bool> is_lit;

  /// The up direction of the source's world, for the default camera and sky of a file without them.
  DoubleVector3 up{0, 1, 0};

 private:
  struct Note {
    Location first;
    size_t count = 0, order = 0;
  };
  std::optional<std::string> find(const std::string& named, const std::string& beside, std::string& why_not) const;
  bool allowed(const std::string& path) const;

  std::string path_, folder_;
  const char* name_;
  ImportOptions options_;
  std::vector<std::pair<std::string, std::string>> parameters_;
  std::vector<bool> used_;
  std::vector<std::string> search_folders_;
  std::map<std::string, std::vector<std::string>> channels_;  // of images
  std::map<std::string, Note> notes_;
};

/// Sets a member of a component made by an importer, as `set` does; throws Error with the location if the value is invalid.
template <class T>
void set_member(Component& part, std::string_view member, T value, Location at) {
  set(part, member, Value(std::move(value), at));
}
inline void set_member(Component& part, std::string_view member, double value, Location at) {
  set(part, member, Value(Number{value}, at));
}
inline void set_member(Component& part, std::string_view member, int value, Location at) {
  set(part, member, Value(Number{double(value)}, at));
}
inline void set_member(Component& part, std::string_view member, const char* value, Location at) {
  set(part, member, Value(std::string(value), at));
}

class Importer : public Component {
 public:
  using Interface = Importer;
  using Parent = Component;
  static void describe(Description<Importer>&);

  /// The file name extensions that it reads, without dots, in lower case.
  virtual std::vector<std::string> extensions() const = 0;
  /// Reads the file: returns a Job, or a Scene if the format has no cameras. Components that are shared in the source are
  /// shared in the result, and have their names in the source (Component::origin). Throws Error, or Errors with all errors
  /// found, with the file and the location in it.
  virtual Ref<Component> import(Importing&) const = 0;
};

/// The importer for a file, by its extension; null: none.
Ref<Importer> importer_of(const std::string& path);
/// All extensions that importers read, sorted.
std::vector<std::string> imported_extensions();

}  // namespace etendue
