#pragma once
// What is shared by the users of Embree: the device, errors, and triangles with a structure of their own.

#include <embree3/rtcore.h>

#include <utility>

#include "etendue/scene_object.h"

namespace etendue {

/// The one device of the process; it builds with all threads. Throws Error when Embree cannot start.
RTCDevice embree_device();
/// Throws Error when an Embree call before this one, on this thread, went wrong.
void check_embree(const char* doing);

/// Owns an Embree scene.
class EmbreeSceneHandle {
 public:
  EmbreeSceneHandle() = default;
  explicit EmbreeSceneHandle(RTCScene s) : scene_(s) {}
  EmbreeSceneHandle(EmbreeSceneHandle&& b) noexcept : scene_(std::exchange(b.scene_, nullptr)) {}
  EmbreeSceneHandle& operator=(EmbreeSceneHandle&& b) noexcept {
    std::swap(scene_, b.scene_);
    return *this;
  }
  ~EmbreeSceneHandle() {
    if (scene_) rtcReleaseScene(scene_);
  }
  RTCScene get() const { return scene_; }

 private:
  RTCScene scene_ = nullptr;
};

/// Adds triangles to a scene that is being built, sharing their arrays; returns the geometry's number. Twelve bytes a
/// position, and sixteen are read at the last: what owns them keeps one more.
unsigned attach_triangles(RTCScene, const TriangleView&, RTCBuildQuality);

inline void set_embree_ray(RTCRay& to, const Ray& ray) {
  to.org_x = ray.origin.x;
  to.org_y = ray.origin.y;
  to.org_z = ray.origin.z;
  to.tnear = 0;
  to.dir_x = ray.direction.x;
  to.dir_y = ray.direction.y;
  to.dir_z = ray.direction.z;
  to.time = 0;
  to.tfar = ray.maximum;
  to.mask = ~0u;
  to.id = 0;
  to.flags = 0;
}

/// Triangles that are searched on their own, in their own coordinates.
class EmbreeTriangles {
 public:
  explicit EmbreeTriangles(const TriangleView&);
  bool nearest(const Ray&, float& t, std::uint32_t& triangle, float& u, float& v) const;
  bool any(const Ray&) const;

 private:
  EmbreeSceneHandle scene_;
};

}  // namespace etendue
