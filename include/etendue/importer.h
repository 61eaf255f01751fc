#pragma once
// Importer: a file of another program into components.

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

/// The structure that imported scenes are searched by: the fastest one on most scenes (docs/performance.md, "Structures").
inline constexpr const char* imported_structure = "BvhScene";

/// One file being imported: what it may read, and what was said of it. All importers find files, make parts and tell what they
/// could not express through it, so that these are the same for every format.
class Importing {
 public:
  /// `path` is the file; `parameters` are values for the source's own parameters, from `-D name=value`.
  Importing(std::string path, ImportOptions options, std::vector<std::pair<std::string, std::string>> parameters = {});

  const std::string& path() const { return path_; }
  const ImportOptions& options() const { return options_; }
  /// The whole file, or a place in it.
  Location at(int line = 0, int column = 0) const { return {name_, line, column}; }

  /// The value given to a parameter of the source ("spp" for Mitsuba's $spp), which counts as used then; none: there is none.
  std::optional<std::string> parameter(const std::string& name);

  /// Adds a folder in which files are looked for that are not beside what names them. Relative to the file's folder.
  void add_search_folder(const std::string& folder, Location at);
  /// The file that a source names: beside the file that names it (whose folder is `beside`, or empty: the imported file's), in
  /// the search folders, and, where the author's machine had other folders, by its last name alone, small letters and capitals
  /// aside. Throws Error at the place where there is none, or where it lies outside of the file's folder and of those allowed.
  std::string file(const std::string& named, Location at, const std::string& beside = {}) const;
  /// The same for what a scene can do without, such as a texture: nothing and a note when there is none.
  std::optional<std::string> optional_file(const std::string& named, Location at, const std::string& beside = {});

  /// The names of an image's channels. A file that many materials name is opened once. Throws Error where it cannot be read.
  const std::vector<std::string>& image_channels(const std::string& path);

  /// Notes what the source says and this program could not express, or only nearly: a warning, or an error when strict. The
  /// same words at several places are told once with their number. At most one call for each place and thing.
  void inexact(const std::string& what, Location at);
  /// All notes in the order of the places, one for each text.
  std::vector<Error> notes() const;

  /// A part of a class, made at a place of the source and named as there ("" without a name). Throws as the Registry does.
  Ref<Component> make(const std::string& class_name, Location at, const std::string& name = {}) const;

  /// Of files of models, which are looked at in light of the viewer's own: whether they have light. When it is false some is
  /// added. None: a Scene gets light when nothing in it emits, a Job never.
  std::optional<bool> is_lit;

  /// The direction that points upwards in the source's world, for the camera and the sky of a file that has none.
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

/// Sets a member of a part that an importer makes, as `set` does; what is wrong is an Error at the place.
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

  /// File name endings it reads, without dots, lower case.
  virtual std::vector<std::string> extensions() const = 0;
  /// What the file holds: a Job, or a Scene of objects when it knows no camera. Shared parts are shared and have the source's
  /// names (Component::origin). Throws Error, or Errors with all that is wrong, naming the file and the place in it.
  virtual Ref<Component> import(Importing&) const = 0;
};

/// The importer that reads files of this name, by its ending; null: none.
Ref<Importer> importer_of(const std::string& path);
/// All endings that importers read, sorted.
std::vector<std::string> imported_extensions();

}  // namespace etendue
