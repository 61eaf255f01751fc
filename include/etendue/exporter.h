#pragma once
// Exporter: components into a file of another program.

#include <map>
#include <set>
#include <string>
#include <vector>

#include "etendue/describe/component.h"
#include "etendue/describe/description.h"

namespace etendue {

class Job;
struct ContainedFile;

/// One file being exported: what is written beside it, and what was said of it.
class Exporting {
 public:
  explicit Exporting(std::string path);

  const std::string& path() const { return path_; }
  /// The folder it is written to, and its name without folder and ending.
  const std::string& folder() const { return folder_; }
  const std::string& stem() const { return stem_; }

  /// Notes what the other program cannot express, or only nearly, at the place where the part, or a member of it, was written.
  /// The same words about several parts are told once with their number.
  void inexact(const std::string& what, const Component* of = nullptr, std::string_view member = {});
  /// All notes, one for each text, in the order in which they came.
  std::vector<Error> notes() const;

  /// Has a file written beside the one that is exported, such as a mesh, and gives its name there: the stem, `what` and a
  /// number, with the ending. No file that is read has that name.
  std::string write_beside(const std::string& what, const std::string& ending, std::string bytes);
  /// The name by which the exported file can name a file that there is: a copy beside it unless it lies in the same folder or
  /// below. Of what lies in another file, such as an image in a model, always a copy.
  std::string copy_beside(const std::string& path);
  /// The files that are to be written beside it; none is before write_files is called.
  std::vector<std::string> files_beside() const;
  void write_files() const;
  /// A name that no other part has, made of letters, digits and underscores.
  std::string name_for(const Component&);

 private:
  struct Note {
    std::string what;
    Location first;
    size_t count = 0;
  };
  struct Beside {
    std::string path;
    std::string bytes;   ///< what it holds, or
    std::string source;  ///< the file that it is a copy of
  };
  std::string unpack_beside(const std::string& path, const ContainedFile&);
  /// Whether nothing that is read, and nothing else that is written, is called so.
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

  /// File name endings it writes, without dots, lower case.
  virtual std::vector<std::string> extensions() const = 0;
  /// The contents of the file. The job is as it was read, not prepared; what must be prepared is a copy.
  virtual std::string write(const Job&, Exporting&) const = 0;
};

/// The exporter that writes files of this name, by its ending; null: none.
Ref<Exporter> exporter_of(const std::string& path);
/// All endings that exporters write, sorted.
std::vector<std::string> exported_extensions();

}  // namespace etendue
