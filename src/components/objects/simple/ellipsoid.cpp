// Ellipsoid: a sphere scaled along the axes.

#include "etendue/core/warp.h"
#include "etendue/placed_object.h"
#include "geometry/double_ray.h"
#include "geometry/ellipsoid_area.h"
#include "geometry/geometry.h"
#include "geometry/visible_directions.h"

namespace etendue {
namespace {

// Points are centre + radii * s with s on the unit sphere; most computations are done on the unit sphere.
class Ellipsoid final : public PlacedObject {
 public:
  static void describe(Description<Ellipsoid>& d) {
    d.summary(
         "An ellipsoid with its axes along x, y and z. Surface coordinates are those of the sphere it is stretched from: u "
         "around "
         "z from +x towards +y, v from the pole at -z to that at +z.",
         "area: Carlson 1995, \"Numerical computation of real or complex elliptic integrals\"; the cone in which it is seen: "
         "Heitz "
         "2017, \"Analytical calculation of the solid angle subtended by an arbitrarily positioned ellipsoid to a point "
         "source\"")
        .group("Shape")
        .member<&Ellipsoid::centre>("centre", "m", "its centre", Effect::rebuild)
        .member<&Ellipsoid::radii>("radii", "m", "its half axes along x, y and z", Effect::rebuild);
  }

  void prepare() override {
    if (!is_finite(centre)) fail("centre", "must be finite");
    for (int k = 0; k < 3; ++k)
      if (!(radii[k] > 0 && radii[k] < infinity)) fail("radii", "all must be positive and finite");
    transform.set_inner_origin(centre);
    area_ = area_under(Transform());
    if (!(float(area_) > 0 && float(area_) < infinity)) fail("radii", "the ellipsoid is too small or too large");
    const double a = double(radii.x), b = double(radii.y), c = double(radii.z), sum = a * b + b * c + c * a;
    share_[0] = b * c / sum;
    share_[1] = c * a / sum;
    share_[2] = a * b / sum;
    flat_ = std::max({a, b, c}) > 2 * std::min({a, b, c});
    placed_area_ = float(area_under(transform.still()));
    place();
  }

  bool closed() const override { return true; }

  float area(float time) const override { return transform.animated() ? float(area_under(transform.at(time))) : placed_area_; }
  float area_error(float) const override { return 0; }

  // The reference point is transformed to the space of the unit sphere, and directions are sampled uniformly in the cone that
  // the unit sphere subtends there. A linear map M of directions w -> M w / |M w| enlarges solid angles by |det M| / |M w|^3,
  // and |M w| is the distance in world space divided by the distance in the sphere's space.
  SurfaceSample sample_visible(const Point3& from, Point2 u, float time) const override {
    Transform scratch;
    const Transform& t = placed(transform, time, scratch);
    const Cone cone = seen(t.back(from));
    if (!cone.usable) return sample_by_both(*this, cone.directions(), from, u, time, none, no_pdf);
    // As in Sphere: alpha is the angle at the centre between the directions to the reference point and to the sampled point.
    const double h = double(u.x) * cone.one_minus_cosine, sin2 = h * (2 - h);
    const double cos_alpha =
        std::min(1.0, sin2 * cone.distance + (1 - h) * std::sqrt(std::max(0.0, 1 - sin2 * cone.distance * cone.distance)));
    const double sin_alpha = std::sqrt(1 - cos_alpha * cos_alpha), phi = 2 * M_PI * double(u.y);
    const Frame axis(Normal3(float(cone.x / cone.distance), float(cone.y / cone.distance), float(cone.z / cone.distance)));
    const auto x = float(sin_alpha * std::cos(phi)), y = float(sin_alpha * std::sin(phi));
    const Vector3 unit = x * axis.s + y * axis.t + float(cos_alpha) * Vector3(axis.n);
    LocalPoint own;
    point_at(double(unit.x), double(unit.y), double(unit.z), own);
    SurfaceSample s;
    carry(own, time, s.point);
    complete_by_angle(s, from, 1);
    s.pdf *= cone_pdf(cone, t, s.distance, s.direction, s.point);
    return s;
  }

