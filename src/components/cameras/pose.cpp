// Sets a camera's placement, clipping planes and shutter from its members, and checks these members.

#include "pose.h"

namespace etendue {

void Placement::set(const Camera& camera, const DoublePoint3& from, const DoublePoint3& to, const Vector3& up,
                    const AnimatedTransform& transform) {
  if (!is_finite(from)) camera.fail("from", "must be finite numbers");
  if (!is_finite(to)) camera.fail("to", "must be finite numbers");
  const DoubleVector3 way = to - from;
  const Vector3 forward(1 / length(way) * way);
  if (!(length(way) > 0)) camera.fail("to", "must be another point than from: it says where the camera looks");
  if (!is_finite(up) || !(length(up) > 0)) camera.fail("up", "must be a direction other than zero");
  if (!(length(cross(forward, normalize(up))) > 1e-5f)) camera.fail("up", "must not point along the line of sight");
  if (!transform.valid()) camera.fail("transform", "cannot be inverted");
  // With a scaled camera the sizes of lens and film would be in other units than those of the world.
  for (const auto& key : transform.keys()) {
    const Vector3 axes[3] = {key.transform(Vector3{1, 0, 0}), key.transform(Vector3{0, 1, 0}), key.transform(Vector3{0, 0, 1})};
    for (int i = 0; i < 3; ++i)
      if (!(std::abs(length(axes[i]) - 1) < 1e-3f) || !(std::abs(dot(axes[i], axes[(i + 1) % 3])) < 1e-3f))
        camera.fail("transform", "a camera can be moved and turned but not scaled or sheared");
  }
  transform_ = transform;
  transform_.set_origins(camera.rendering_origin, from);
  base_ = Transform::look_at({}, {way.x, way.y, way.z}, up);
  moving_ = transform.animated();
  still_ = Pose(transform_.still() * base_);
}

void Clip::set(const Camera& camera, float near_clip, float far_clip) {
  if (!std::isfinite(near_clip)) camera.fail("near_clip", "must be finite");
  if (std::isnan(far_clip) || (far_clip > 0 && !(far_clip > near_clip)))
    camera.fail("far_clip", "must be more than near_clip, or 0: nothing lies between the two planes");
  nearest_ = near_clip;
  farthest_ = far_clip > 0 ? far_clip : infinity;
  cuts_ = nearest_ > 0 || farthest_ < infinity;
}

void check_shutter(const Camera& camera) {
  if (!std::isfinite(camera.shutter_open)) camera.fail("shutter_open", "must be a finite time");
  if (!std::isfinite(camera.shutter_close) || camera.shutter_close < camera.shutter_open)
    camera.fail("shutter_close", "the shutter must not close before it opens");
  const double whole = double(camera.shutter_close) - double(camera.shutter_open);
  if (double(camera.shutter_opening) + double(camera.shutter_closing) > whole * (1 + 1e-6))
    camera.fail(camera.shutter_opening > whole ? "shutter_opening" : "shutter_closing",
                "opening and closing must not take longer than the shutter is open");
}

}  // namespace etendue
