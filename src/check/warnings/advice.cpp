// Warnings about the parts of a scene's light transport that a renderer cannot sample, with the renderers that can.

#include "advice.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/number_text.h"
#include "describe/guard.h"
#include "etendue/describe/registry.h"
#include "etendue/render/follows_polarization.h"
#include "scene_warnings.h"

namespace etendue {

namespace {

/// "a, b and c"
std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (size_t i = 0; i < names.size(); ++i) text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return text;
}

}  // namespace

std::string advice_text(const std::string& renderer, const Advice& advice) {
  const std::string text = renderer + " cannot find " + advice.lost + "; ";
  // This renderer class can find the light with default settings: its members, as set in the job, prevent it.
  if (std::ranges::find(advice.instead, renderer) != advice.instead.end()) return text + "with its members' defaults it can";
  if (advice.instead.empty()) return text + "no known renderer can";
  return text + listed(advice.instead) + " can";
}

std::vector<std::string> advice_lines(const Job& job) {
  std::vector<std::string> lines;
  if (const std::string bias = job.renderer->bias(); !bias.empty())
    lines.push_back(job.renderer->class_info().name + " is biased: " + bias);
  for (const Advice& advice : job.renderer->misses(scene_traits(*job.scene, *job.camera)))
    lines.push_back(advice_text(job.renderer->class_info().name, advice));
  if (const std::vector<std::string> plates = polarizing_plates(*job.scene);
      !plates.empty() && shows_light(*job.renderer) && !follows_polarization(*job.renderer))
    lines.push_back(fmt::format("{} takes all light for unpolarized, but {}{}; {} can", job.renderer->class_info().name,
                                plates[0],
                                plates.size() > 1 ? fmt::format(", and there are {} more such plates", plates.size() - 1) : "",
                                listed(polarization_followers())));
  return lines;
}

void advise(const Job& job) {
  for (const std::string& line : advice_lines(job)) warn(line);
}

std::vector<std::string> renderers_that_find_all(const SceneTraits& traits) {
  std::vector<std::string> names;
  for (const ClassInfo* info : Registry::instance().subclasses(*Registry::instance().find("Renderer")))
    if (ref_cast<Renderer>(create(*info))->misses(traits).empty()) names.push_back(info->name);
  return names;
}

std::string luminaires_text(const Scene& scene, const SceneTraits& traits) {
  size_t points = 0, distant = 0, areas = 0, environments = 0, nested = 0;
  for (const SceneObject* luminaire : scene.luminaires()) {
    ++(luminaire->delta() ? luminaire->infinite() ? distant : points : luminaire->infinite() ? environments : areas);
    nested += &luminaire->original() != luminaire;
  }
  std::string kinds;
  const auto add = [&](size_t count, const char* one, const char* several) {
    if (count > 0) kinds += fmt::format("{}{} {}", kinds.empty() ? ": " : ", ", grouped(count), count == 1 ? one : several);
  };
  add(points, "point light", "point lights");
  add(distant, "distant light", "distant lights");
  add(areas, "area light", "area lights");
  add(environments, "environment", "environments");
  add(traits.emissive_media.size(), "emitting volume", "emitting volumes");
  if (nested > 0) kinds += fmt::format("; {} in nested scenes", grouped(nested));
  return grouped(scene.luminaires().size() + traits.emissive_media.size()) + kinds;
}

}  // namespace etendue
