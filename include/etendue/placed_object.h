#pragma once
// PlacedObject: base class of shapes that are defined in object space. It transforms rays to object space, and points and
// samples to world space, for any transform, including animated ones.
//
// A new shape must implement the five functions `local_bounds`, `local_intersect`, `local_point`, `local_area` and
// `local_sample`, whose arguments and results are in object space (`local_`), and call `place` at the end of `prepare`. Of
// SceneObject's functions it overrides `closed` if its surface encloses a volume.

#include <algorithm>
#include <vector>

#include "etendue/scene_object.h"

namespace etendue {

/// A point on a shape, in object space.
struct LocalPoint {
  Point3 position;
  Normal3 normal{0, 0, 1};          ///< unit geometric normal on the front side; outwards on a closed object
  Normal3 shading_normal{0, 0, 0};  ///< unit; zero stands for the geometric normal
  float error = 0;                  ///< upper bound of the distance of `position` from the true surface, along the normal
  Point2 uv;
  Vector3 dpdu, dpdv;  ///< derivatives of position by uv
  std::uint32_t primitive = 0;
  float u = 0, v = 0;  ///< as in a Hit
};

/// Sampling is uniform or nearly uniform by area; a derived class with a better sampler overrides both sample_visible and
/// visible_pdf.
class PlacedObject : public SceneObject {
 public:
  Bounds3 bounds() const override { return bounds_; }
  bool intersect(const Ray&, Hit&) const override;
  bool occludes(const Ray&) const override;
  void surface_point(const Ray&, const Hit&, SurfacePoint&) const override;
  /// local_point and local_sample set the tangents of every point. Here they are computed for a point that has lost them.
  void tangents(SurfacePoint&) const override;
  float area(float time) const override;
  float area_error(float time) const override;
  SurfaceSample sample_area(Point2 u, float time) const override;
  float area_pdf(const SurfacePoint&) const override;

 protected:
  /// To be called at the end of prepare, when all functions below can be called.
  void place();

  virtual Bounds3 local_bounds() const = 0;
  /// The nearest intersection with t in (0, ray.maximum): fills distance, primitive, u and v; a miss leaves the hit unchanged.
  /// t > 0 holds for the rounded float: a t that rounds to 0 is no hit. Rays that start on the surface have been offset from it
  /// by the error of their point.
  virtual bool local_intersect(const Ray&, Hit&) const = 0;
  /// Whether the ray hits the shape.
  virtual bool local_occludes(const Ray& ray) const {
    Hit hit;
    return local_intersect(ray, hit);
  }
  /// The point of a hit: computed on the surface to float precision, not merely on the ray. Primitive, u and v are set already.
  /// A hit at distance 0 that has the primitive, u and v of a point, on a ray whose direction is zero and whose origin is that
  /// point, gives the point again.
  virtual void local_point(const Ray&, const Hit&, LocalPoint&) const = 0;
  /// Area in object space, before the transform.
  virtual double local_area() const = 0;
  /// Upper bound of that area's relative error; 0 if the area is given by a formula.
  virtual float local_area_error() const { return 0; }
  /// Samples a point by area and returns its pdf per object-space area; 0 if none was found. Where a continuous map from the
  /// unit square to the surface exists it is preferred, since it keeps samples well distributed. Never throws.
  virtual float local_sample(Point2 u, LocalPoint&) const = 0;
  /// The boundaries between smooth pieces of local_sample's map within the unit square: at these x and at these y, in ascending
  /// order. They make the area exact under transforms that are no similarities.
  struct Seams {
    std::vector<double> x, y;
  };
  virtual Seams local_seams() const { return {}; }
  /// The pdf of local_sample at a point, per object-space area.
  virtual float local_pdf(const SurfacePoint&) const { return float(1 / local_area()); }

  /// Clamps a coordinate to a margin inside two edges of the surface. Points on an edge might be rounded to the far side of an
  /// adjacent surface, where light would leak.
  double within(double x, double low, double high) const {
    const double m = std::min(double(margin_), 0.125 * (high - low));
    return std::clamp(x, low + m, high - m);
  }

  /// Transforms a point from object space to the coordinates of the containing scene.
  void carry(const LocalPoint&, float time, SurfacePoint&) const;

 private:
  /// The complete point of a hit, in object space like the ray.
  LocalPoint point_of(const Ray&, const Hit&) const;
  /// Area [m^2] and its relative error bound.
  struct Area {
    float value = 0, error = 0;
  };
  Area area_of(const Transform&) const;
  /// A part of local_sample's unit square.
  struct Piece {
    double x0, x1, y0, y1;
  };
  /// The area of a piece after a transform, by Gauss-Legendre quadrature with `panels` x `panels` panels.
  double stretched(const Transform&, const Piece&, int panels) const;

  Bounds3 bounds_;
  float margin_ = 0;  // in object space
  Area still_area_;
};

}  // namespace etendue
