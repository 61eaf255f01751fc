// SpotEmission: light that leaves within a cone, with a soft edge.

#include "axial_emission.h"

namespace etendue {
namespace {

constexpr double pi_exactly = 3.14159265358979323846;

// Profile, with h = 1 - cos(theta) of the angle to the axis (AxialEmission):
//     f = 1 for h <= h_i,   f = t^2 (3 - 2t), t = (h_o - h) / (h_o - h_i), between,   f = 0 for h >= h_o,
// where h_i and h_o belong to the inner and outer angle. As t^2 (3 - 2t) has the mean 1/2, the effective solid angle is
//     Omega = integral of f dw = 2 pi (h_i + (h_o - h_i) / 2) = pi (h_i + h_o).
//
// A square edge falls as f = t^2, with the mean 1/3 and the CDF t^3 (glTF's KHR_lights_punctual), a quartic one as t^4, with
// the mean 1/5 and the CDF t^5 (pbrt until version 3).
//
// A linear edge falls linearly in the angle, f = (theta_o - theta) / (theta_o - theta_i), as lamps of some other renderers do;
// by parts,  Omega = 2 pi (1 - (sin theta_o - sin theta_i) / (theta_o - theta_i)).
//
// An edge that is smooth in the angle (UsdLux' shaping:cone:softness) falls as t^2 (3 - 2t) with t = (theta_o - theta) /
// (theta_o - theta_i); by parts, with m the mean of the angles and x half their difference,
//     Omega = 2 pi (1 - integral_0^1 6 t (1 - t) cos(theta_o - 2 x t) dt) = 2 pi (1 - cos(m) 3 (sin x - x cos x) / x^3).
//
// Directions are sampled with the pdf f / Omega: h is uniform up to h_i with probability h_i / (h_i + (h_o - h_i) / 2); else t
// has the pdf 2 t^2 (3 - 2t) and the CDF G(t) = 2 t^3 - t^4. G is convex and G(cbrt(v)) >= v, so Newton's method for G(t) = v
// descends from cbrt(v) to the solution and never overshoots. For the edges that fall by the angle the pdf of theta is
// proportional to f sin(theta); its CDF is integrated with eight points, whose terms do not cancel, and inverted by Newton's
// method with bisection as a fallback.
//
// A picture (a gobo) multiplies the light by its map as a transmittance. It lies perpendicular to the axis, and its unit square
// spans the outer angle. Directions are sampled as without it.
class SpotEmission final : public AxialEmission {
 public:
  static void describe(Description<SpotEmission>& d) {
    d.summary(
         "Light that leaves within a cone: full up to an inner angle, falling to nothing at an outer one. On a Point a "
         "spotlight; on a surface the radiance's profile, to which the "
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
                                            Range{0, 180, true})
        .member<&SpotEmission::edge>("edge", "",
                                     "how light falls off between the angles; smooth: as t^2 (3 - 2t) with t linear in the "
                                     "cosine; linear: linearly in the angle; square: as t^2; quartic: as t^4; smooth_angle: as "
                                     "smooth, with t linear in the angle",
                                     choices("smooth", "linear", "square", "quartic", "smooth_angle"))
        .member<&SpotEmission::picture>(
            "picture", "1",
            "what the light is multiplied by, a transmittance, such as a slide's; (u, v) = (1/2, 1/2) lies in the axis, u "
            "grows "
            "towards +x and v towards +y of the object, and the outer angle is reached at 0 and 1; amounts are those of the "
            "cone without it; none: all passes",
            Meaning::reflectance);
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
    solid_angle_ = edge == Edge::square    ? 2 * pi * (2 * h_inner_ + h_outer_) / 3
                   : edge == Edge::quartic ? 2 * pi * (4 * h_inner_ + h_outer_) / 5
                                           : pi * (h_inner_ + h_outer_);
    if (by_angle() && outer_angle > inner_angle) prepare_edge_by_angle();
    inner_share_ = 2 * pi * h_inner_ / solid_angle_;
    if (picture) prepare_picture();
    prepare_axis();
    prepare_amounts("radiance");
  }

  Spectrum radiance(const SurfacePoint& p, const Vector3& direction, const Wavelengths& w) const override {
    const Spectrum all = AxialEmission::radiance(p, direction, w);
    return !picture || all.black() ? all : all * seen_through(p.time, picture_frame(p).to_local(direction), w);
  }

