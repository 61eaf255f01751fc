#pragma once
// What is shared by the users of Embree: the device, errors, and triangles with a structure of their own.

#include <embree3/rtcore.h>

#include <functional>
#include <utility>

#include "finite_ray.h"
#include "moving_triangles.h"

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

/// The distance t at which a ray that hits a triangle does so, in double from the triangle's plane where it is at the ray's
/// time. Embree's own, in its robust mode, lies beside the plane by more than SurfacePoint::error counts with: a ray that
/// leaves a triangle would meet it again.
float exact_distance(const MovingTriangleView&, std::uint32_t triangle, const Ray&);

/// Embree's time runs from 0 to 1: how it follows from the true one.
struct EmbreeClock {
  float begin = 0, end = 0;  ///< [s]; equal: nothing moves
  float operator()(float time) const { return end > begin ? clamp((time - begin) / (end - begin), 0, 1) : 0; }
  bool operator==(const EmbreeClock&) const = default;
  bool runs() const { return end > begin; }
};

/// The same for moving ones, whose first and last keys are where the clock begins and ends: `attached` is told the numbers
/// of all geometries that were made.
void attach_moving_triangles(RTCScene, const MovingTriangleView&, RTCBuildQuality,
                             const std::function<void(unsigned)>& attached);

/// Embree ends the program when a ray is not made of numbers below 1.8e18 (FLT_LARGE in its math.h): such a ray becomes one
/// without length, which meets nothing.
inline void set_embree_ray(RTCRay& to, const Ray& ray, const EmbreeClock& clock = {}) {
  to.org_x = ray.origin.x;
  to.org_y = ray.origin.y;
  to.org_z = ray.origin.z;
  // A ray that leaves a plane through the origin of coordinates begins exactly on it: at 0 Embree would find that again.
  to.tnear = std::numeric_limits<float>::min();
  to.dir_x = ray.direction.x;
  to.dir_y = ray.direction.y;
  to.dir_z = ray.direction.z;
  to.time = clock(ray.time);
  to.tfar = ray.maximum;
  to.mask = ~0u;
  to.id = 0;
  to.flags = 0;
  if (has_finite_squares(ray)) [[likely]]
    return;
  to.org_x = to.org_y = to.org_z = to.dir_x = to.dir_y = to.tfar = 0;
  to.dir_z = 1;
}

/// Makes a query find what lies behind the hit that it found.
inline void go_on_behind(RTCRay& query, const Ray& ray) {
  query.tnear = std::nextafter(query.tfar, infinity);
  query.tfar = ray.maximum;
}

/// Triangles that are searched on their own, in their own coordinates.
class EmbreeTriangles {
 public:
  explicit EmbreeTriangles(const MovingTriangleView&);
  bool nearest(const Ray&, float& t, std::uint32_t& triangle, float& u, float& v) const;
  bool any(const Ray&) const;

 private:
  EmbreeSceneHandle scene_;
  EmbreeClock clock_;
  MovingTriangleView view_;
};

}  // namespace etendue
