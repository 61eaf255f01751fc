// Sphere: a sphere, or an ellipsoid if its transform stretches it.

#include "etendue/core/warp.h"
#include "geometry/ellipsoid_area.h"
#include "geometry/geometry.h"

namespace etendue {

class Sphere final : public SceneObject {
  DoublePoint3 centre{0, 0, 0};
  float radius = 1;

 public:
  static void describe(Description<Sphere>& d) {
    d.summary(
         "A sphere; an ellipsoid when its transform stretches. u goes around the z axis from +x towards +y, v from the pole at "
         "-z "
         "to that at +z.",
         "cone sampling: Shirley, Wang & Zimmerman 1996, \"Monte Carlo techniques for direct lighting calculations\"")
        .group("Shape")
        .member<&Sphere::centre>("centre", "m", "its centre", Effect::rebuild)
        .member<&Sphere::radius>("radius", "m", "its radius", more_than(0), Effect::rebuild, soft(0.01, 100), logarithmic);
  }

  void prepare() override {
    if (!is_finite(centre) || !(radius > 0 && radius < infinity))
      fail("radius", "centre and radius must be finite, the radius positive");
    transform.set_inner_origin(centre);
    const float scale = transform.animated() ? 0 : similarity_scale(transform.still());
    round_ = scale > 0;
    ball_ = round_ ? Ball{transform.still()(Point3{}), scale * radius} : Ball{{}, radius};
    const Vector3 r{ball_.radius, ball_.radius, ball_.radius};
    Bounds3 box;
    box.add(ball_.centre - r);
    box.add(ball_.centre + r);
    if (round_) {
      bounds_ = box;
    } else if (transform.animated()) {
      bounds_ = swept(transform, box);
    } else {  // an ellipsoid M x + c with |x| <= r extends to r |row k of M| from c along axis k
      const auto& m = transform.still().matrix();
      const auto reach = [&](size_t k) { return radius * length(Vector3{m[4 * k], m[4 * k + 1], m[4 * k + 2]}); };
      const Point3 c = transform.still()(Point3{});
      bounds_ = {};
      bounds_.add(c - Vector3{reach(0), reach(1), reach(2)});
      bounds_.add(c + Vector3{reach(0), reach(1), reach(2)});
    }
    // Rounding may move points out of the exact box.
    const Vector3 margin = rounding_bound(8) * (bounds_.diagonal() + abs(bounds_.centre() - Point3{}));
    bounds_.low = bounds_.low - margin;
    bounds_.high = bounds_.high + margin;
    still_area_ = area_of(transform.still());
  }

  Bounds3 bounds() const override { return bounds_; }

  bool intersect(const Ray& ray, Hit& hit) const override {
    const float t = round_ ? ball_.nearest(ray) : distance_inside(ray);
    if (!(t < ray.maximum)) return false;
    hit.distance = t;
    hit.object = this;
    hit.primitive = 0;
    hit.u = 0;
    hit.v = 0;
    hit.depth = 0;
    return true;
  }
  bool occludes(const Ray& ray) const override { return (round_ ? ball_.nearest(ray) : distance_inside(ray)) < ray.maximum; }

  void surface_point(const Ray& ray, const Hit& hit, SurfacePoint& p) const override {
    if (round_) {
      // The direction from the centre to the hit, in double: the rounding error of a float position would corrupt the normal of
      // a distant sphere.
      fill(unit_from_centre(ball_, ray, hit.distance), ray.time, p);
    } else {
      Transform scratch;
      fill(unit_from_centre(ball_, ray_into(placed(transform, ray.time, scratch), ray), hit.distance), ray.time, p);
    }
  }

