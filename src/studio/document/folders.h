#pragma once
// The files that a studio may access, and the files that a description names.

#include <set>
#include <string>
#include <vector>

#include "etendue/render/job.h"
#include "studio/text/outline.h"

namespace etendue::studio {

/// Folders outside of which nothing is read, written or listed. Symbolic links are resolved before the check.
class Folders {
 public:
  /// Throws Error if the path is not a folder.
  void allow(const std::string& folder);
  const std::vector<std::string>& all() const { return folders_; }
  /// The path without links and "..", as far as it exists. Throws Error if it is outside of all folders.
  std::string inside(const std::string& path) const;
  bool contains(const std::string& path) const;

 private:
  std::vector<std::string> folders_;  // canonical
};

/// A path without links, ".." and doubled slashes, as far as it exists.
std::string canonical_path(const std::string& path);

/// A file named in a text, and the location of the name.
struct NamedFile {
  std::string path;
  Location at;
};
/// The files that a text names to be read while it is loaded: included files, plugins, and all strings that are paths of
/// existing files, such as spectra.
std::vector<NamedFile> files_loaded_by(const Outline&, const std::string& folder);
/// The files named by members of a job, including output files.
std::vector<NamedFile> files_named_by(const Job&);

}  // namespace etendue::studio
