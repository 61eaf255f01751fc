#pragma once
// What objects share that are described in their own coordinates, and whose transform carries rays in and points out.

#include "geometry.h"

namespace etendue {

/// A point on an object in the object's own coordinates.
struct OwnPoint {
  Point3 position;
  Normal3 normal{0, 0, 1};          ///< unit, geometric, to the front; of a closed object outwards
  Normal3 shading_normal{0, 0, 0};  ///< unit; zero: the geometric one
  float error = 0;                  ///< bound of the distance of `position` from the true surface, along the normal
  Point2 uv;
  Vector3 dpdu, dpdv;  ///< change of position with uv
  std::uint32_t primitive = 0;
  float u = 0, v = 0;  ///< as in a Hit
};

/// A ray in double: solvers work in these, for a float's rounding at a distance is that of the whole scene.
struct DoubleRay {
  double origin[3], direction[3];  ///< the direction is not normalized
  double maximum;
  explicit DoubleRay(const Ray& r)
      : origin{double(r.origin.x), double(r.origin.y), double(r.origin.z)},
        direction{double(r.direction.x), double(r.direction.y), double(r.direction.z)},
        maximum(double(r.maximum)) {}
  double at(double t, int k) const { return origin[k] + t * direction[k]; }
};

/// An object gives bounds, intersection, points, area and samples in its own coordinates; this class does the rest, for
/// any transform, moving ones too. Samples are by area; an object that knows better overrides sample_visible and
/// visible_density, as a whole.
class PlacedObject : public SceneObject {
 public:
  Bounds3 bounds() const override { return bounds_; }
  bool intersect(const Ray&, Hit&) const override;
  bool occludes(const Ray&) const override;
  void surface_point(const Ray&, const Hit&, SurfacePoint&) const override;
  void tangents(SurfacePoint&) const override {}  // every point comes with them
  float area(float time) const override;
  float area_error(float time) const override;
  SurfaceSample sample_area(Point2 u, float time) const override;
  float area_pdf(const SurfacePoint&) const override;

 protected:
  /// To be called at the end of prepare, when all functions below work.
  void place();

  virtual Bounds3 own_bounds() const = 0;
  /// The nearest intersection with t in (0, ray.maximum): fills distance, primitive, u and v. t > 0 is the float's: a t
  /// that is 0 as a float is none. Rays that start on the surface were moved off it by SurfacePoint::error.
  virtual bool own_intersect(const Ray&, Hit&) const = 0;
  /// Whether anything lies on the ray.
  virtual bool own_occludes(const Ray& ray) const {
    Hit hit;
    return own_intersect(ray, hit);
  }
  /// The point of a hit: on the surface as nearly as floats allow, not merely on the ray.
  virtual void own_point(const Ray&, const Hit&, OwnPoint&) const = 0;
  /// Area before the transform.
  virtual double own_area() const = 0;
  /// Bound of that area's relative error; 0: a formula gives it.
  virtual float own_area_error() const { return 0; }
  /// A point by area, with its density per own area; 0: none was found. A continuous map of the unit square to the surface,
  /// where there is one, keeps samples well spread. Never throws.
  virtual float own_sample(Point2 u, OwnPoint&) const = 0;
  /// Where smooth pieces of own_sample's map meet within the unit square: at these x, and at these y, in order.
  struct Seams {
    std::vector<double> x, y;
  };
  virtual Seams own_seams() const { return {}; }
  /// The density own_sample gives a point with.
  virtual float own_pdf(const SurfacePoint&) const { return float(1 / own_area()); }

  /// How near to an edge points go, in own coordinates: see `border`.
  float margin() const { return margin_; }
  /// A coordinate between two edges, and not nearer to them than that.
  double within(double x, double low, double high) const {
    const double m = std::min(double(margin_), 0.125 * (high - low));
    return std::clamp(x, low + m, high - m);
  }

  /// From own coordinates to those of the containing scene.
  void carry(const OwnPoint&, float time, SurfacePoint&) const;
  /// By how much a transform enlarges area at a unit normal inside: |det M| |M^-T n|.
  static float area_stretch(const Transform& t, const Normal3& n) {
    return std::abs(linear_determinant(t)) * length(Vector3(t(n)));
  }

 private:
  /// Area [m^2], and how far it may be off, relatively.
  struct Area {
    float value = 0, error = 0;
  };
  Area area_of(const Transform&) const;
  /// A part of own_sample's unit square.
  struct Piece {
    double x0, x1, y0, y1;
  };
  /// The area of a piece after a transform, by Gauss's rule in so many panels each way.
  double stretched(const Transform&, const Piece&, int panels) const;

  Bounds3 bounds_;
  float margin_ = 0;
  Area still_area_;
};

}  // namespace etendue
