// SpotEmission: light that leaves within a cone, with a soft edge.

#include "etendue/emission_shader.h"
#include "etendue/object_map.h"
#include "etendue/scene_object.h"
#include "etendue/warp.h"
#include "per_object.h"

namespace etendue {
namespace {

constexpr double pi_exactly = 3.14159265358979323846;

// Profile. With theta the angle to the axis and h = 1 - cos(theta), the radiance is M f(h), M what the map says and
//     f = 1 for h <= h_i,   f = t^2 (3 - 2t), t = (h_o - h) / (h_o - h_i), between,   f = 0 for h >= h_o,
// where h_i and h_o belong to the inner and outer angle. h comes from the difference d of the two unit vectors as |d|^2 / 2,
// which stays exact in narrow cones. As dw = 2 pi dh and t^2 (3 - 2t) has the mean 1/2, the solid angle it counts for is
//     Omega = integral of f dw = 2 pi (h_i + (h_o - h_i) / 2) = pi (h_i + h_o).
//
// Directions are drawn with density f / Omega: h is uniform up to h_i with probability h_i / (h_i + (h_o - h_i) / 2); else t
// has the density 2 t^2 (3 - 2t) and the distribution G(t) = 2 t^3 - t^4. G is convex and G(cbrt(v)) >= v, so Newton's method
// for G(t) = v comes down to the solution from cbrt(v) and never passes it.
//
// Power. Per area of a surface with normal n, and per M, leaves
//     K(n) = integral over the sides that emit of f |n . w| dw,
// which depends on n . axis alone; an object sends out Phi = A mean(M K) [W/nm]. A sphere of
// area A has A/4 as its cross section from everywhere, hence mean(K) = Omega / 4; that holds for what a point stands for as
// well. An environment of area A = 4 pi R^2 sends into the scene's disc pi R^2 integral of L dw = A Omega / 4 mean(M). A single
// distant direction gives pi R^2 f = A pi f. A total power P asks for a factor k = P / (A integral of mean(M K) dlambda), each
// object its own.
//
// The axis goes with the object as a direction does, and angles are measured in the scene's coordinates: a cone stays round
// when the object is stretched.
class SpotEmission final : public EmissionShader {
 public:
  static void describe(Description<SpotEmission>& d) {
    d.summary(
         "Light that leaves within a cone: full up to an inner angle, falling smoothly to nothing at an outer one, by "
         "t^2 (3 - 2t) with t linear in the cosine. On a Point a spotlight; on a surface the radiance's profile, to which the "
         "surface adds its cosine; on an Environment a sun with a soft edge.")
        .member<&SpotEmission::map>("radiance", "W m^-2 sr^-1 nm^-1",
                                    "radiance within the inner angle; only its shape counts when a power is given")
        .member<&SpotEmission::watts>(
            "power", "W",
            "power of each object that has this emission, from its whole area, between 360 and 830 nm; 0: as the radiance says",
            at_least(0))
        .member<&SpotEmission::axis>(
            "axis", "1",
            "the middle of the cone, the way its light travels, in the object's own coordinates; of any "
            "length. The transforms of scenes the object is nested in do not turn it")
        .member<&SpotEmission::inner_angle>("inner_angle", "deg", "from the axis to where the light begins to fall off",
                                            range(0, 180))
        .member<&SpotEmission::outer_angle>("outer_angle", "deg", "from the axis to where there is none any more",
                                            Range{0, 180, true});
  }

  void prepare() override {
    if (!map) fail("radiance", "a map or a colour is needed");
    const double x = double(axis.x), y = double(axis.y), z = double(axis.z), l = std::sqrt(x * x + y * y + z * z);
    if (!(l > 0 && std::isfinite(l))) fail("axis", "must be finite and not zero");
    axis_ = normalize(Vector3{float(x / l), float(y / l), float(z / l)});
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

    constant_ = map->constant();
    integral_ = 0;
    if (constant_) {
      for (float lambda = wavelength_low; lambda <= wavelength_high; lambda += 1) {  // trapezoids, as tables are linear
        const double value = constant_->at(lambda, ColorUse::radiance);
        if (!(value >= 0 && std::isfinite(value)))
          fail("radiance", "must be neither negative nor infinite, and is " + std::to_string(value) + " at " +
                               std::to_string(int(lambda)) + " nm");
        integral_ += lambda == wavelength_low || lambda == wavelength_high ? value / 2 : value;
      }
      if (watts > 0 && !(integral_ > 0)) fail("radiance", "is black, so it cannot have the shape of the spectrum of a power");
    }
    emitted_.reset();
  }

  Spectrum radiance(const SurfacePoint& p, const Vector3& direction, const Wavelengths& w) const override {
    const float f = profile(p, direction);
    if (!(f > 0) || !emits(p, direction)) return {};
    const Spectrum value = map->color(p, w, ColorUse::radiance) * f;
    return watts > 0 && p.object ? value * scale(*p.object, p.time) : value;
  }

