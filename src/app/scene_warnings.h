#pragma once
// What a user should know about a scene or its picture that is no error: it will be black, or a part of it has no effect.

#include <map>
#include <string>
#include <vector>

#include "etendue/render/job.h"

namespace etendue {

struct SceneWarning {
  std::string kind;  ///< what is wrong, the same for all of its kind
  std::string text;  ///< what, why it matters and what to do
  Location at;
};

/// All of a prepared job's, in the order of its objects.
std::vector<SceneWarning> scene_warnings(const Job&);
/// The parts of it: what of its objects has no effect, or is not as its material needs it; and what the camera sees.
void warn_of_objects(const Job&, std::vector<SceneWarning>&);
void warn_of_view(const Job&, std::vector<SceneWarning>&);
/// Looks for luminaires some of whose light would leave a side that does not emit.
class LostLight {
 public:
  void look(const SceneObject&, std::vector<SceneWarning>&);

 private:
  std::map<const EmissionShader*, Ref<EmissionShader>> with_both_sides_;
  size_t looked_at_ = 0;
};
/// Of a component and all it refers to: members that were written, differ from the default, and do not matter.
void warn_of_members(const Component&, std::vector<SceneWarning>&);

/// Of a picture of a job: an output for display that is nearly all black or nearly all white, and by how much.
std::vector<SceneWarning> picture_warnings(const Job&, const std::vector<Ref<Output>>&, const Image& picture);

/// Prints them on standard error: the first few of each kind, and how many more there are.
void show_warnings(const std::vector<SceneWarning>&);

/// Whether a renderer's picture depends on light at all.
bool shows_light(const Renderer&);

}  // namespace etendue
