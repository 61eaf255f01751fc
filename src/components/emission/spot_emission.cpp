// SpotEmission: light that leaves within a cone, with a soft edge.

#include "axial_emission.h"

namespace etendue {
namespace {

constexpr double pi_exactly = 3.14159265358979323846;

// Profile, with h = 1 - cos(theta) of the angle to the axis (AxialEmission):
//     f = 1 for h <= h_i,   f = t^2 (3 - 2t), t = (h_o - h) / (h_o - h_i), between,   f = 0 for h >= h_o,
// where h_i and h_o belong to the inner and outer angle. As t^2 (3 - 2t) has the mean 1/2, the solid angle it counts for is
//     Omega = integral of f dw = 2 pi (h_i + (h_o - h_i) / 2) = pi (h_i + h_o).
//
// Directions are drawn with density f / Omega: h is uniform up to h_i with probability h_i / (h_i + (h_o - h_i) / 2); else t
// has the density 2 t^2 (3 - 2t) and the distribution G(t) = 2 t^3 - t^4. G is convex and G(cbrt(v)) >= v, so Newton's method
// for G(t) = v comes down to the solution from cbrt(v) and never passes it.
class SpotEmission final : public AxialEmission {
 public:
  static void describe(Description<SpotEmission>& d) {
    d.summary(
         "Light that leaves within a cone: full up to an inner angle, falling smoothly to nothing at an outer one, by "
         "t^2 (3 - 2t) with t linear in the cosine. On a Point a spotlight; on a surface the radiance's profile, to which the "
         "surface adds its cosine; on an Environment a sun with a soft edge.")
        .group("Light")
        .member<&SpotEmission::map>("radiance", "W m^-2 sr^-1 nm^-1",
                                    "radiance within the inner angle; only its shape counts when an amount is given",
                                    Meaning::radiance, soft(0.01, 1000), logarithmic);
    describe_amounts(d);
    d.group("Cone")
        .member<&SpotEmission::axis>(
            "axis", "1",
            "the middle of the cone, the way its light travels, in the object's own coordinates; of any "
            "length")
        .member<&SpotEmission::inner_angle>("inner_angle", "deg", "from the axis to where the light begins to fall off",
                                            range(0, 180))
        .member<&SpotEmission::outer_angle>("outer_angle", "deg", "from the axis to where there is none any more",
                                            Range{0, 180, true});
  }

  void prepare() override {
    if (!(outer_angle >= inner_angle)) fail("outer_angle", "must be no less than inner_angle");
    if (!(outer_angle > 0)) fail("outer_angle", "must be more than 0");
    const auto one_minus_cosine = [](float angle) {
      const double s = std::sin(double(angle) * (pi_exactly / 360));
      return float(2 * s * s);
    };
    h_inner_ = one_minus_cosine(inner_angle);
    h_outer_ = one_minus_cosine(outer_angle);
    if (!(h_outer_ > 0)) fail("outer_angle", "is too small to count with");
    solid_angle_ = pi * (h_inner_ + h_outer_);
    inner_share_ = h_inner_ / (h_inner_ + (h_outer_ - h_inner_) / 2);
    prepare_axis();
    prepare_amounts("radiance");
  }

  float inner_angle = 20, outer_angle = 30;

 protected:
  float fall_off(float h) const override {
    if (h <= h_inner_) return 1;
    if (h >= h_outer_) return 0;
    const float t = (h_outer_ - h) / (h_outer_ - h_inner_);
    return t * t * (3 - 2 * t);
  }
  double solid_angle() const override { return double(solid_angle_); }
  double inner() const override { return double(h_inner_); }
  double outer() const override { return double(h_outer_); }

  float draw(float u, bool) const override {
    if (u < inner_share_) return h_inner_ * (u / inner_share_);
    const float v = (1 - u) / (1 - inner_share_);  // inner_share_ = 1 lies beyond all u
    float t = std::cbrt(v);
    for (int i = 0; i < 6 && t > 0; ++i) t -= (t * t * t * (2 - t) - v) / (t * t * (6 - 4 * t));
    return h_outer_ - clamp(t, 0, 1) * (h_outer_ - h_inner_);
  }
  float drawn(float h, bool) const override { return fall_off(h) / solid_angle_; }

 private:
  float h_inner_ = 0, h_outer_ = 0;  // 1 - cos of the angles
  float solid_angle_ = 0;            // Omega [sr]
  float inner_share_ = 0;            // probability that a direction lies within the inner angle
};

const Register<SpotEmission> registered;

}  // namespace
}  // namespace etendue