  // All light of a point at infinity travels the same way: straight away from it, with probability 1. On a surface some of
  // the cone may lie on a side that does not emit; what is drawn there has density 0, and the density over the emitting
  // sides adds up to the share of the cone that lies there.
  DirectionSample sample(const SurfacePoint& p, Point2 u) const override {
    if (p.object && p.object->infinite()) return {normalize(p.object->transform.at(p.time)(Point3{} - p.object_position)), 1};
    float h = 0;
    const Vector3 direction = Frame(Normal3(axis_at(p))).to_world(draw(u, h));
    return {direction, emits(p, direction) ? fall_off(h) / solid_angle_ : 0};
  }
  float density(const SurfacePoint& p, const Vector3& direction) const override {
    if (p.object && p.object->infinite()) return 1;
    return emits(p, direction) ? profile(p, direction) / solid_angle_ : 0;
  }

  Spectrum power(const SceneObject& object, const Wavelengths& w) const override {
    const float area = object.area();
    if (!(area > 0)) return {};
    if (watts > 0 && !(emitted_per_area(object) > 0))
      fail("power", "nothing leaves the object: its radiance is black, or the whole cone lies on a side that does not emit");
    return mean_emitted(object, w) * (area * (watts > 0 ? scale(object, 0) : 1));
  }

  bool knows_incident() const override { return true; }
  DirectionSample sample_incident(Point2 u) const override {
    float h = 0;
    const Vector3 travels = Frame(Normal3(axis_)).to_world(draw(u, h));
    return {-travels, fall_off(h) / solid_angle_};
  }
  float incident_density(const Vector3& towards) const override {
    return fall_off(length_squared(towards + axis_) / 2) / solid_angle_;
  }

  Ref<ObjectMap> map = constant(1.0f);
  double watts = 0;
  Vector3 axis{0, 0, 1};
  float inner_angle = 20, outer_angle = 30;

 private:
  /// f, at an angle of 1 - cos = h to the axis.
  float fall_off(float h) const {
    if (h <= h_inner_) return 1;
    if (h >= h_outer_) return 0;
    const float t = (h_outer_ - h) / (h_outer_ - h_inner_);
    return t * t * (3 - 2 * t);
  }
  float profile(const SurfacePoint& p, const Vector3& direction) const {
    return fall_off(length_squared(direction - axis_at(p)) / 2);
  }
  Vector3 axis_at(const SurfacePoint& p) const {
    if (!p.object) return axis_;
    const AnimatedTransform& t = p.object->transform;
    if (t.animated()) [[unlikely]]
      return normalize(t.at(p.time)(axis_));
    return t.still().identity() ? axis_ : normalize(t.still()(axis_));
  }

  /// A direction around z in proportion to f.
  Vector3 draw(Point2 u, float& h) const {
    if (u.x < inner_share_) {
      h = h_inner_ * (u.x / inner_share_);
    } else {
      const float v = (1 - u.x) / (1 - inner_share_);  // inner_share_ = 1 lies beyond all u.x
      float t = std::cbrt(v);
      for (int i = 0; i < 6 && t > 0; ++i) t -= (t * t * t * (2 - t) - v) / (t * t * (6 - 4 * t));
      h = h_outer_ - clamp(t, 0, 1) * (h_outer_ - h_inner_);
    }
    const float r = safe_sqrt(h * (2 - h));
    float sine = 0, cosine = 0;
    sin_cos_turn(u.y, sine, cosine);
    return {r * cosine, r * sine, 1 - h};
  }

  // ---- power ----------------------------------------------------------------------------------------------------------

  /// K of the front alone at n . axis = c: the integral over h of f times that around the axis of max(a + b cos(phi), 0),
  /// with a = c cos(theta) and b = sqrt(1 - c^2) sin(theta), which is 2 pi a, 0, or 2 (a phi_0 + b sin(phi_0)) with
  /// phi_0 = acos(-a / b). It is smooth in x = sqrt(h) but for h_i and for the h at which the cone touches the horizon,
  /// |a| = b. Between those, x goes as s^2 (3 - 2s): all is flat at the ends then, and midpoints converge fast.
  double front(double c) const {
    constexpr int steps = 32;
    const double rise = std::sqrt(std::max(0.0, 1 - c * c)), horizon = 1 - rise;
    double sum = 0;
    const auto part = [&](double h_from, double h_to) {
      if (!(h_to > h_from)) return;
      const double from = std::sqrt(h_from), width = std::sqrt(h_to) - from;
      for (int i = 0; i < steps; ++i) {
        const double s = (i + 0.5) / steps, x = from + width * s * s * (3 - 2 * s), h = x * x;
        const double a = c * (1 - h), b = rise * std::sqrt(h * (2 - h));
        double around = 0;
        if (a >= b) {
          around = 2 * pi_exactly * a;
        } else if (a > -b) {
          const double phi = std::acos(-a / b);
          around = 2 * (a * phi + b * std::sin(phi));
        }
        sum += double(fall_off(float(h))) * around * 2 * x * width * 6 * s * (1 - s) / steps;
      }
    };
    const double inner = double(h_inner_), outer = double(h_outer_);
    part(0, std::min(horizon, inner));
    part(std::min(horizon, inner), inner);
    part(inner, std::clamp(horizon, inner, outer));
    part(std::clamp(horizon, inner, outer), outer);
    return sum;
  }
  /// K at a point of a surface with n . axis = c.
  double surface_share(double c) const {
    return (sides != Sides::back ? front(c) : 0) + (sides != Sides::front ? front(-c) : 0);
  }

