#pragma once
// The variants of a comparison: named ways to render a scene.

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "etendue/render/render.h"
#include "render/checkpoint.h"

namespace etendue::comparing {

/// A way to render: the scene with another renderer, or with some members set, or both.
struct Variant {
  std::string name;
  std::vector<std::pair<std::string, std::string>> sets;  ///< paths of members, and expressions
  Ref<Renderer> renderer = {};  ///< set before the members; null: that of the scene. It is copied for each scene.
};

/// The variants of "--renderers A,B{x: 1}" (each sets the renderer, and is named by its expression), followed by those of each
/// "--variant 'NAME: PATH=VALUE, PATH=VALUE'". Throws Errors for invalid ones or equal names.
std::vector<Variant> parse_variants(const std::string& renderers, const std::vector<std::string>& variants);

/// A variant on a scene, ready to be rendered.
struct Subject {
  std::string name;
  Render* render = nullptr;  ///< may be shared by several variants
  Ref<Renderer> renderer;    ///< to be set in `render` before use
  std::vector<std::string> misses;
  std::string bias;
  bool reaches_truth() const {
    return misses.empty() && bias.empty();
  }  ///< whether its mean is the truth, according to its renderer
};

/// All variants on one file. Variants that set only the renderer share one prepared scene; each other variant has its own.
class SceneSubjects {
 public:
  /// `load` creates the file's job anew, not prepared. Throws Errors.
  SceneSubjects(const std::function<Ref<Job>()>& load, const std::vector<Variant>&, int threads);

  const Job& job() const { return shared_->job(); }  ///< as in the file
  const std::vector<Subject>& subjects() const { return subjects_; }
  /// Sets a variant's renderer in its render, and returns the render.
  Render& ready(size_t variant);
  /// The identity of everything that determines a variant's samples.
  Identity identity(size_t variant);

 private:
  void add(const std::function<Ref<Job>()>& load, const Variant&, int threads);
  std::unique_ptr<Render> shared_;
  std::vector<std::unique_ptr<Render>> own_;
  std::vector<Subject> subjects_;
};

}  // namespace etendue::comparing
