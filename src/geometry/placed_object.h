#pragma once
// PlacedObject: base class of shapes that are defined in object space. It transforms rays to object space, and points and
// samples to world space.

#include "geometry.h"

namespace etendue {

/// A point on a shape, in object space.
struct OwnPoint {
  Point3 position;
  Normal3 normal{0, 0, 1};          ///< unit geometric normal on the front side; outwards on a closed object
  Normal3 shading_normal{0, 0, 0};  ///< unit; zero stands for the geometric normal
  float error = 0;                  ///< upper bound of the distance of `position` from the true surface, along the normal
  Point2 uv;
  Vector3 dpdu, dpdv;  ///< derivatives of position by uv
  std::uint32_t primitive = 0;
  float u = 0, v = 0;  ///< as in a Hit
};

/// A ray in double for the root finders: a float's rounding error at a distance is relative to that distance, not to the size
/// of the shape.
struct DoubleRay {
  double origin[3], direction[3];  ///< the direction is not normalized
  double maximum;
  explicit DoubleRay(const Ray& r)
      : origin{double(r.origin.x), double(r.origin.y), double(r.origin.z)},
        direction{double(r.direction.x), double(r.direction.y), double(r.direction.z)},
        maximum(double(r.maximum)) {}
  double at(double t, int k) const { return origin[k] + t * direction[k]; }
};

/// A derived class implements bounds, intersection, surface points, area and samples in object space; this class does the rest
/// for any transform, including animated ones. Sampling is uniform or nearly uniform by area; a derived class with a better
/// sampler overrides both sample_visible and visible_pdf.
class PlacedObject : public SceneObject {
 public:
  Bounds3 bounds() const override { return bounds_; }
  bool intersect(const Ray&, Hit&) const override;
  bool occludes(const Ray&) const override;
  void surface_point(const Ray&, const Hit&, SurfacePoint&) const override;
  /// own_point and own_sample set the tangents of every point. Here they are computed for a point that has lost them.
  void tangents(SurfacePoint&) const override;
  float area(float time) const override;
  float area_error(float time) const override;
  SurfaceSample sample_area(Point2 u, float time) const override;
  float area_pdf(const SurfacePoint&) const override;

 protected:
  /// To be called at the end of prepare, when all functions below can be called.
  void place();

  virtual Bounds3 own_bounds() const = 0;
  /// The nearest intersection with t in (0, ray.maximum): fills distance, primitive, u and v. t > 0 holds for the rounded
  /// float: a t that rounds to 0 is no hit. Rays that start on the surface have been offset from it by SurfacePoint::error.
  virtual bool own_intersect(const Ray&, Hit&) const = 0;
  /// Whether the ray hits the shape.
  virtual bool own_occludes(const Ray& ray) const {
    Hit hit;
    return own_intersect(ray, hit);
  }
  /// The point of a hit: computed on the surface to float precision, not merely on the ray. A hit at distance 0 that has the
  /// primitive, u and v of a point, on a ray whose direction is zero and whose origin is that point, gives the point again.
  virtual void own_point(const Ray&, const Hit&, OwnPoint&) const = 0;
  /// Area in object space, before the transform.
  virtual double own_area() const = 0;
  /// Upper bound of that area's relative error; 0 if the area is given by a formula.
  virtual float own_area_error() const { return 0; }
  /// Samples a point by area and returns its pdf per object-space area; 0 if none was found. Where a continuous map from the
  /// unit square to the surface exists it is preferred, since it keeps samples well distributed. Never throws.
  virtual float own_sample(Point2 u, OwnPoint&) const = 0;
  /// The boundaries between smooth pieces of own_sample's map within the unit square: at these x and at these y, in ascending
  /// order.
  struct Seams {
    std::vector<double> x, y;
  };
  virtual Seams own_seams() const { return {}; }
  /// The pdf of own_sample at a point, per object-space area.
  virtual float own_pdf(const SurfacePoint&) const { return float(1 / own_area()); }

  /// The least distance of points from an edge, in object space: see `border`.
  float margin() const { return margin_; }
  /// Clamps a coordinate between two edges, at least margin() away from each.
  double within(double x, double low, double high) const {
    const double m = std::min(double(margin_), 0.125 * (high - low));
    return std::clamp(x, low + m, high - m);
  }

  /// Transforms a point from object space to the coordinates of the containing scene.
  void carry(const OwnPoint&, float time, SurfacePoint&) const;
  /// The factor by which a transform enlarges area at a unit object-space normal n: |det M| |M^-T n|.
  static float area_stretch(const Transform& t, const Normal3& n) {
    return std::abs(linear_determinant(t)) * length(Vector3(t(n)));
  }

 private:
  /// The complete point of a hit, in object space like the ray.
  OwnPoint point_of(const Ray&, const Hit&) const;
  /// Area [m^2] and its relative error bound.
  struct Area {
    float value = 0, error = 0;
  };
  Area area_of(const Transform&) const;
  /// A part of own_sample's unit square.
  struct Piece {
    double x0, x1, y0, y1;
  };
  /// The area of a piece after a transform, by Gauss-Legendre quadrature with `panels` x `panels` panels.
  double stretched(const Transform&, const Piece&, int panels) const;

  Bounds3 bounds_;
  float margin_ = 0;
  Area still_area_;
};

}  // namespace etendue
