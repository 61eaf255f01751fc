#pragma once
// Shared by all code that uses Embree: the device, error checks, and EmbreeTriangles, a set of triangles with its own
// hierarchy. embree_versions.h has the ray queries.

#include <functional>
#include <utility>

#include "embree_versions.h"
#include "finite_ray.h"
#include "moving_triangles.h"

namespace etendue {

/// The one device of the process; it builds with all threads. Throws Error when Embree cannot start.
RTCDevice embree_device();
/// Throws Error if an earlier Embree call on this thread failed; `doing` completes the message.
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

/// Adds triangles to a scene that is being built and returns the geometry's ID. Embree shares the arrays. A position has twelve
/// bytes, but Embree reads sixteen, so the owner of the positions allocates one more as padding.
unsigned attach_triangles(RTCScene, const TriangleView&, RTCBuildQuality);

/// The distance t at which a ray hits a triangle, computed in double from the triangle's plane at the ray's time. Embree's own
/// t, in its robust mode, is further from the plane than SurfacePoint::error allows: a ray that leaves a triangle would hit it
/// again.
float exact_distance(const MovingTriangleView&, std::uint32_t triangle, const Ray&);

/// Maps time [s] to Embree's time, which runs from 0 to 1.
struct EmbreeClock {
  float begin = 0, end = 0;  ///< [s]; equal if nothing moves
  float operator()(float time) const { return end > begin ? clamp((time - begin) / (end - begin), 0, 1) : 0; }
  bool operator==(const EmbreeClock&) const = default;
  bool runs() const { return end > begin; }
};

/// The same for moving triangles; the clock of the scene must begin and end at their first and last keys. `attached` is called
/// with the ID of each geometry created.
void attach_moving_triangles(RTCScene, const MovingTriangleView&, RTCBuildQuality,
                             const std::function<void(unsigned)>& attached);

/// Embree ends the program if a ray's numbers are not below 1.8e18 (FLT_LARGE in its math.h): such a ray is replaced by a ray
/// of length zero, which hits nothing.
inline void set_embree_ray(RTCRay& to, const Ray& ray, const EmbreeClock& clock = {}) {
  to.org_x = ray.origin.x;
  to.org_y = ray.origin.y;
  to.org_z = ray.origin.z;
  // A ray that leaves a plane through the origin of coordinates begins exactly on it: with tnear = 0 Embree would hit the plane
  // again.
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

/// Moves the start of a query behind the hit that it found, to search for the next one.
inline void go_on_behind(RTCRay& query, const Ray& ray) {
  query.tnear = std::nextafter(query.tfar, infinity);
  query.tfar = ray.maximum;
}

/// Triangles with their own Embree scene, intersected in object space.
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
