#include "etendue/transport/path_classes.h"

#include <algorithm>
#include <array>

namespace etendue {
namespace {

using Names = std::vector<std::string>;

Names joined(const Names& a, const Names& b) {
  Names all = a;
  for (const std::string& name : b)
    if (std::find(all.begin(), all.end(), name) == all.end()) all.push_back(name);
  return all;
}

Names delta(const SceneTraits& t) { return joined(t.points, t.distant); }
Names extended(const SceneTraits& t) { return joined(t.areas, t.environments); }

/// A verb that follows names: "the Sphere sends", "the Sphere and the Box send".
std::string verb(const Names& names, const std::string& plural) { return " " + plural + (names.size() == 1 ? "s" : ""); }

/// "<before><names><after>"; empty if there are no names.
std::string told(const char* before, const Names& names, const std::string& after = "") {
  return names.empty() ? std::string() : before + some_of(names) + after;
}

std::string light_on_surfaces(const Names& luminaires, const SceneTraits& t) {
  return luminaires.empty() || t.smooth.empty() ? std::string()
                                                : "light of " + some_of(luminaires) + " on " + some_of(t.smooth);
}

std::string caustics(const Names& luminaires, const SceneTraits& t) {
  const Names onto = joined(t.smooth, t.media);
  if (luminaires.empty() || t.specular.empty() || onto.empty()) return {};
  return "light of " + some_of(luminaires) + " that " + some_of(t.specular) + verb(t.specular, "throw") + " onto " +
         some_of(onto) + " (caustics)";
}

constexpr std::array<PathClassInfo, 18> classes{{
    {seen_luminaires, "seen_luminaires", "luminaires that the camera sees directly",
     [](const SceneTraits& t) { return told("", t.seen_areas, " where the camera sees it directly"); }},
    {seen_environments, "seen_environments", "environments behind the scene",
     [](const SceneTraits& t) { return told("", t.seen_environments, " where the camera sees it directly"); }},
    {specular_views, "specular_views", "what the camera sees in mirrors or through glass",
     [](const SceneTraits& t) { return told("what the camera sees in or through ", t.specular); }},
    {area_light, "area_light", "light of luminaires with an extent on surfaces",
     [](const SceneTraits& t) { return light_on_surfaces(extended(t), t); }},
    {delta_light, "delta_light", "delta lights on surfaces",
     [](const SceneTraits& t) { return light_on_surfaces(delta(t), t); }},
    {diffuse_light, "diffuse_light", "light that diffuse surfaces send on to others",
     [](const SceneTraits& t) { return told("light that ", t.diffuse, verb(t.diffuse, "send") + " on to other surfaces"); }},
    {glossy_light, "glossy_light", "light that glossy surfaces send on to others",
     [](const SceneTraits& t) { return told("light that ", t.glossy, verb(t.glossy, "send") + " on to other surfaces"); }},
    {area_caustics, "area_caustics", "caustics of luminaires with an extent",
     [](const SceneTraits& t) { return caustics(extended(t), t); }},
    {delta_caustics_of_bodies, "delta_caustics", "caustics of delta lights",
     [](const SceneTraits& t) { return caustics(delta(t), t); }},
    {delta_caustics_in_mirrors, "delta_caustics_in_mirrors",
     "caustics of delta lights, where they are seen in mirrors or through glass",
     [](const SceneTraits& t) {
       const Names lamps = delta(t);
       if (caustics(lamps, t).empty()) return std::string();
       return "what " + some_of(t.specular) + verb(t.specular, "show") + " of caustics of " + some_of(lamps);
     }},
    {scattering_media, "scattering_media", "absorption and scattering in media",
     [](const SceneTraits& t) { return told("absorption and scattering in ", t.media); }},
    {emitting_media, "emitting_media", "light that media emit",
     [](const SceneTraits& t) {
       return told("light that ", t.emissive_media, verb(t.emissive_media, "send") + " out from within");
     }},
    {heterogeneous_media, "heterogeneous_media", "heterogeneous media",
     [](const SceneTraits& t) { return told("the heterogeneity of the media of ", t.heterogeneous_media); }},
    {subsurface_light, "subsurface_light", "light scattered inside bodies",
     [](const SceneTraits& t) { return told("light scattered inside ", t.subsurface_exits); }},
    {light_through_surfaces, "light_through_surfaces", "light through null-scattering surfaces",
     [](const SceneTraits& t) {
       return told("light that ", t.null_scattering, verb(t.null_scattering, "let") + " pass straight on");
     }},
    {delta_caustics_of_panes, "delta_caustics_of_panes", "caustics of delta lights at thin panes and masks",
     [](const SceneTraits& t) {
       const Names lamps = delta(t);
       if (caustics(lamps, t).empty() || t.null_scattering.empty()) return std::string();
       return "caustics of " + some_of(lamps) + " that " + some_of(t.null_scattering) + verb(t.null_scattering, "reflect") +
              " or" + verb(t.null_scattering, "let") + " pass";
     }},
    {fluorescent_surfaces, "fluorescent_surfaces", "fluorescence of surfaces",
     [](const SceneTraits& t) { return told("the fluorescence of ", t.fluorescent); }},
    {fluorescent_media, "fluorescent_media", "fluorescence of dyes in media",
     [](const SceneTraits& t) { return told("the fluorescence in ", t.dyed_media); }},
}};

}  // namespace

std::span<const PathClassInfo> path_classes() { return classes; }

PathClasses paths_in(const SceneTraits& traits) {
  PathClasses found = no_paths;
  for (const PathClassInfo& c : classes)
    if (!c.in(traits).empty()) found |= c.bit;
  return found;
}

}  // namespace etendue
