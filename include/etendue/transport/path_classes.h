#pragma once
// Classes of light transport paths, by what is on them. What a renderer finds is a set of them; what a scene asks for is
// another; what the user is advised, which renderers `verify` compares, and what the manual says of limits follow from the two.

#include <cstdint>
#include <span>
#include <string>

#include "etendue/transport/scene_traits.h"

namespace etendue {

/// Kinds of light, as bits. A renderer finds a kind when its expectation holds all light of the kind.
enum PathClass : std::uint32_t {
  seen_luminaires = 1u << 0,            ///< luminaires with an area, seen by the camera
  seen_environments = 1u << 1,          ///< luminaires at infinity, seen by the camera
  specular_views = 1u << 2,             ///< what the camera sees in mirrors and through glass
  area_light = 1u << 3,                 ///< light that comes from luminaires with an extent to surfaces that scatter it
  delta_light = 1u << 4,                ///< light that comes from luminaires without extent to surfaces that scatter it
  diffuse_light = 1u << 5,              ///< light that matt surfaces send to others
  glossy_light = 1u << 6,               ///< light that glossy surfaces send to others
  area_caustics = 1u << 7,              ///< light of luminaires with an extent that specular surfaces throw onto others
  delta_caustics = 1u << 8,             ///< light of luminaires without extent that specular surfaces throw onto others
  delta_caustics_in_mirrors = 1u << 9,  ///< those, seen in mirrors and through glass
  scattering_media = 1u << 10,          ///< absorption and scattering in media
  emitting_media = 1u << 11,            ///< light that media send out
  heterogeneous_media = 1u << 12,       ///< media that differ from place to place
  subsurface_light = 1u << 13,          ///< light that leaves a body where it did not enter
  light_through_surfaces = 1u << 14,    ///< light that surfaces let pass straight on
};
using PathClasses = std::uint32_t;
inline constexpr PathClasses no_paths = 0;
inline constexpr PathClasses all_paths = (1u << 15) - 1;

/// What there is to say of a class.
struct PathClassInfo {
  PathClass bit;
  const char* name;  ///< for programs: "delta_caustics"
  const char* what;  ///< for people, of any scene: "light of luminaires without extent that …"
  /// For people, of a scene: "light of 'lamp' that 'ball' throws onto 'floor' (caustics)". Empty: the scene has no such light.
  std::string (*in)(const SceneTraits&);
};

/// All classes, in the order of their bits.
std::span<const PathClassInfo> path_classes();

/// The classes of which a scene has light.
PathClasses paths_in(const SceneTraits&);

}  // namespace etendue
