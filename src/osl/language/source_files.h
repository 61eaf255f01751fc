#pragma once
// Which files a shader may include, and their texts.

#include <optional>
#include <string>
#include <vector>

namespace etendue::osl {

/// Searches the files of `#include`. Only regular files below the shader's own folder or a given folder are read.
class SourceFiles {
 public:
  SourceFiles(const std::string& shader_file, const std::vector<std::string>& include_folders);

  struct Found {
    std::string path;      ///< empty: not found
    std::string reason;    ///< why not
    bool missing = false;  ///< there is no such file, not even one that may not be read
  };
  /// The file of `#include "name"` (`quoted`: first in the folder of the including file) or `#include <name>`.
  Found find(const std::string& name, bool quoted, const std::string& including_file) const;

  /// Throws Error with the reason, without the path.
  static std::string read(const std::string& path);

  /// The text of a standard header that is known by its name, since the library is built in; none for other names.
  static std::optional<std::string> standard_header(const std::string& name);

  /// The headers of our own, which stand in for files that were not found: the path under which one is read, empty if there is
  /// none of this name; and its text, none for other paths.
  static std::string built_in_path(const std::string& name);
  static std::optional<std::string> built_in(const std::string& path);

 private:
  bool allowed(const std::string& path) const;

  std::vector<std::string> folders_;  ///< in the order of the search
  std::vector<std::string> roots_;    ///< canonical
};

}  // namespace etendue::osl
