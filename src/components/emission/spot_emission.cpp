// SpotEmission: light that leaves within a cone, with a soft edge.

#include "cone_emission.h"

namespace etendue {
namespace {

// The edge (ConeEmission) falls as
//     f = t^2 (3 - 2t),   t = (h_o - h) / (h_o - h_i).
// As t^2 (3 - 2t) has the mean 1/2, the effective solid angle is
//     Omega = integral of f dw = 2 pi (h_i + (h_o - h_i) / 2) = pi (h_i + h_o).
// On the edge t has the pdf 2 t^2 (3 - 2t) and the CDF G(t) = 2 t^3 - t^4. G is convex and G(cbrt(v)) >= v, so Newton's method
// for G(t) = v descends from cbrt(v) to the solution and never overshoots.
class SpotEmission final : public ConeEmission {
 public:
  static void describe(Description<SpotEmission>& d) {
    d.summary(
        "Light that leaves within a cone: full up to an inner angle, falling to nothing at an outer one. On a Point a "
        "spotlight; on a surface the radiance's profile, to which the surface adds its cosine; on an Environment a sun with a "
        "soft edge.");
    describe_cone(d);
    describe_picture(d);
  }

  void prepare() override {
    prepare_angles();
    prepare_cone(pi * (h_inner() + h_outer()));
  }

 protected:
  float edge_fall_off(float h) const override {
    const float t = (h_outer() - h) / (h_outer() - h_inner());
    return t * t * (3 - 2 * t);
  }
  float draw_edge(float v) const override {
    float t = std::cbrt(v);
    for (int i = 0; i < 6 && t > 0; ++i) t -= (t * t * t * (2 - t) - v) / (t * t * (6 - 4 * t));
    return h_outer() - clamp(t, 0, 1) * (h_outer() - h_inner());
  }
};

const Register<SpotEmission> registered;

}  // namespace
}  // namespace etendue
