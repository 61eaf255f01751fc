#pragma once
// Warnings about a scene or its image that are no errors: the image will be black, or a part of the scene has no effect.

#include <map>
#include <string>
#include <vector>

#include "etendue/render/job.h"

namespace etendue {

struct SceneWarning {
  std::string kind;  ///< the kind of problem, to group warnings
  std::string text;  ///< the problem, its consequence and a remedy
  Location at;
};

/// All warnings about a prepared job, in the order of its objects.
std::vector<SceneWarning> scene_warnings(const Job&);
/// The parts of scene_warnings: objects' members without effect and surfaces that are not as their materials require; the
/// camera's view.
void warn_of_objects(const Job&, std::vector<SceneWarning>&);
void warn_of_view(const Job&, std::vector<SceneWarning>&);
/// Bands of the image that stay black, as no path carries a wavelength in them.
void warn_of_bands(const Job&, std::vector<SceneWarning>&);
/// Warns of emitters whose emission profile sends part of its power into a side that does not emit.
class LostLight {
 public:
  void look(const SceneObject&, std::vector<SceneWarning>&);

 private:
  std::map<const EmissionShader*, Ref<EmissionShader>> with_both_sides_;
  size_t looked_at_ = 0;
};
/// For a component and all it refers to: warns of members that were written, differ from the default, and have no effect.
void warn_of_members(const Component&, std::vector<SceneWarning>&);

/// Warns of an output for display in which nearly all lit pixels are black or nearly all are white, with the exposure that
/// corrects it.
std::vector<SceneWarning> picture_warnings(const Job&, const std::vector<Ref<Output>>&, const Image& picture);

/// Prints the warnings on standard error: the first few of each kind, and the number of the others.
void show_warnings(const std::vector<SceneWarning>&);

/// Whether a renderer's image depends on light transport at all.
bool shows_light(const Renderer&);

}  // namespace etendue
