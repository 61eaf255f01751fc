#pragma once
// AxialEmission: base class of emissions whose profile is rotationally symmetric about an axis or the surface's normal.

#include "shaped_emission.h"

namespace etendue {

// With theta the angle to the axis, a profile is a function of h = 1 - cos(theta). h is computed from the difference d of the
// two unit vectors as |d|^2 / 2, which stays exact in narrow cones. As dw = 2 pi dh, Omega = 2 pi integral of f dh.
class AxialEmission : public ShapedEmission {
 public:
  Spectrum radiance(const SurfacePoint&, const Vector3& direction, const Wavelengths&) const override;

  // Points at infinity emit as at_infinity.h says. On a surface a part of a profile about an axis may lie on a side that does
  // not emit. Samples of this part have pdf 0, and the pdf integrates over the emitting sides to the share of the profile that
  // lies there.
  DirectionSample sample(const SurfacePoint&, Point2 u) const override;
  float pdf(const SurfacePoint&, const Vector3& direction) const override;

  bool knows_incident() const override { return true; }
  DirectionSample sample_incident(Point2 u) const override;
  float incident_pdf(const Vector3& towards) const override;

  enum class About : std::uint8_t { normal, axis };
  Vector3 axis{0, 0, 1};
  About about = About::axis;

 protected:
  /// Derived classes call this when the parameters of fall_off() are set.
  void prepare_axis() {
    axis_ = checked_direction(axis, "axis");
    normal_share_ = front(1);
  }

  // ---- defined by each profile --------------------------------------------------------------------------------------------
  /// f at 1 - cos(theta) = h.
  virtual float fall_off(float h) const = 0;
  /// outer(): the least h beyond which f is zero or negligible. inner(): an h before it where f is not smooth (0: none).
  virtual double outer() const = 0;
  virtual double inner() const { return 0; }
  /// draw() samples h, drawn() returns its pdf [1/sr]. `surface`: the profile is about a surface's normal, so the pdf may be
  /// proportional to f times the cosine.
  virtual float draw(float u, bool surface) const = 0;
  virtual float drawn(float h, bool surface) const = 0;

  float profile(const SurfacePoint&, const Vector3& direction) const override;
  double surface_share(const SurfacePoint&) const override;
  bool same_on_surfaces() const override { return about == About::normal; }
  Vector3 own_axis(const SurfacePoint& p) const override { return about_normal(p) ? Vector3{} : axis_at(p); }

 private:
  /// False for points without a normal (a Point), and at infinity, where all light travels along the normal.
  bool about_normal(const SurfacePoint& p) const {
    return about == About::normal && !(p.normal == Normal3{}) && !(p.object && p.object->infinite());
  }
  Vector3 axis_at(const SurfacePoint& p) const { return turned(p, axis_); }
  float height(const SurfacePoint&, const Vector3& direction) const;
  Vector3 local(float h, float turn) const;
  double front(double c) const;

  Vector3 axis_{0, 0, 1};    // unit
  double normal_share_ = 0;  // K of one side, about the normal [sr]
};

}  // namespace etendue
