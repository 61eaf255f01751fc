// ConeEmission: its angles, its sampling and its picture.

#include "cone_emission.h"

#include <numbers>

namespace etendue {

Spectrum ConeEmission::radiance(const SurfacePoint& p, const Vector3& direction, const Wavelengths& w) const {
  const Spectrum all = AxialEmission::radiance(p, direction, w);
  return !picture || all.black() ? all : all * seen_through(p.time, picture_frame(p).to_local(direction), w);
}

Spectrum ConeEmission::power(const SceneObject& object, const Wavelengths& w) const {
  const Spectrum all = AxialEmission::power(object, w);
  if (!picture) return all;
  constexpr int side = 32;
  Spectrum sum;
  for (int i = 0; i < side * side; ++i) {
    const float h = draw((float(i / side) + 0.5f) / side, false), r = safe_sqrt(h * (2 - h));
    float sine = 0, cosine = 0;
    sin_cos_turn((float(i % side) + 0.5f) / side, sine, cosine);
    sum += seen_through(0, {r * cosine, r * sine, 1 - h}, w);
  }
  return all * sum / float(side * side);
}

void ConeEmission::prepare_angles() {
  if (!(outer_angle >= inner_angle)) fail("outer_angle", "must be no less than inner_angle");
  if (!(outer_angle > 0)) fail("outer_angle", "must be more than 0");
  const auto one_minus_cosine = [](float angle) {
    const double s = std::sin(double(angle) * (std::numbers::pi / 360));
    return float(2 * s * s);
  };
  h_inner_ = one_minus_cosine(inner_angle);
  h_outer_ = one_minus_cosine(outer_angle);
  if (!(h_outer_ > 0)) fail("outer_angle", "is too small to count with");
}

void ConeEmission::prepare_cone(float solid_angle) {
  solid_angle_ = solid_angle;
  inner_share_ = 2 * pi * h_inner_ / solid_angle_;
  if (picture) prepare_picture();
  prepare_axis();
  prepare_amounts("radiance");
}

float ConeEmission::draw(float u, bool) const {
  if (u < inner_share_) return h_inner_ * (u / inner_share_);
  return draw_edge((1 - u) / (1 - inner_share_));  // inner_share_ = 1 lies beyond all u
}

void ConeEmission::prepare_picture() {
  if (!(outer_angle < 90)) fail("picture", "outer_angle must be less than 90 degrees for a picture across the axis");
  if (!(axis.x == 0 && axis.y == 0 && axis.z > 0))
    fail("picture", "needs the axis to be the object's +z; the object's transform turns both");
  if (const Color color = picture->constant(); color && !(range_of(*color, ColorUse::reflectance).least >= 0))
    fail("picture", "must not be negative");
  picture_scale_ = float(0.5 / std::tan(double(outer_angle) * (std::numbers::pi / 180)));
}

Spectrum ConeEmission::seen_through(float time, const Vector3& local, const Wavelengths& w) const {
  if (!(local.z > 0)) return {};
  const Point2 uv{0.5f - picture_scale_ * local.x / local.z, 0.5f + picture_scale_ * local.y / local.z};
  return picture->reflectance(picture_point(uv, time), w);
}

}  // namespace etendue
