#pragma once
// Files and texts into one namespace of definitions.

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "etendue/language/language.h"
#include "evaluator.h"

namespace etendue::language {

// Files of other programs, as an include sees them. Who reads them is told by whoever loads: importers are above the language.

/// A file of another program that was read.
class OtherFile {
 public:
  virtual ~OtherFile() = default;
  /// Its parts by name: those that have one there and, when it is included under a name, `scene`, `objects`, `camera`,
  /// `renderer` and `image`, as far as it has them.
  virtual std::vector<std::pair<std::string, Value>> names(bool with_main_parts) = 0;
  /// The whole of it: what rendering the file by itself renders.
  virtual Ref<Component> job() = 0;
  /// What is not as in the file. After all that is wanted was asked for.
  virtual std::vector<Error> notes() = 0;
  /// Which of the parameters that it was given nothing in it uses.
  virtual std::vector<std::string> unused_parameters() = 0;
};

/// How they are read; both throw nothing but Error and Errors.
struct OtherFiles {
  bool (*are_read)(const std::string& path) = nullptr;
  /// What the names of those that are read end in, without dots.
  std::vector<std::string> (*endings)() = nullptr;
  /// With values for its parameters.
  std::unique_ptr<OtherFile> (*read)(const std::string& path, const ImportOptions&,
                                     const std::vector<std::pair<std::string, std::string>>& parameters) = nullptr;
};

class Loader {
 public:
  /// Without `others` files of other programs are not included.
  explicit Loader(const LoadOptions& options, const OtherFiles* others = nullptr)
      : options_(options),
        other_files_(others),
        evaluator_(diagnostics_, options.allow_files, Moment{options.frame, options.time}) {}

  void add_file(const std::string& path);
  void add_text(const std::string& text, const std::string& name, const std::string& folder);

  /// Replaces params, evaluates everything and gives the one component that stands for itself; of class Job when
  /// `job`. Throws Errors with all that is wrong.
  Ref<Component> result(bool job);

 private:
  using Space = Evaluator::Space;

  /// False: nothing was read, as the file was there already or there was something wrong with it.
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
  /// A file of another program that is included; it is read when all descriptions are.
  struct Other {
    std::string path;
    Label file;
    std::vector<Definition> replaced;  // its parameters and what they are to be …
    Space* space;                      // that its names are in
    Space* written_in;                 // … in terms of the names of this one
    bool named = false;                // by the include
    std::unique_ptr<OtherFile> read = nullptr;
    std::vector<const bool*> used = {};  // whether each of its names was asked for
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
  bool whole_ = true;  // no file had to be given up half-way
  const char* main_ = "";
  std::map<std::pair<std::string, Space*>, Location> files_;  // read so far, in canonical spelling, and where they were named
  size_t again_ = 0, bytes_again_ = 0;                        // files that were read for names of their own
  std::vector<std::pair<std::string, std::string>> active_;   // being read: canonical spelling, and as written
  std::vector<Other> others_;
  Ref<Component> job_;                                             // of a file of another program, when it is the whole
  std::vector<std::pair<std::string, std::string>> left_defines_;  // of -D: those that no description has a param for
  std::set<std::string> used_defines_;                             // of these those that a file of another program has
};

/// A path without links and dots, by which files are the same.
std::string canonical_path(const std::string& path);

}  // namespace etendue::language