  /// Gives points and weights [sr] so that mean(M K) is the sum of weight * M(point).
  template <class F>
  void for_points(const SceneObject& object, const F& add) const {
    constexpr int side = 32, count = side * side;
    const auto place = [](int i) { return Point2{(float(i % side) + 0.5f) / side, (float(i / side) + 0.5f) / side}; };
    const double quarter = double(solid_angle_) / 4;
    if (object.infinite() && object.delta()) {
      const SurfaceSample s = object.sample_visible({}, {0.5f, 0.5f}, 0);
      add(s.point, pi_exactly * double(profile(s.point, -s.direction)));
    } else if (object.infinite()) {
      for (int i = 0; i < count; ++i) {
        Ray ray;
        ray.direction = sample_incident(place(i)).direction;
        ray.direction = normalize(object.transform.still()(ray.direction));
        SurfacePoint p;
        object.surface_point(ray, {}, p);
        add(p, emits(p, -ray.direction) ? quarter / count : 0);
      }
    } else if (object.delta()) {
      add(object.sample_area({0.5f, 0.5f}, 0).point, quarter);
    } else {
      double weights = 0, known_c = 2, share = 0;
      for (int i = 0; i < count; ++i)
        if (const SurfaceSample s = object.sample_area(place(i), 0); s.density > 0) weights += double(1 / s.density);
      for (int i = 0; i < count; ++i)
        if (const SurfaceSample s = object.sample_area(place(i), 0); s.density > 0) {
          if (const double c = double(dot(s.point.normal, axis_at(s.point))); c != known_c) {  // flat: found once
            known_c = c;
            share = surface_share(c);
          }
          add(s.point, share / double(s.density) / weights);
        }
    }
  }

  /// mean(M K) at some wavelengths [W m^-2 nm^-1]; on objects with an extent from 1024 points.
  Spectrum mean_emitted(const SceneObject& object, const Wavelengths& w) const {
    if (constant_)
      return integral_ > 0 ? constant_->evaluate(w, ColorUse::radiance) * float(emitted_per_area(object) / integral_)
                           : Spectrum();
    Spectrum sum;
    for_points(object, [&](const SurfacePoint& p, double weight) {
      if (weight > 0) sum += map->color(p, w, ColorUse::radiance) * float(weight);
    });
    return sum;
  }

  /// The integral of mean(M K) over wavelengths [W m^-2]; of a map, at the middle of 48 equal steps.
  double emitted_per_area(const SceneObject& object) const {
    return emitted_.get(object, [&] {
      if (constant_) {
        double share = 0;
        for_points(object, [&](const SurfacePoint&, double weight) { share += weight; });
        return integral_ * share;
      }
      constexpr int sets = 48 / spectrum_size;
      constexpr float step = (wavelength_high - wavelength_low) / (sets * spectrum_size);
      double sum = 0;
      for (int set = 0; set < sets; ++set) {
        Wavelengths w;
        for (int i = 0; i < spectrum_size; ++i)
          w.place(i, wavelength_low + (float(i * sets + set) + 0.5f) * step, 1 / (wavelength_high - wavelength_low));
        sum += double(mean_emitted(object, w).average()) * spectrum_size * double(step);
      }
      return sum;
    });
  }

  float scale(const SceneObject& object, float time) const {
    const double below = double(object.area(time)) * emitted_per_area(object);
    return below > 0 ? float(watts / below) : 0;
  }

  Vector3 axis_{0, 0, 1};            // unit
  float h_inner_ = 0, h_outer_ = 0;  // 1 - cos of the angles
  float solid_angle_ = 0;            // Omega [sr]
  float inner_share_ = 0;            // probability that a direction lies within the inner angle
  Color constant_;
  double integral_ = 0;  // of the one colour over wavelengths
  PerObject emitted_;
};

const Register<SpotEmission> registered;

}  // namespace
}  // namespace etendue
