#pragma once
// SceneTraits: the kinds of objects in a scene that decide which light transport algorithms can render it (path_classes.h).

#include <string>
#include <vector>

#include "etendue/camera.h"
#include "etendue/scene.h"
#include "etendue/shader.h"

namespace etendue {

struct SceneTraits {
  /// Each list contains the names of objects in the file, each once even if its scene is instantiated several times; empty:
  /// there are none.
  std::vector<std::string> specular;                       ///< surfaces with specular lobes, null scattering aside
  std::vector<std::string> refracting;                     ///< those of them with specular transmission
  std::vector<std::string> smooth;                         ///< surfaces with diffuse or glossy lobes
  std::vector<std::string> diffuse;                        ///< surfaces with diffuse lobes
  std::vector<std::string> glossy;                         ///< surfaces with glossy lobes
  std::vector<std::string> points;                         ///< delta lights at a finite position
  std::vector<std::string> distant;                        ///< delta lights at infinity: a single direction
  std::vector<std::string> areas;                          ///< emitters with an area
  std::vector<std::string> environments;                   ///< emitters at infinity that escaping rays can hit
  std::vector<std::string> seen_areas, seen_environments;  ///< those of both that are visible to the camera
  std::vector<std::string> media;                          ///< objects with a medium inside
  std::vector<std::string> emissive_media;                 ///< objects with a medium that emits
  std::vector<std::string> heterogeneous_media;            ///< objects with a heterogeneous medium
  std::vector<std::string> subsurface_exits;  ///< surfaces with subsurface scattering that has separate exit points
  std::vector<std::string> null_scattering;   ///< surfaces with null scattering
  std::vector<std::string> fluorescent;       ///< surfaces that fluoresce
  std::vector<std::string> dyed_media;        ///< objects with a medium that fluoresces
  bool pinhole = true;                        ///< the camera's lens is a point (or its rays are parallel): no path hits it

  bool delta_luminaires() const { return !points.empty() || !distant.empty(); }
};

/// The traits of a prepared scene.
SceneTraits scene_traits(const Scene&, const Camera&);

/// "'lamp', 'bulb' and 3 more"
std::string some_of(const std::vector<std::string>& names);

}  // namespace etendue
