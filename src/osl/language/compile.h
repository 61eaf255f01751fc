#pragma once
// Compiles a text in the Open Shading Language to its typed tree.

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tree.h"

namespace etendue::osl {

struct CompileOptions {
  /// Folders in which `#include` searches, after the folder of the including file. Files that lie elsewhere are refused,
  /// devices and pipes always.
  std::vector<std::string> include_folders;
  /// Macros as the command line's -D defines them: name and text.
  std::vector<std::pair<std::string, std::string>> definitions;
  std::vector<std::string> removed_definitions;  ///< -U
  int most_errors = 20;                          ///< compilation stops there
};

struct Diagnostic {
  bool warning = false;
  Location place;
  std::string text;  ///< may have several lines
};

struct Compiled {
  std::shared_ptr<const Shader> shader;  ///< null if there is an error
  std::vector<Diagnostic> diagnostics;   ///< errors and warnings, in the order of the text
  std::vector<std::string> files;        ///< that were read: the shader's own file and all that it includes

  bool failed() const { return !shader; }
};

/// Never throws for what the text contains. A file that cannot be read is a diagnostic, too.
Compiled compile_file(const std::string& path, const CompileOptions& = {});
/// `name` stands for the file in messages; its folder is searched by `#include "..."`, if it has one.
Compiled compile_text(const std::string& text, const std::string& name, const CompileOptions& = {});

/// "marble.osl:3:14: error: ..." and so on, a line each.
std::string to_text(const std::vector<Diagnostic>&);

}  // namespace etendue::osl