  /// With a picture the power is multiplied by the picture's mean over the cone, which is exact for a Point and approximate for
  /// surfaces.
  Spectrum power(const SceneObject& object, const Wavelengths& w) const override {
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

  enum class Edge : std::uint8_t { smooth, linear, square, quartic, smooth_angle };
  float inner_angle = 20, outer_angle = 30;
  Edge edge = Edge::smooth;
  Ref<ObjectMap> picture;

 protected:
  float fall_off(float h) const override {
    if (h <= h_inner_) return 1;
    if (h >= h_outer_) return 0;
    if (by_angle()) return float(at_angle(angle(h)));
    const float t = (h_outer_ - h) / (h_outer_ - h_inner_);
    if (edge == Edge::quartic) return square(t * t);
    return edge == Edge::square ? t * t : t * t * (3 - 2 * t);
  }
  double solid_angle() const override { return double(solid_angle_); }
  double inner() const override { return double(h_inner_); }
  double outer() const override { return double(h_outer_); }

  float draw(float u, bool) const override {
    if (u < inner_share_) return h_inner_ * (u / inner_share_);
    const float v = (1 - u) / (1 - inner_share_);  // inner_share_ = 1 lies beyond all u
    if (by_angle()) return draw_edge_by_angle(double(v));
    float t = edge == Edge::quartic ? std::pow(v, 0.2f) : std::cbrt(v);
    for (int i = 0; edge == Edge::smooth && i < 6 && t > 0; ++i) t -= (t * t * t * (2 - t) - v) / (t * t * (6 - 4 * t));
    return h_outer_ - clamp(t, 0, 1) * (h_outer_ - h_inner_);
  }
  float drawn(float h, bool) const override { return fall_off(h) / solid_angle_; }

 private:
  static double angle(float h) { return 2 * std::asin(std::min(std::sqrt(double(h) / 2), 1.0)); }

  bool by_angle() const { return edge == Edge::linear || edge == Edge::smooth_angle; }

  /// The profile on an edge that falls by the angle.
  double at_angle(double theta) const {
    const double t = (theta_outer_ - theta) / (theta_outer_ - theta_inner_);
    return edge == Edge::linear ? t : t * t * (3 - 2 * t);
  }

  void prepare_edge_by_angle() {
    theta_inner_ = double(inner_angle) * (pi_exactly / 180);
    theta_outer_ = double(outer_angle) * (pi_exactly / 180);
    // Both edges have Omega = 2 pi (1 - cos(m) K(x)), with a and b the angles, m = (a + b) / 2 and x = (b - a) / 2; for the
    // linear edge (sin b - sin a) / (b - a) = cos(m) K with K = sin(x) / x. 1 - K is computed without cancellation.
    const double middle = (theta_inner_ + theta_outer_) / 2, x = (theta_outer_ - theta_inner_) / 2, x2 = x * x;
    const double missing = edge == Edge::linear ? (x < 1e-2 ? x2 / 6 - x2 * x2 / 120 : 1 - std::sin(x) / x)
                           : x < 0.1            ? x2 / 10 - x2 * x2 / 280 + x2 * x2 * x2 / 15120
                                                : 1 - 3 * (std::sin(x) - x * std::cos(x)) / (x2 * x);
    const double s = std::sin(middle / 2);
    solid_angle_ = float(2 * pi_exactly * (2 * s * s + std::cos(middle) * missing));
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
    return clamp(float(2 * s * s), h_inner_, h_outer_);
  }

  void prepare_picture() {
    if (!(outer_angle < 90)) fail("picture", "outer_angle must be less than 90 degrees for a picture across the axis");
    if (!(axis.x == 0 && axis.y == 0 && axis.z > 0))
      fail("picture", "needs the axis to be the object's +z; the object's transform turns both");
    if (const Color color = picture->constant(); color && !(range_of(*color, ColorUse::reflectance).least >= 0))
      fail("picture", "must not be negative");
    picture_scale_ = float(0.5 / std::tan(double(outer_angle) * (pi_exactly / 180)));
  }
  /// The picture's transmittance in a direction given in picture_frame().
  Spectrum seen_through(float time, const Vector3& local, const Wavelengths& w) const {
    if (!(local.z > 0)) return {};
    const Point2 uv{0.5f - picture_scale_ * local.x / local.z, 0.5f + picture_scale_ * local.y / local.z};
    return picture->reflectance(picture_point(uv, time), w);
  }

  float h_inner_ = 0, h_outer_ = 0;           // 1 - cos of the angles
  float solid_angle_ = 0;                     // Omega [sr]
  double theta_inner_ = 0, theta_outer_ = 0;  // the angles, set for edges that fall by the angle [rad]
  float picture_scale_ = 0;                   // from a plane at distance 1 to (u, v)
  float inner_share_ = 0;                     // probability that a direction lies within the inner angle
};

const Register<SpotEmission> registered;

}  // namespace
}  // namespace etendue