  void tangents(SurfacePoint& p) const override {
    if (p.dpdu != Vector3{}) return;  // already set by a nested scene
    const Vector3 d = radius * Vector3(p.object_normal);
    const float around = std::sqrt(d.x * d.x + d.y * d.y);
    if (around > 1e-6f * radius) {
      p.dpdu = 2 * pi * Vector3{-d.y, d.x, 0};
      p.dpdv = pi * Vector3{-d.z * d.x / around, -d.z * d.y / around, around};
    } else {  // at a pole the direction of u is undefined: an arbitrary one is used
      p.dpdu = {2 * pi * radius, 0, 0};
      p.dpdv = {0, d.z > 0 ? pi * radius : -pi * radius, 0};
    }
    Transform scratch;
    const Transform& t = placed(transform, p.time, scratch);
    p.dpdu = t(p.dpdu);
    p.dpdv = t(p.dpdv);
  }

  bool closed() const override { return true; }

  float area(float time) const override { return transform.animated() ? area_of(transform.at(time)) : still_area_; }

  SurfaceSample sample_area(Point2 u, float time) const override {
    SurfaceSample s;
    fill(warp::sphere(u), time, s.point);
    s.pdf = area_pdf(s.point);
    return s;
  }

  float area_pdf(const SurfacePoint& p) const override {
    if (round_) return 1 / still_area_;
    Transform scratch;
    const Transform& t = placed(transform, p.time, scratch);
    return 1 / (4 * pi * radius * radius * t.area_stretch(p.object_normal));
  }

  SurfaceSample sample_visible(const Point3& from, Point2 u, float time) const override {
    Ball ball;
    float one_minus_cosine = 0;
    if (!as_ball(time, ball) || !ball.cone(from, one_minus_cosine)) return by_area(from, u, time);
    // A direction in the cone at the angle theta to its axis first hits the sphere at a point whose direction from the centre
    // is at the angle alpha to the direction towards `from`. With sin(max) = r/d the law of sines gives the angle at the point,
    // and
    //   cos(alpha) = sin(theta)^2 / sin(max) + cos(theta) sqrt(1 - sin(theta)^2 / sin(max)^2),
    // which has no cancellation, however far the sphere is.
    const Vector3 to = ball.centre - from;
    const float d = length(to), sin_max = ball.radius / d;
    const float h = u.x * one_minus_cosine, sin2 = h * (2 - h), cos_theta = 1 - h;
    const float cos_alpha = std::min(1.0f, sin2 / sin_max + cos_theta * safe_sqrt(1 - sin2 / (sin_max * sin_max)));
    const float sin_alpha = safe_sqrt(1 - cos_alpha * cos_alpha);
    float sine = 0, cosine = 0;
    sin_cos_turn(u.y, sine, cosine);
    const Frame axis(Normal3(to / d));
    const Vector3 out = sin_alpha * (cosine * axis.s + sine * axis.t) - cos_alpha * Vector3(axis.n);
    SurfaceSample s;
    if (round_)
      fill(out, time, s.point);
    else
      fill(normalize(transform.at(time).back(out)), time, s.point);
    complete_by_angle(s, from, warp::cone_pdf(one_minus_cosine));
    return s;
  }

  float visible_pdf(const Point3& from, const Vector3& direction, const SurfacePoint& p) const override {
    Ball ball;
    float one_minus_cosine = 0;
    if (!as_ball(p.time, ball) || !ball.cone(from, one_minus_cosine)) {
      const float cosine = std::abs(dot(p.normal, direction));
      return cosine > 0 ? area_pdf(p) * distance_squared(p.position, from) / cosine : 0;
    }
    return dot(p.normal, direction) < 0 ? warp::cone_pdf(one_minus_cosine) : 0;  // the far side has pdf 0
  }

 private:
  struct Ball {
    Point3 centre;
    float radius = 1;

    /// The smallest t > 0, or infinity. In double: the discriminant of a small or far sphere is a difference of large numbers.
    /// q is computed without cancellation; the roots are q / a and c / q (Hearn & Baker 2004).
    float nearest(const Ray& ray) const {
      const double ox = double(ray.origin.x) - centre.x, oy = double(ray.origin.y) - centre.y,
                   oz = double(ray.origin.z) - centre.z;
      const double dx = ray.direction.x, dy = ray.direction.y, dz = ray.direction.z;
      const double a = dx * dx + dy * dy + dz * dz, b = ox * dx + oy * dy + oz * dz;
      const double c = ox * ox + oy * oy + oz * oz - double(radius) * radius;
      if (c > 0 && b >= 0) return infinity;  // outside and moving away
      const double discriminant = b * b - a * c;
      if (!(discriminant >= 0)) return infinity;
      const double q = b > 0 ? -b - std::sqrt(discriminant) : -b + std::sqrt(discriminant);
      const double t0 = b > 0 ? q / a : c / q, t1 = b > 0 ? c / q : q / a;  // t0 <= t1
      const float near = float(t0), far = float(t1);
      return near > 0 ? near : (far > 0 ? far : infinity);
    }

