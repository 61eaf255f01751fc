#pragma once
// Which files a studio may touch, and which of them a description names.

#include <set>
#include <string>
#include <vector>

#include "etendue/render/job.h"
#include "studio/text/outline.h"

namespace etendue::studio {

/// Folders outside of which nothing is read, written or listed. Links are followed before anything is decided.
class Folders {
 public:
  /// Throws Error when it is no folder.
  void allow(const std::string& folder);
  const std::vector<std::string>& all() const { return folders_; }
  /// The path without links and "..", as far as it exists. Throws Error when it is outside of all folders.
  std::string inside(const std::string& path) const;
  bool contains(const std::string& path) const;

 private:
  std::vector<std::string> folders_;  // canonical
};

/// A path without links, ".." and doubled slashes, as far as it exists.
std::string canonical_path(const std::string& path);

/// A file that a text names, and where.
struct NamedFile {
  std::string path;
  Location at;
};
/// What a text names as a file to be read while it is loaded: files to include, plugins, and all texts that are paths of files
/// which exist, spectra among them.
std::vector<NamedFile> files_loaded_by(const Outline&, const std::string& folder);
/// The files that members of a job name, those to be written among them.
std::vector<NamedFile> files_named_by(const Job&);

}  // namespace etendue::studio
