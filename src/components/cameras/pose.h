#pragma once
// Where a camera stands and how it is turned: what all cameras share.

#include "etendue/camera.h"

namespace etendue {

/// Axes of a camera in the world, orthonormal. `right` points to the right of the picture: direction x up (Transform's
/// camera convention has +x to the left).
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
  /// Checks and takes the members of a camera; throws at the member that is wrong.
  void set(const Camera& camera, const DoublePoint3& from, const DoublePoint3& to, const Vector3& up,
           const AnimatedTransform& transform);
  Pose at(float time) const { return moving_ ? Pose(transform_.at(time) * base_) : still_; }

 private:
  Pose still_;
  bool moving_ = false;
  Transform base_;
  AnimatedTransform transform_;
};

/// Throws when the shutter closes before it opens.
void check_shutter(const Camera&);

}  // namespace etendue
