#pragma once
// Rays against triangles only, in plain Embree.

#include <embree3/rtcore.h>

#include <array>

#include "recorded_rays.h"

namespace etendue::waves {

/// The triangles of a scene, including those of tessellated curved objects, in Embree without its robust mode, callbacks and
/// filters: the cost of the same rays without anything else.
class BareTriangles {
 public:
  explicit BareTriangles(const Scene&);
  ~BareTriangles();
  BareTriangles(const BareTriangles&) = delete;
  BareTriangles& operator=(const BareTriangles&) = delete;

  /// How rays are passed to Embree.
  enum class Manner { single, stream, eight, sixteen };
  /// Traces all rays; returns the number of hits. `coherent`: sets Embree's flag for coherent rays.
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
