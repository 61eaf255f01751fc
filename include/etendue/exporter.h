#pragma once
// Exporter: writes a Job to a scene file of another program (pbrt, Mitsuba, glTF, …). pbrt and Mitsuba have no such plugin
// type.
//
// A new exporter must implement `extensions` and `write`. It writes additional files and reports warnings through the class
// Exporting.

#include <map>
#include <set>
#include <string>
#include <vector>

#include "etendue/describe/component.h"
#include "etendue/describe/description.h"

namespace etendue {

class Job;
struct ContainedFile;

/// The context of exporting one file: the additional files that are written to its folder, and the warnings so far.
class Exporting {
 public:
  explicit Exporting(std::string path);

  const std::string& path() const { return path_; }
  /// The folder of the exported file, and its name without folder and extension.
  const std::string& folder() const { return folder_; }
  const std::string& stem() const { return stem_; }

  /// Notes something that the other program cannot express, or only approximately, with the location where the component, or
  /// its member, was written. The same text about several components is reported once, with their number.
  void inexact(const std::string& what, const Component* of = nullptr, std::string_view member = {});
  /// All notes, one for each text, in the order of their first calls.
  std::vector<Error> notes() const;

  /// Schedules an additional file, such as a mesh, for the exported file's folder, and returns its name: the stem, `what` and a
  /// number, with the extension. The name differs from all input files of the scene, which therefore are not overwritten.
  std::string write_beside(const std::string& what, const std::string& ending, std::string bytes);
  /// The path by which the exported file can refer to an existing file. Unless the file lies in the same folder or below it, it
  /// is scheduled to be copied to that folder. A file contained in another one, such as an image in a model, is always
  /// extracted to a copy.
  std::string copy_beside(const std::string& path);
  /// The paths of the additional files; they are written by write_files only.
  std::vector<std::string> files_beside() const;
  void write_files() const;
  /// A unique name for a component, made of letters, digits and underscores.
  std::string name_for(const Component&);

 private:
  struct Note {
    std::string what;
    Location first;
    size_t count = 0;
  };
  struct Beside {
    std::string path;
    std::string bytes;   ///< its content, or
    std::string source;  ///< the path of the file to copy
  };
  std::string unpack_beside(const std::string& path, const ContainedFile&);
  /// Whether the path is neither that of an input file nor of another additional file.
  bool is_free(const std::string& path) const;

  std::string path_, folder_, stem_;
  std::vector<Beside> beside_;
  std::set<std::string> taken_paths_;
  std::vector<Note> notes_;
  std::map<std::string, size_t> note_of_;
  std::map<std::string, int> numbers_, taken_;
  std::map<std::string, std::string> copied_;
  std::map<const Component*, std::string> names_;
};

class Exporter : public Component {
 public:
  using Interface = Exporter;
  using Parent = Component;
  static void describe(Description<Exporter>&);

  /// The file name extensions that it writes, without dots, in lower case.
  virtual std::vector<std::string> extensions() const = 0;
  /// The content of the file. The job was read but not prepared; a component that must be prepared must be copied first.
  virtual std::string write(const Job&, Exporting&) const = 0;
};

/// The exporter for a file, by its extension; null: none.
Ref<Exporter> exporter_of(const std::string& path);
/// All extensions that exporters write, sorted.
std::vector<std::string> exported_extensions();

}  // namespace etendue
