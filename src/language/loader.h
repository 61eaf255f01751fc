#pragma once
// Loader: reads files and texts into one namespace of definitions.

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "etendue/language/language.h"
#include "evaluator.h"

namespace etendue::language {

// Files of other programs, as an include uses them. The interface is passed to the Loader, because importers are in a layer
// above the language.

/// A file of another program that was read.
class OtherFile {
 public:
  virtual ~OtherFile() = default;
  /// The parts of the file by name: its named parts and, if it is included under a name, also `scene`, `objects`, `camera`,
  /// `renderer` and `image`, if it has them.
  virtual std::vector<std::pair<std::string, Value>> names(bool with_main_parts) = 0;
  /// The complete job: what is rendered if the file itself is rendered.
  virtual Ref<Component> job() = 0;
  /// Messages about differences from the file. To be called after names() and job().
  virtual std::vector<Error> notes() = 0;
  /// The given parameters that nothing in the file uses.
  virtual std::vector<std::string> unused_parameters() = 0;
};

/// Access to the importers; both functions throw only Error and Errors.
struct OtherFiles {
  bool (*are_read)(const std::string& path) = nullptr;
  /// The extensions of the files that can be read, without dots.
  std::vector<std::string> (*endings)() = nullptr;
  /// Reads a file with values for its parameters.
  std::unique_ptr<OtherFile> (*read)(const std::string& path, const ImportOptions&,
                                     const std::vector<std::pair<std::string, std::string>>& parameters) = nullptr;
};

class Loader {
 public:
  /// Without `others`, files of other programs cannot be included.
  explicit Loader(const LoadOptions& options, const OtherFiles* others = nullptr)
      : options_(options),
        other_files_(others),
        evaluator_(diagnostics_, options.allow_files, Moment{options.frame, options.time}) {}

  void add_file(const std::string& path);
  void add_text(const std::string& text, const std::string& name, const std::string& folder);

  /// Replaces params, evaluates everything and returns the one unnamed component; it must be a Job if `job`. Throws Errors with
  /// all errors.
  Ref<Component> result(bool job);

 private:
  using Space = Evaluator::Space;

  /// Returns false if nothing was read, because the file was read before or has an error.
  bool load(const std::string& path, Location named_at, Space&, bool again);
  void add(Source, Space&);
  void include(Inclusion&, const std::string& folder, Space&);
  const Location* included_at(const std::string& spelling, Space&) const;
  bool may_read_again(size_t size, Location named_at);
  void open_plugin(const Label&, const std::string& folder);
  void replace_params();
  void refuse_unknown_params();
  Node* root(bool job);

  // including/include_other.cpp
  /// An included file of another program; it is read after all descriptions.
  struct Other {
    std::string path;
    Label file;
    std::vector<Definition> replaced;  // its parameters and their new values …
    Space* space;                      // the namespace of its names
    Space* written_in;                 // … which are expressions in this namespace
    bool named = false;                // whether it was included under a name
    std::unique_ptr<OtherFile> read = nullptr;
    std::vector<const bool*> used = {};  // whether each of its names was used
  };
  bool include_other(Inclusion&, const std::string& path, Space& target, Space& written_in);
  std::vector<std::pair<std::string, std::string>> parameters_of(Other&);
  void read_other(Other&, bool stands_for_itself);
  void read_others(bool job);
  void warn_of_unused_others() const;

  const LoadOptions& options_;
  const OtherFiles* other_files_;
  Diagnostics diagnostics_;
  Evaluator evaluator_;
  std::vector<std::pair<Node, Space*>> components_;
  bool whole_ = true;  // false if a file could not be read completely
  const char* main_ = "";
  std::map<std::pair<std::string, Space*>, Location> files_;  // files read so far, by canonical path, and where they were named
  size_t again_ = 0, bytes_again_ = 0;                        // files that were read for a namespace of their own
  std::vector<std::pair<std::string, std::string>> active_;   // files being read: canonical path, and path as written
  std::vector<Other> others_;
  Ref<Component> job_;  // from a file of another program, if it is the whole description
  std::vector<std::pair<std::string, std::string>> left_defines_;  // the -D options for which no description has a param
  std::set<std::string> used_defines_;                             // of these, the options that a file of another program uses
};

/// A path without links and dots, by which files are compared.
std::string canonical_path(const std::string& path);

}  // namespace etendue::language
