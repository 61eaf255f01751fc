#pragma once
// Classes of light transport paths, by their kinds of vertices. A renderer finds some classes, and a scene has light in some.
// From the two sets follow the advice to users, the choice of renderers that `verify` compares, and the limits listed in the
// manual.

#include <cstdint>
#include <span>
#include <string>

#include "etendue/transport/scene_traits.h"

namespace etendue {

/// Classes of light, as bits. A renderer finds a class if its expected value contains all light of that class.
enum PathClass : std::uint32_t {
  seen_luminaires = 1u << 0,            ///< emitters with an area, directly visible to the camera
  seen_environments = 1u << 1,          ///< emitters at infinity, directly visible to the camera
  specular_views = 1u << 2,             ///< specular reflections and refractions seen by the camera
  area_light = 1u << 3,                 ///< direct light on surfaces of emitters that are not delta lights
  delta_light = 1u << 4,                ///< direct light on surfaces of delta lights
  diffuse_light = 1u << 5,              ///< indirect light from diffuse surfaces
  glossy_light = 1u << 6,               ///< indirect light from glossy surfaces
  area_caustics = 1u << 7,              ///< caustics of emitters that are not delta lights
  delta_caustics_of_bodies = 1u << 8,   ///< other caustics of delta lights
  delta_caustics_in_mirrors = 1u << 9,  ///< caustics of delta lights, seen in specular reflection or refraction
  scattering_media = 1u << 10,          ///< absorption and scattering in media
  emitting_media = 1u << 11,            ///< emission of media
  heterogeneous_media = 1u << 12,       ///< heterogeneous media
  subsurface_light = 1u << 13,          ///< subsurface scattering with separate entry and exit points
  light_through_surfaces = 1u << 14,    ///< null scattering at surfaces
  delta_caustics_of_panes = 1u << 15,   ///< caustics of delta lights where thin panes or masks reflect light or let it pass
  fluorescent_surfaces = 1u << 16,      ///< fluorescence of surfaces
  fluorescent_media = 1u << 17,         ///< fluorescence of dyes in media
};
using PathClasses = std::uint32_t;
inline constexpr PathClasses no_paths = 0;
inline constexpr PathClasses all_paths = (1u << 18) - 1;
/// Paths whose wavelength changes: only algorithms that follow this find them (transport/fluorescence.h).
inline constexpr PathClasses fluorescence = fluorescent_surfaces | fluorescent_media;
/// All caustics of delta lights.
inline constexpr PathClasses delta_caustics = delta_caustics_of_bodies | delta_caustics_of_panes;

/// Names and descriptions of a class.
struct PathClassInfo {
  PathClass bit;
  const char* name;  ///< for programs: "delta_caustics"
  const char* what;  ///< for users, of any scene: "light of luminaires without extent that …"
  /// For users, of a given scene: "light of 'lamp' that 'ball' throws onto 'floor' (caustics)". Empty: the scene has no such
  /// light.
  std::string (*in)(const SceneTraits&);
};

/// All classes, in the order of their bits.
std::span<const PathClassInfo> path_classes();

/// The classes that a scene has light of.
PathClasses paths_in(const SceneTraits&);

}  // namespace etendue
