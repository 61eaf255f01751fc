#pragma once
// SceneTraits: what kinds of light transport a scene asks for. Renderers say by these what they cannot find.

#include <string>
#include <vector>

#include "etendue/camera.h"
#include "etendue/scene.h"
#include "etendue/shader.h"

namespace etendue {

struct SceneTraits {
  /// Each list names objects, as the user did, each once wherever its scene stands; empty: there are none of the kind.
  std::vector<std::string> specular;                       ///< surfaces with mirror-like lobes, pass-through aside
  std::vector<std::string> refracting;                     ///< those of them that transmit
  std::vector<std::string> smooth;                         ///< surfaces with diffuse or glossy lobes
  std::vector<std::string> diffuse;                        ///< surfaces with diffuse lobes
  std::vector<std::string> glossy;                         ///< surfaces with glossy lobes
  std::vector<std::string> points;                         ///< luminaires without extent at a finite place
  std::vector<std::string> distant;                        ///< luminaires that are a single direction
  std::vector<std::string> areas;                          ///< luminaires with an area
  std::vector<std::string> environments;                   ///< luminaires at infinity that rays can meet
  std::vector<std::string> seen_areas, seen_environments;  ///< of both, those that the camera sees
  std::vector<std::string> media;                          ///< objects with a scattering or absorbing volume
  std::vector<std::string> emissive_media;                 ///< objects with a volume that emits
  std::vector<std::string> heterogeneous_media;            ///< objects with a volume that differs from place to place
  std::vector<std::string> subsurface_exits;  ///< surfaces that light which enters leaves elsewhere (subsurface scattering)
  std::vector<std::string> null_scattering;   ///< surfaces that let light pass straight on
  bool pinhole = true;                        ///< the camera's lens is a point (or its rays parallel): no path meets it

  bool delta_luminaires() const { return !points.empty() || !distant.empty(); }
};

/// Looks at a prepared scene.
SceneTraits scene_traits(const Scene&, const Camera&);

/// "'lamp', 'bulb' and 3 more"
std::string some_of(const std::vector<std::string>& names);

}  // namespace etendue
