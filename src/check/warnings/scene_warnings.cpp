// Collects the warnings about a scene, and prints them.

#include "scene_warnings.h"

#include <fmt/format.h>

#include <map>

#include "core/number_text.h"

namespace etendue {

bool shows_light(const Renderer& renderer) {
  const std::string& name = renderer.class_info().name;
  return name != "FeatureRenderer" && name != "AmbientOcclusionRenderer";
}

std::vector<SceneWarning> scene_warnings(const Job& job) {
  std::vector<SceneWarning> list;
  if (shows_light(*job.renderer) && job.scene->luminaires().empty() &&
      scene_traits(*job.scene, *job.camera).emissive_media.empty())
    list.push_back({"dark",
                    "nothing emits light: the picture will be black; give an object an emission, or the scene an "
                    "Environment { emission: SkyEmission {} }",
                    job.scene->location_of("objects")});
  warn_of_objects(job, list);
  warn_of_view(job, list);
  warn_of_bands(job, list);
  warn_of_members(job, list);
  return list;
}

void show_warnings(const std::vector<SceneWarning>& list) {
  constexpr int most = 3;
  std::map<std::string, int> seen, all;
  for (const SceneWarning& w : list) ++all[w.kind];
  for (const SceneWarning& w : list) {
    const int number = ++seen[w.kind];
    if (number > most) continue;
    const int rest = all[w.kind] - most;
    warn(w.text + (number == most && rest > 0 ? fmt::format(" (and {} more like this)", grouped(std::uint64_t(rest))) : ""),
         w.at);
  }
}

}  // namespace etendue