    /// The cone that the sphere subtends; returns false from inside or too close to the surface.
    bool cone(const Point3& from, float& one_minus_cosine) const {
      const float d2 = distance_squared(from, centre), sin2 = radius * radius / d2;
      if (!(sin2 < 0.9999f)) return false;
      one_minus_cosine = sin2 / (1 + std::sqrt(1 - sin2));
      return true;
    }
  };

  static Vector3 unit_from_centre(const Ball& ball, const Ray& ray, float t) {
    const double x = double(ray.origin.x) + double(t) * ray.direction.x - ball.centre.x;
    const double y = double(ray.origin.y) + double(t) * ray.direction.y - ball.centre.y;
    const double z = double(ray.origin.z) + double(t) * ray.direction.z - ball.centre.z;
    const double s = 1 / std::sqrt(x * x + y * y + z * z);
    return {float(x * s), float(y * s), float(z * s)};
  }

  float distance_inside(const Ray& ray) const {
    Transform scratch;
    return ball_.nearest(ray_into(placed(transform, ray.time, scratch), ray));
  }

  /// Fills a point from its direction from the centre: in world space for a static sphere that is still round after its
  /// transform, else in object space.
  void fill(const Vector3& from_centre, float time, SurfacePoint& p) const {
    p.position = ball_.centre + ball_.radius * from_centre;
    p.normal = Normal3(from_centre);
    p.shading_normal = p.normal;
    p.dpdu = {};
    p.dpdv = {};
    p.time = time;
    p.object = this;
    p.primitive = 0;
    p.u = 0;
    p.v = 0;
    // Rounding of the position, of the normal's length and of the offset; intersection itself is in double.
    const Vector3 here{std::abs(p.position.x), std::abs(p.position.y), std::abs(p.position.z)};
    p.error = rounding_bound(3) * (along(p.normal, here) + ball_.radius);
    if (round_) {
      const Transform& t = transform.still();
      fill_object_coordinates(transform, t, p);
    } else {
      Transform scratch;
      p.object_position = object_position_of(transform, p.position);
      p.object_normal = p.normal;
      carry_out(placed(transform, time, scratch), p);
    }
    // u around the z axis from x, v from the pole at -z to that at +z.
    const Normal3& n = p.object_normal;
    p.uv.x = positive_atan2(n.y, n.x) * (1 / (2 * pi));
    p.uv.y = positive_atan2(std::sqrt(n.x * n.x + n.y * n.y), -n.z) * inverse_pi;
  }

  /// The sphere in world space at a time; returns false if it is an ellipsoid.
  bool as_ball(float time, Ball& ball) const {
    if (round_) {
      ball = ball_;
      return true;
    }
    if (!transform.animated()) return false;
    const Transform t = transform.at(time);
    const float scale = similarity_scale(t);
    ball = {t(Point3{}), scale * radius};
    return scale > 0;
  }

  SurfaceSample by_area(const Point3& from, Point2 u, float time) const {
    SurfaceSample s = sample_area(u, time);
    complete_by_area(s, from, s.pdf);
    return s;
  }

  float area_of(const Transform& t) const {
    const float s = similarity_scale(t);
    if (s > 0) return 4 * pi * square(s * radius);
    return float(ellipsoid_area(t, {radius, radius, radius}));
  }

  Ball ball_;          // in world space if round_, else in object space
  bool round_ = true;  // static, and a sphere in world space as well
  float still_area_ = 4 * pi;
  Bounds3 bounds_;
};

static const Register<Sphere> registered;

}  // namespace etendue
