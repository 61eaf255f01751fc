#pragma once
// Files and texts into one namespace of definitions.

#include <string>
#include <vector>

#include "etendue/language/language.h"
#include "evaluator.h"

namespace etendue::language {

class Loader {
 public:
  explicit Loader(const LoadOptions& options) : options_(options), evaluator_(diagnostics_, options.allow_files) {}

  void add_file(const std::string& path);
  void add_text(const std::string& text, const std::string& name, const std::string& folder);

  /// Replaces params, evaluates everything and gives the one component that stands for itself; of class Job when
  /// `job`. Throws Errors with all that is wrong.
  Ref<Component> result(bool job);

 private:
  void load(const std::string& path, Location named_at);
  void add(Source);
  void open_plugin(const Label&, const std::string& folder);
  void replace_params();
  Node* root(bool job);

  const LoadOptions& options_;
  Diagnostics diagnostics_;
  Evaluator evaluator_;
  std::vector<Node> components_;
  bool whole_ = true;  // no file had to be given up half-way
  const char* main_ = "";
  std::vector<std::string> files_;                           // read so far, in canonical spelling
  std::vector<std::pair<std::string, std::string>> active_;  // being read: canonical spelling, and as written
};

}  // namespace etendue::language
