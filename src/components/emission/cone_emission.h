#pragma once
// ConeEmission: base class of spots, whose light leaves within a cone: full up to an inner angle, falling to nothing at an
// outer one.

#include "axial_emission.h"

namespace etendue {

// Profile, with h = 1 - cos(theta) of the angle to the axis (AxialEmission): f = 1 for h <= h_i and f = 0 for h >= h_o, where
// h_i and h_o belong to the inner and outer angle. Between them lies the edge, whose fall-off each derived class defines.
//
// Directions are sampled with the pdf f / Omega: h is uniform up to h_i with the probability 2 pi h_i / Omega; else the derived
// class samples the edge.
//
// A picture (a gobo) multiplies the light by its map as a transmittance. It lies perpendicular to the axis, and its unit square
// spans the outer angle. Directions are sampled as without it.
class ConeEmission : public AxialEmission {
 public:
  Spectrum radiance(const SurfacePoint&, const Vector3& direction, const Wavelengths&) const override;
  /// With a picture the power is multiplied by the picture's mean over the cone, which is exact for a Point and approximate for
  /// surfaces.
  Spectrum power(const SceneObject&, const Wavelengths&) const override;

  float inner_angle = 20, outer_angle = 30;  // [deg]
  Ref<ObjectMap> picture;

 protected:
  /// Describes the light and the angles; describe_picture() comes last.
  template <class T>
  static void describe_cone(Description<T>& d) {
    d.group("Light").template member<&T::map>("radiance", "W m^-2 sr^-1 nm^-1",
                                              "radiance within the inner angle; only its shape counts when an amount is given",
                                              Meaning::radiance, soft(0.01, 1000), logarithmic);
    ShapedEmission::describe_amounts(d);
    d.group("Cone")
        .template member<&T::axis>("axis", "1",
                                   "the middle of the cone, the way its light travels, in the object's own coordinates; of any "
                                   "length")
        .template member<&T::inner_angle>("inner_angle", "deg", "from the axis to where the light begins to fall off",
                                          range(0, 180))
        .template member<&T::outer_angle>("outer_angle", "deg", "from the axis to where there is none any more",
                                          Range{0, 180, true});
  }
  template <class T>
  static void describe_picture(Description<T>& d) {
    d.template member<&T::picture>(
        "picture", "1",
        "what the light is multiplied by, a transmittance, such as a slide's; (u, v) = (1/2, 1/2) lies in the axis, u grows "
        "towards +x and v towards +y of the object, and the outer angle is reached at 0 and 1; amounts are those of the "
        "cone without it; none: all passes",
        Meaning::reflectance);
  }

  /// Checks the angles, and sets h_i and h_o. Derived classes call this first.
  void prepare_angles();
  /// Derived classes call this last, with Omega [sr].
  void prepare_cone(float solid_angle);

  // ---- defined by each edge -----------------------------------------------------------------------------------------------
  /// f on the edge, h_i < h < h_o.
  virtual float edge_fall_off(float h) const = 0;
  /// The h beyond which the share v of the edge's light lies, 0 < v <= 1.
  virtual float draw_edge(float v) const = 0;

  float fall_off(float h) const final {
    if (h <= h_inner_) return 1;
    if (h >= h_outer_) return 0;
    return edge_fall_off(h);
  }
  double solid_angle() const final { return double(solid_angle_); }
  double inner() const final { return double(h_inner_); }
  double outer() const final { return double(h_outer_); }
  float draw(float u, bool surface) const final;
  float drawn(float h, bool) const final { return fall_off(h) / solid_angle_; }

  float h_inner() const { return h_inner_; }
  float h_outer() const { return h_outer_; }

 private:
  void prepare_picture();
  /// The picture's transmittance in a direction given in picture_frame().
  Spectrum seen_through(float time, const Vector3& local, const Wavelengths&) const;

  float h_inner_ = 0, h_outer_ = 0;  // 1 - cos of the angles
  float solid_angle_ = 0;            // Omega [sr]
  float picture_scale_ = 0;          // from a plane at distance 1 to (u, v)
  float inner_share_ = 0;            // probability that a direction lies within the inner angle
};

}  // namespace etendue
