#pragma once
// FirstSurfaces: what camera rays meet first, for the layers of a picture that show surfaces (src/film/surface_layers.h).

#include <unordered_map>

#include "etendue/object_map.h"
#include "etendue/transport/medium_stack.h"
#include "etendue/transport/object_groups.h"
#include "etendue/transport/sample_context.h"
#include "film/surface_tile.h"
#include "object_names.h"

namespace etendue {

class FirstSurfaces {
 public:
  /// All must outlive it. The scene and the camera are prepared.
  FirstSurfaces(const Scene&, const Camera&, const SurfaceLayers&, const ObjectNames&, const std::vector<Ref<ObjectGroup>>&);

  /// The objects that a thread has met: each of their names is found and given to the tile once.
  struct Met {
    struct Object {
      std::uint64_t key = 0;
      std::int32_t object = 0, material = 0;
    };
    std::unordered_map<std::uint64_t, Object> objects;
    std::unordered_map<const Shader*, std::vector<Ref<const ObjectMap>>> roughness;  ///< members that give it
  };

  /// What is seen along a camera ray. Null scattering, as in holes and panes, is left to chance as in the paths of renderers,
  /// by primary samples of its own. Glass is seen itself, and media are not. Of a ray that meets nothing the key is 0.
  FirstSurface see(const Ray&, Point2 film, SampleContext&, Met&, SurfaceTile&) const;

 private:
  /// `stack` holds the media at the point, to which it refers.
  bool nearest_visible(Ray, SampleContext&, MediumStack& stack, Hit&, SurfacePoint&) const;
  Met::Object named(const Hit&, Met&, SurfaceTile&) const;
  void describe_scattering(const SurfacePoint&, const Vector3& out, SampleContext&, Met&, FirstSurface&) const;
  void describe_motion(const Hit&, const SurfacePoint&, Point2 film, FirstSurface&) const;

  const Scene& scene_;
  const Camera& camera_;
  const SurfaceLayers& layers_;
  const ObjectNames& names_;
  struct Group {
    std::string name;
    std::vector<NamePattern> objects;
  };
  std::vector<Group> groups_;
};

/// The colour of a reflectance, or an albedo, in the light of sRGB's white: linear sRGB. One path's estimate.
Vector3 linear_srgb(const Spectrum& reflectance, const Wavelengths&);

/// Where the point of an object that a hit has found is at another time, in rendering space: it moves with the object, with all
/// instances that contain it, and with the vertices of its mesh.
DoublePoint3 position_at(const Hit&, const SurfacePoint&, float time);

/// The film point at which a camera shows a point of rendering space through the middle of its lens, also beyond the edges of
/// the film. `near` is where the search begins. Nothing: the point cannot be seen, as it lies behind the camera.
std::optional<Point2> shown_at(const Camera&, const DoublePoint3&, float time, Point2 near);

}  // namespace etendue
