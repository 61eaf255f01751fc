#pragma once
// Files and texts into one namespace of definitions.

#include <map>
#include <string>
#include <vector>

#include "etendue/language/language.h"
#include "evaluator.h"

namespace etendue::language {

class Loader {
 public:
  explicit Loader(const LoadOptions& options)
      : options_(options), evaluator_(diagnostics_, options.allow_files, Moment{options.frame, options.time}) {}

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
  Node* root(bool job);

  const LoadOptions& options_;
  Diagnostics diagnostics_;
  Evaluator evaluator_;
  std::vector<std::pair<Node, Space*>> components_;
  bool whole_ = true;  // no file had to be given up half-way
  const char* main_ = "";
  std::map<std::pair<std::string, Space*>, Location> files_;  // read so far, in canonical spelling, and where they were named
  size_t again_ = 0, bytes_again_ = 0;                        // files that were read for names of their own
  std::vector<std::pair<std::string, std::string>> active_;   // being read: canonical spelling, and as written
};

}  // namespace etendue::language