  float visible_pdf(const Point3& from, const Vector3& direction, const SurfacePoint& p) const override {
    Transform scratch;
    const Transform& t = placed(transform, p.time, scratch);
    const Cone cone = seen(t.back(from));
    if (!cone.usable) return pdf_by_both(cone.directions(), from, direction, p, no_pdf);
    return cone_pdf(cone, t, distance(p.position, from), direction, p);
  }

  DoublePoint3 centre{0, 0, 0};
  Vector3 radii{1, 1, 1};

 protected:
  Bounds3 local_bounds() const override {
    Bounds3 box;
    box.add(Point3{} - radii);
    box.add(Point3{} + radii);
    return box;
  }

  bool local_intersect(const Ray& ray, Hit& hit) const override {
    // Parametrized from the ray's point nearest to the centre, where the discriminant is no difference of large numbers.
    double o[3], d[3], along = 0, dd = 0;
    for (int k = 0; k < 3; ++k) {
      const double inverse = 1 / double(radii[k]);
      o[k] = double(ray.origin[k]) * inverse;
      d[k] = double(ray.direction[k]) * inverse;
      along += o[k] * d[k];
      dd += d[k] * d[k];
    }
    const double middle = -along / dd;
    double rest = 1;
    for (int k = 0; k < 3; ++k) rest -= (o[k] + middle * d[k]) * (o[k] + middle * d[k]);
    if (!(rest > 0)) return false;
    const double half = std::sqrt(rest / dd);
    const float near = float(middle - half), far = float(middle + half), t = near > 0 ? near : far;
    if (!(t > 0 && t < ray.maximum)) return false;
    hit.distance = t;
    hit.primitive = 0;
    hit.u = float((near > 0 ? middle - half : middle + half) - double(t));  // rounding error of the float distance
    hit.v = 0;
    return true;
  }

  void local_point(const Ray& ray, const Hit& hit, LocalPoint& p) const override {
    const DoubleRay r(ray);
    const double t = double(hit.distance) + double(hit.u);
    double s[3];
    for (int k = 0; k < 3; ++k) s[k] = r.at(t, k) / double(radii[k]);
    point_at(s[0], s[1], s[2], p);
  }

  double local_area() const override { return area_; }

  // On a nearly round ellipsoid points are sampled uniformly on the unit sphere. On a flat or long one these would concentrate
  // at the rim or the tips: area is stretched by the factor sqrt(sum (w_k s_k)^2) with weights w = (bc, ca, ab), and a mixture
  // of three cosine distributions, sum w_k |s_k|, is between one and sqrt(3) times this factor.
  float local_sample(Point2 u, LocalPoint& p) const override {
    Vector3 s = warp::sphere(u);
    if (flat_) {
      int k = 0;
      double x = double(u.x);
      while (k < 2 && x >= share_[k]) x -= share_[k++];
      x = std::clamp(2 * x / share_[k], 0.0, 2.0);
      const bool front = x < 1;
      const Vector3 lobe = warp::cosine_hemisphere({std::min(float(front ? x : x - 1), one_minus_epsilon), u.y});
      s[k] = front ? lobe.z : -lobe.z;
      s[(k + 1) % 3] = lobe.x;
      s[(k + 2) % 3] = lobe.y;
    }
    point_at(double(s.x), double(s.y), double(s.z), p);
    return pdf_at(p.normal);
  }
  float local_pdf(const SurfacePoint& p) const override { return pdf_at(p.object_normal); }

 private:
  /// The cone that the unit sphere subtends at a point, which is (x, y, z) in the space of the unit sphere.
  struct Cone {
    double x = 0, y = 0, z = 0, distance = 0, one_minus_cosine = 0;
    bool usable = false;  ///< the point is neither inside nor too close to the surface
    DirectionShare directions() const { return {1, distance < 1}; }
  };
  /// The sampler by area for sample_by_both; it is never called, since all samples are by direction.
  static bool none(Point2, SurfaceSample&) { return false; }
  static float no_pdf(const SurfacePoint&) { return 0; }

