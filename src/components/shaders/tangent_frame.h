#pragma once
// The tangent frame of anisotropic models: the direction of a surface's brush strokes, threads or grooves.

#include "etendue/scene_object.h"

namespace etendue {

/// The frame whose z is the shading normal and whose x lies along dpdu, orthogonalized against the normal and rotated about it
/// by `rotation` [turns], counter-clockwise seen from the front. Where dpdu cannot be used (zero, along the normal or not
/// finite), x is an arbitrary direction that depends on the normal alone.
inline Frame tangent_frame(const SurfacePoint& p, float rotation = 0) {
  const Normal3 n = p.shading_normal;
  Vector3 dpdu = p.dpdu;
  if (p.object && dpdu == Vector3{}) {
    SurfacePoint asked = p;
    p.object->tangents(asked);
    dpdu = asked.dpdu;
  }
  Frame frame(n);
  const Vector3 s = dpdu - dot(n, dpdu) * Vector3(n);
  const float s2 = length_squared(s);
  if (s2 > 1e-10f * length_squared(dpdu) && s2 < infinity) {
    frame.s = s / std::sqrt(s2);
    frame.t = cross(Vector3(n), frame.s);
  }
  if (rotation != 0 && std::isfinite(rotation)) {
    float sine = 0, cosine = 0;
    sin_cos_turn(rotation - std::floor(rotation), sine, cosine);
    frame = Frame(cosine * frame.s + sine * frame.t, cosine * frame.t - sine * frame.s, n);
  }
  return frame;
}

}  // namespace etendue
