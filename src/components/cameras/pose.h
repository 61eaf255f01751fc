#pragma once
// Position and orientation, clipping planes and the check of the shutter, which cameras share.

#include "etendue/camera.h"

namespace etendue {

/// The orthonormal axes of a camera in world space. `right` points to the right of the picture: viewing direction x up (in
/// Transform's camera convention +x points to the left).
struct Pose {
  Point3 position;
  Vector3 right{-1, 0, 0}, up{0, 1, 0}, forward{0, 0, 1};

  Pose() = default;
  explicit Pose(const Transform& t)
      : position(t(Point3{})),
        right(normalize(t(Vector3{-1, 0, 0}))),
        up(normalize(t(Vector3{0, 1, 0}))),
        forward(normalize(t(Vector3{0, 0, 1}))) {}

  Vector3 to_camera(const Vector3& v) const { return {dot(right, v), dot(up, v), dot(forward, v)}; }
  Vector3 to_world(const Vector3& v) const { return v.x * right + v.y * up + v.z * forward; }
};

/// The placement of a camera: from, to and up, and a transform (which may move) on top of them.
class Placement {
 public:
  /// Sets the placement from a camera's members. Throws Error with the location of a member that is wrong.
  void set(const Camera& camera, const DoublePoint3& from, const DoublePoint3& to, const Vector3& up,
           const AnimatedTransform& transform);
  Pose at(float time) const { return moving_ ? Pose(transform_.at(time) * base_) : still_; }

 private:
  Pose still_;
  bool moving_ = false;
  Transform base_;
  AnimatedTransform transform_;
};

/// Near and far clipping planes, perpendicular to the camera's axis.
class Clip {
 public:
  /// Sets the planes from a camera's members. Throws Error with the location of a member that is wrong.
  void set(const Camera& camera, float near_clip, float far_clip);
  /// Whether a point at this depth along the axis [m] lies between the planes.
  bool holds(float depth) const { return depth >= nearest_ && depth <= farthest_; }
  /// The distances of the planes along a ray whose angle to the axis has this cosine.
  Camera::Reach reach(float cosine) const { return {nearest_ / cosine, farthest_ / cosine}; }
  /// Shortens a ray that leaves the lens to the part between the planes.
  void cut(Ray& ray, float cosine) const {
    if (!cuts_) return;
    const auto [nearest, farthest] = reach(cosine);
    ray.origin = ray(nearest);
    ray.maximum = farthest - nearest;
    ray.width += nearest * ray.spread;
  }

 private:
  float nearest_ = 0, farthest_ = infinity;
  bool cuts_ = false;
};

/// Describes the members near_clip and far_clip.
template <auto near_clip, auto far_clip, class C>
void describe_clip(Description<C>& d) {
  d.group("Clipping")
      .template member<near_clip>("near_clip", "m",
                                  "what is nearer than this, along the viewing axis, is left out of what the camera sees; it "
                                  "casts shadows and shows in "
                                  "mirrors all the same",
                                  at_least(0), soft(0.001, 10), logarithmic)
      .template member<far_clip>("far_clip", "m",
                                 "what is farther than this, along the viewing axis, is left out in the same way, and the "
                                 "environment seen instead; 0: "
                                 "nothing is",
                                 at_least(0), soft(1, 10000), logarithmic);
}

/// Throws Error if the shutter's times are not finite, if it closes before it opens, or if its ramps are longer than its
/// opening.
void check_shutter(const Camera&);

}  // namespace etendue