  Cone seen(const Point3& own) const {
    Cone c;
    c.x = double(own.x) / double(radii.x);
    c.y = double(own.y) / double(radii.y);
    c.z = double(own.z) / double(radii.z);
    const double d2 = c.x * c.x + c.y * c.y + c.z * c.z, sin2 = 1 / d2;
    c.distance = std::sqrt(d2);
    c.usable = sin2 < 0.9999;
    if (c.usable) c.one_minus_cosine = sin2 / (1 + std::sqrt(1 - sin2));
    return c;
  }

  /// The pdf [1/sr] of a point at the world-space distance `distance` [m].
  float cone_pdf(const Cone& cone, const Transform& t, float distance, const Vector3& direction, const SurfacePoint& p) const {
    if (!(dot(p.normal, direction) < 0)) return 0;  // the far side
    const Vector3 s = t.back(p.position) - Point3{};
    const double x = double(s.x) / double(radii.x) - cone.x, y = double(s.y) / double(radii.y) - cone.y,
                 z = double(s.z) / double(radii.z) - cone.z;
    const double stretch = double(distance) / std::sqrt(x * x + y * y + z * z);
    const double volume = double(std::abs(t.determinant())) * double(radii.x) * double(radii.y) * double(radii.z);
    return float(stretch * stretch * stretch / (volume * 2 * M_PI * cone.one_minus_cosine));
  }

  /// The pdf of local_sample at a point with the object-space unit normal n. The corresponding area on the unit sphere is
  /// |radii
  /// * n| / (abc) times as large, and its normal is along radii * n.
  float pdf_at(const Normal3& n) const {
    const double x = double(n.x) * double(radii.x), y = double(n.y) * double(radii.y), z = double(n.z) * double(radii.z);
    const double volume = double(radii.x) * double(radii.y) * double(radii.z);
    const double cosines = share_[0] * std::abs(x) + share_[1] * std::abs(y) + share_[2] * std::abs(z);
    return float((flat_ ? cosines / 2 : std::sqrt(x * x + y * y + z * z) / 4) / (M_PI * volume));
  }

  double area_under(const Transform& t) const { return ellipsoid_area(t, radii); }

  void point_at(double x, double y, double z, LocalPoint& p) const {
    const double l = 1 / std::sqrt(x * x + y * y + z * z), a = double(radii.x), b = double(radii.y), c = double(radii.z);
    x *= l;
    y *= l;
    z *= l;
    const double nx = x / a, ny = y / b, nz = z / c, support = 1 / std::sqrt(nx * nx + ny * ny + nz * nz);
    p.position = {float(x * a), float(y * b), float(z * c)};
    p.normal = {float(nx * support), float(ny * support), float(nz * support)};
    const double around = std::sqrt(x * x + y * y);
    p.uv = {positive_atan2(float(y), float(x)) / (2 * pi), positive_atan2(float(around), float(-z)) * inverse_pi};
    if (around > 1e-6) {
      p.dpdu = {float(-2 * M_PI * y * a), float(2 * M_PI * x * b), 0};
      const double s = M_PI * z / around;
      p.dpdv = {float(-s * x * a), float(-s * y * b), float(M_PI * around * c)};
    } else {  // at a pole the direction of u is undefined: an arbitrary one is used
      p.dpdu = {float(2 * M_PI * a), 0, 0};
      p.dpdv = {0, float(z > 0 ? M_PI * b : -M_PI * b), 0};
    }
    p.primitive = 0;
    // Rounding of the position and of an offset ray origin; intersection is in double. `support` is the distance of the tangent
    // plane from the centre, a measure of the thickness here.
    const Vector3 here{std::abs(p.position.x), std::abs(p.position.y), std::abs(p.position.z)};
    p.error = rounding_bound(3) * (along(p.normal, here) + float(support));
  }

  double area_ = 4 * M_PI;                      // in object space [m^2]
  float placed_area_ = 4 * pi;                  // in world space without animation [m^2]
  double share_[3]{1.0 / 3, 1.0 / 3, 1.0 / 3};  // weights of the three cosines
  bool flat_ = false;                           // flat or long: the longest half axis is more than twice the shortest
};

const Register<Ellipsoid> registered;

}  // namespace
}  // namespace etendue
