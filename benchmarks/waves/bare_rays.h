#pragma once
// Rays against nothing but triangles, in Embree as it comes.

#include <embree3/rtcore.h>

#include <array>

#include "recorded_rays.h"

namespace etendue::waves {

/// The triangles of a scene, flat and curved objects made of some, in Embree without its robust mode, callbacks, filters: what
/// the same rays cost where nothing else is done.
class BareTriangles {
 public:
  explicit BareTriangles(const Scene&);
  ~BareTriangles();
  BareTriangles(const BareTriangles&) = delete;
  BareTriangles& operator=(const BareTriangles&) = delete;

  /// How rays are handed over.
  enum class Manner { single, stream, eight, sixteen };
  /// Asks all rays; returns how many met something. `coherent`: Embree is told that neighbours are alike.
  size_t ask(const std::vector<RecordedRay>&, Manner, bool coherent) const;

  size_t triangles = 0;
  size_t objects_left_out = 0;

 private:
  template <int width, class Query, class Intersect, class Occluded>
  size_t ask_packets(const std::vector<RecordedRay>&, bool coherent, Intersect, Occluded) const;
  void add(const std::vector<Point3>&, const std::vector<std::array<std::uint32_t, 3>>&);
  bool add_grid(const SceneObject&);

  RTCDevice device_;
  RTCScene scene_;
};

}  // namespace etendue::waves
