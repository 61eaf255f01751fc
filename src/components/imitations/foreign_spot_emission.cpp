// ForeignSpotEmission: a spot whose edge falls off as that of a spot in another program.

#include <numbers>

#include "components/emission/cone_emission.h"

namespace etendue {
namespace {

// The edge (ConeEmission) between the angles theta_i and theta_o to the axis, with h = 1 - cos(theta), is one of
//     linear        f = (theta_o - theta) / (theta_o - theta_i)            Mitsuba's `spot`,
//     square        f = t^2,            t = (h_o - h) / (h_o - h_i)        glTF's KHR_lights_punctual,
//     quartic       f = t^4,            t likewise                         pbrt until version 3,
//     smooth_angle  f = t^2 (3 - 2t),   t = (theta_o - theta) / (theta_o - theta_i)    UsdLux' shaping:cone:softness.
//
// t^2 has the mean 1/3 and the CDF t^3, t^4 the mean 1/5 and the CDF t^5. For the linear edge, by parts,
//     Omega = 2 pi (1 - (sin theta_o - sin theta_i) / (theta_o - theta_i)),
// and for smooth_angle, by parts, with m the mean of the angles and x half their difference,
//     Omega = 2 pi (1 - integral_0^1 6 t (1 - t) cos(theta_o - 2 x t) dt) = 2 pi (1 - cos(m) 3 (sin x - x cos x) / x^3).
//
// For the edges that fall by the angle the pdf of theta is proportional to f sin(theta); its CDF is integrated with eight
// points, whose terms do not cancel, and inverted by Newton's method with bisection as a fallback.
class ForeignSpotEmission final : public ConeEmission {
 public:
  static void describe(Description<ForeignSpotEmission>& d) {
    d.summary(
        "A SpotEmission whose edge falls off as in other programs, so that scenes made with those look the same. "
        "SpotEmission's own edge is smooth.");
    describe_cone(d);
    d.member<&ForeignSpotEmission::edge>(
        "edge", "",
        "how light falls off between the angles; linear: linearly in the angle, as in Mitsuba; square: as t^2 with t linear in "
        "the cosine, as in glTF; quartic: as t^4, as in pbrt until version 3; smooth_angle: as t^2 (3 - 2t) with t linear in "
        "the angle, as in USD",
        choices("linear", "square", "quartic", "smooth_angle"));
    describe_picture(d);
  }

  void prepare() override {
    prepare_angles();
    if (by_angle() && outer_angle > inner_angle)
      prepare_cone(prepare_edge_by_angle());
    else if (edge == Edge::square)
      prepare_cone(2 * pi * (2 * h_inner() + h_outer()) / 3);
    else if (edge == Edge::quartic)
      prepare_cone(2 * pi * (4 * h_inner() + h_outer()) / 5);
    else
      prepare_cone(pi * (h_inner() + h_outer()));  // no edge
  }

  enum class Edge : std::uint8_t { linear, square, quartic, smooth_angle };
  Edge edge = Edge::linear;

 protected:
  float edge_fall_off(float h) const override {
    if (by_angle()) return float(at_angle(angle(h)));
    const float t = (h_outer() - h) / (h_outer() - h_inner());
    return edge == Edge::quartic ? square(t * t) : t * t;
  }

  float draw_edge(float v) const override {
    if (by_angle()) return draw_edge_by_angle(double(v));
    const float t = edge == Edge::quartic ? std::pow(v, 0.2f) : std::cbrt(v);
    return h_outer() - clamp(t, 0, 1) * (h_outer() - h_inner());
  }

 private:
  static double angle(float h) { return 2 * std::asin(std::min(std::sqrt(double(h) / 2), 1.0)); }

  bool by_angle() const { return edge == Edge::linear || edge == Edge::smooth_angle; }

  /// The profile on an edge that falls by the angle.
  double at_angle(double theta) const {
    const double t = (theta_outer_ - theta) / (theta_outer_ - theta_inner_);
    return edge == Edge::linear ? t : t * t * (3 - 2 * t);
  }

  /// Returns Omega [sr].
  float prepare_edge_by_angle() {
    theta_inner_ = double(inner_angle) * (std::numbers::pi / 180);
    theta_outer_ = double(outer_angle) * (std::numbers::pi / 180);
    // Both edges have Omega = 2 pi (1 - cos(m) K(x)), with a and b the angles, m = (a + b) / 2 and x = (b - a) / 2; for the
    // linear edge (sin b - sin a) / (b - a) = cos(m) K with K = sin(x) / x. 1 - K is computed without cancellation.
    const double middle = (theta_inner_ + theta_outer_) / 2, x = (theta_outer_ - theta_inner_) / 2, x2 = x * x;
    const double missing = edge == Edge::linear ? (x < 1e-2 ? x2 / 6 - x2 * x2 / 120 : 1 - std::sin(x) / x)
                           : x < 0.1            ? x2 / 10 - x2 * x2 / 280 + x2 * x2 * x2 / 15120
                                                : 1 - 3 * (std::sin(x) - x * std::cos(x)) / (x2 * x);
    const double s = std::sin(middle / 2);
    return float(2 * std::numbers::pi * (2 * s * s + std::cos(middle) * missing));
  }

  /// The integral of the profile times sin(t) dt from theta to theta_o, by Gauss-Legendre quadrature with eight points. The
  /// quadrature is exact for polynomials of degree 15, and for less than half a turn exact to 1e-7.
  double beyond(double theta) const {
    constexpr double points[] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
    constexpr double weights[] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};
    const double middle = (theta + theta_outer_) / 2, half = (theta_outer_ - theta) / 2;
    const auto at = [&](double t) { return at_angle(t) * std::sin(t); };
    double sum = 0;
    for (int i = 0; i < 4; ++i) sum += weights[i] * (at(middle - half * points[i]) + at(middle + half * points[i]));
    return half * sum;
  }

  /// The h beyond which the share v of the edge's light lies.
  float draw_edge_by_angle(double v) const {
    const double wanted = v * beyond(theta_inner_);
    double low = theta_inner_, high = theta_outer_, theta = theta_outer_ - std::sqrt(v) * (theta_outer_ - theta_inner_);
    for (int i = 0; i < 40; ++i) {
      const double over = beyond(theta) - wanted;
      (over > 0 ? low : high) = theta;
      const double slope = at_angle(theta) * std::sin(theta);
      double next = slope > 0 ? theta + over / slope : low;
      if (!(next > low && next < high)) next = (low + high) / 2;
      if (std::abs(next - theta) < 1e-9 * theta_outer_) break;
      theta = next;
    }
    const double s = std::sin(theta / 2);
    return clamp(float(2 * s * s), h_inner(), h_outer());
  }

  double theta_inner_ = 0, theta_outer_ = 0;  // the angles, set for edges that fall by the angle [rad]
};

const Register<ForeignSpotEmission> registered;

}  // namespace
}  // namespace etendue
