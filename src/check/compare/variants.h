#pragma once
// What is compared: ways to render a scene, by name.

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "etendue/render/render.h"
#include "render/checkpoint.h"

namespace etendue::comparing {

/// A way to render, as the command line says it: the file with some members set.
struct Variant {
  std::string name;
  std::vector<std::pair<std::string, std::string>> sets;  ///< paths of members, and expressions
};

/// Those of "--renderers A,B{x: 1}" (each sets the renderer, and is called as it is written) and then of each
/// "--variant 'NAME: PATH=VALUE, PATH=VALUE'". Throws Errors when one makes no sense, or two have one name.
std::vector<Variant> parse_variants(const std::string& renderers, const std::vector<std::string>& variants);

/// A variant on a scene, ready to be rendered.
struct Subject {
  std::string name;
  Render* render = nullptr;  ///< several variants may share one
  Ref<Renderer> renderer;    ///< to be put into it first
  std::vector<std::string> misses;
  std::string bias;
  bool reaches_truth() const { return misses.empty() && bias.empty(); }  ///< in its mean, by what it says of itself
};

/// All variants on one file. Those that set no more than the renderer share one prepared scene; each other has its own.
class SceneSubjects {
 public:
  /// `load` makes the file's job anew, not prepared. Throws Errors.
  SceneSubjects(const std::function<Ref<Job>()>& load, const std::vector<Variant>&, int threads);

  const Job& job() const { return shared_->job(); }  ///< as the file has it
  const std::vector<Subject>& subjects() const { return subjects_; }
  /// Puts a variant's renderer into its render.
  Render& ready(size_t variant);
  /// What determines the samples of a variant.
  Identity identity(size_t variant);

 private:
  void add(const std::function<Ref<Job>()>& load, const Variant&, int threads);
  std::unique_ptr<Render> shared_;
  std::vector<std::unique_ptr<Render>> own_;
  std::vector<Subject> subjects_;
};

}  // namespace etendue::comparing
