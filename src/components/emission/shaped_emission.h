#pragma once
// ShapedEmission: base class of emissions whose radiance is a colour times a directional profile. The amount of light can be
// given in watts, lumens, candelas or lux.

#include <optional>

#include "etendue/emission_shader.h"
#include "etendue/object_map.h"
#include "etendue/scene_object.h"
#include "per_object.h"
#include "quantity.h"

namespace etendue {

// The radiance at a point p in direction w is  L = k M(p) f(p, w),  with M the map's colour [W m^-2 sr^-1 nm^-1] and f the
// profile [1]. The radiant exitance of a surface with normal n, for k = 1 and divided by M, is
//     K(p) = integral over the sides that emit of f |n . w| dw   [sr],
// so an object of area A emits the power Phi = k A mean(M K) [W/nm]. A sphere of area A has the cross section A/4 from every
// direction, hence mean(K) = Omega / 4 with Omega = integral of f dw; the same holds for the sphere that a point light stands
// for (SceneObject::delta). An environment of area A = 4 pi R^2 sends the power pi R^2 integral of L dw = A Omega / 4 mean(M)
// through the disc of radius R that the scene presents to each direction. A single distant direction gives
// pi R^2 L = A pi f M.
//
// k is 1 unless an amount is requested; then k is, for each object separately, the requested amount over the amount with k = 1.
// The amounts are weighted over wavelengths by 1 (power) or by 683.002 V (the others):
//   power, flux   A mean(M K).
//   intensity     in the direction a of the object's axis: A mean(M f(a) |n . a|) over the points that emit towards a; for a
//                 point light M f(a) * 1 m^2. The axis is the profile's own, else the object's mean normal. A closed object
//                 has none: its intensity is the mean over all directions, A mean(M K) / (4 pi).
//   illuminance   on a surface perpendicular to the axis at `distance` from the middle of the object, without occlusion:
//                 A mean(M f(w) |n . w| (a . w) / r^2), with w and r from each point; hence intensity / distance^2 for a point
//                 light and, very nearly, for any object from far away. From infinity, on a plane that faces the light along
//                 the axis: L * 1 sr for a single direction, the integral of L cos dw for an environment, whose axis, if the
//                 profile has none, is the object's -y.
// Where mean(K) has no closed form, it is computed from 1024 points when the emission of an object is first evaluated. For a
// moving object the amount per area with k = 1 is that at time 0.
class ShapedEmission : public EmissionShader {
 public:
  Spectrum power(const SceneObject&, const Wavelengths&) const override;

  Ref<ObjectMap> map = constant(1.0f);
  double watts = 0, lumens = 0, candelas = 0, lux = 0;
  float distance = 1;  // of the illuminance [m]

 protected:
  /// Describes the members for amounts.
  template <class T>
  static void describe_amounts(Description<T>& d) {
    d.group("Amount")
        .template member<&T::watts>(
            "power", "W",
            "power of each object that has this emission, from its whole area, between 360 and 830 nm; 0: "
            "as the radiance says",
            at_least(0), soft(0.1, 10000), logarithmic)
        .template member<&T::lumens>("luminous_flux", "lm", "the same in lumens; 0: not asked for", at_least(0),
                                     soft(1, 100000), logarithmic)
        .template member<&T::candelas>("luminous_intensity", "cd",
                                       "of each object along its axis (its mean normal where the emission has none; of a "
                                       "closed object the mean over all directions); 0: not asked for",
                                       at_least(0), soft(1, 100000), logarithmic)
        .template member<&T::lux>("illuminance", "lx",
                                  "on a surface across that axis at `distance`, if nothing is between; from infinity, on a "
                                  "plane that faces the light, or upwards; 0: not asked for",
                                  at_least(0), soft(1, 100000), logarithmic)
        .template member<&T::distance>("distance", "m", "from the middle of the object, for `illuminance`", more_than(0),
                                       soft(0.1, 100), logarithmic, when("illuminance"));
  }

  /// Checks the amounts and the map, called `name` in files. Derived classes call it last.
  void prepare_amounts(std::string_view name);

  // ---- defined by each profile ------------------------------------------------------------------------------------------
  /// f, which need not be zero on sides that do not emit.
  virtual float profile(const SurfacePoint&, const Vector3& direction) const = 0;
  virtual double solid_angle() const = 0;                       ///< Omega [sr]
  virtual double surface_share(const SurfacePoint&) const = 0;  ///< K at a point with a normal [sr]
  /// Whether K is the same at all points of any surface.
  virtual bool same_on_surfaces() const { return false; }
  /// The axis of the profile in world space, the direction in which its light travels; zero if the profile has no axis other
  /// than the normal.
  virtual Vector3 own_axis(const SurfacePoint&) const { return {}; }

  /// k M f, the radiance.
  Spectrum scaled(const SurfacePoint& p, const Wavelengths& w, float f) const {
    const Spectrum value = map->color(p, w, ColorUse::radiance) * f;
    return amount_ > 0 && p.object ? value * scale(*p.object, p.time) : value;
  }
  /// k [1].
  float scale(const SceneObject&, float time) const;
  /// A direction given in object space, transformed to world space and normalized: angles are measured in world space.
  static Vector3 turned(const SurfacePoint& p, const Vector3& v) {
    if (!p.object) return v;
    const AnimatedTransform& t = p.object->transform;
    if (t.animated()) [[unlikely]]
      return normalize(t.at(p.time)(v));
    return t.still().identity() ? v : normalize(t.still()(v));
  }
  /// The world-space frame of a picture perpendicular to the object's z axis: right and up as seen from behind, and the axis.
  /// Right is towards the object's -x.
  static Frame picture_frame(const SurfacePoint& p) {
    const Vector3 a = turned(p, {0, 0, 1});
    Vector3 r = normalize(cross(a, turned(p, {0, 1, 0})));
    const Vector3 up = cross(r, a);
    if (dot(r, turned(p, {-1, 0, 0})) < 0) r = -r;  // a mirrored object's picture is mirrored
    return {r, up, Normal3(a)};
  }
  /// The point at which a picture's map is evaluated: only (u, v) in the picture and the time have a meaning.
  static SurfacePoint picture_point(Point2 uv, float time) {
    SurfacePoint p;
    p.uv = uv;
    p.time = time;
    p.normal = p.shading_normal = p.object_normal = Normal3(0, 0, 1);
    return p;
  }
  void objects_changed() override { measured_.forget(); }
  bool amount_asked() const { return amount_ > 0; }
  /// Name of the member that gives the amount.
  std::string_view amount_name() const;
  /// A member's direction as a unit vector; calls fail() if the member is zero or not finite.
  Vector3 checked_direction(const Vector3&, std::string_view name) const;

 private:
  template <class F>
  void for_points(const SceneObject&, Quantity, const F& add) const;
  template <class F>
  void for_infinity(const SceneObject&, Quantity, const F& add) const;
  template <class F>
  void for_surface(const SceneObject&, Quantity, const F& add) const;
  std::optional<double> mean_share(const SceneObject&) const;
  Spectrum mean(const SceneObject&, Quantity, const Wavelengths&) const;
  double measured(const SceneObject&) const;

  Quantity quantity_ = Quantity::power;
  double amount_ = 0;    // of the quantity; 0: k = 1
  Color constant_;       // when the map has one colour
  double integral_ = 0;  // of that colour over wavelengths, weighted for the quantity
  PerObject measured_;   // the amount per area with k = 1
};

}  // namespace etendue
