// A shape, out of tree: a capsule, the points at the distance r from a segment of the z axis that is h long.
#include "etendue/scene_object.h"
#include "etendue/shader.h"  // a SceneObject owns its shader

using namespace etendue;

// If c is the segment's nearest point to p, the unit normal at p is n = (p - c) / r. Two planes across the axis at the distance
// dz cut the area 2 pi r dz out of a sphere, as out of a cylinder (Archimedes, On the Sphere and Cylinder I). So the area of a
// capsule is 2 pi r (h + 2 r), and points with uniform height and azimuth are uniform by area.
class Capsule final : public SceneObject {
  double radius = 0.5, height = 1;
  Bounds3 bounds_;

 public:
  static void describe(Description<Capsule>& d) {
    d.summary("A cylinder about the z axis that ends in half balls; u goes around from +x towards +y, v from -z to +z.")
        .member<&Capsule::radius>("radius", "m", "of the cylinder and of its ends", more_than(0), Effect::rebuild)
        .member<&Capsule::height>("height", "m", "of the cylinder, without its ends", at_least(0), Effect::rebuild);
  }
  void prepare() override {
    if (!(radius > 0 && radius < 1e9)) fail("radius", "must be positive and below 1e9 m");
    if (!(height >= 0 && height < 1e9)) fail("height", "must not be negative and below 1e9 m");
    for (const auto& [time, t] : transform.keys())
      for (const Vector3& v : {Vector3{1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}})
        if (!(std::abs(length(t(v)) / length(t(Vector3{0, 0, 1})) - length(v)) < 1e-5f))
          fail("transform", "must not stretch it: stretch an Instance of a scene that contains it");
    const Vector3 corner{float(radius), float(radius), float(height / 2 + radius)};
    const auto &first = transform.keys().front(), &last = transform.keys().back();
    bounds_ = transform.sweep({Point3{} - corner, Point3{} + corner}, first.time, last.time);
    const Vector3 rounding = rounding_bound(8) * (bounds_.diagonal() + abs(bounds_.centre() - Point3{}));
    bounds_ = {bounds_.low - rounding, bounds_.high + rounding};
  }
  Bounds3 bounds() const override { return bounds_; }
  bool closed() const override { return true; }

  // A line enters and leaves at the roots of the cylinder, or, where a root lies beyond an end, at those of the ball there.
  bool intersect(const Ray& ray, Hit& hit) const override {
    const auto [o, d] = into(ray);
    const double a = d.x * d.x + d.y * d.y, m = o.x * d.y - o.y * d.x, root = std::sqrt(a * radius * radius - m * m);
    if (a > 0 ? !(root >= 0) : std::hypot(o.x, o.y) > radius) return false;
    for (const double side : {-1.0, 1.0}) {
      double t = a > 0 ? (side * root - o.x * d.x - o.y * d.y) / a : side * HUGE_VAL;
      if (const double z = o.z + t * d.z; std::abs(z) > height / 2) {
        const DoubleVector3 q = o - on_axis(z), c = cross(q, d);
        t = (side * std::sqrt(dot(d, d) * radius * radius - dot(c, c)) - dot(q, d)) / dot(d, d);  // NaN: the line misses it
      }
      if (!(float(t) > 0 && float(t) < ray.maximum)) continue;
      hit = {};
      hit.distance = float(t);
      hit.object = this;
      return true;
    }
    return false;
  }
  void surface_point(const Ray& ray, const Hit& hit, SurfacePoint& p) const override {
    const auto [o, d] = into(ray);
    const DoublePoint3 q = o + double(hit.distance) * d;
    p = point((1 / length(q - on_axis(q.z))) * (q - on_axis(q.z)), q.z, ray.time);
  }
  void tangents(SurfacePoint& p) const override {
    const Normal3& n = p.object_normal;
    const float s = std::hypot(n.x, n.y), x = s > 0 ? n.x / s : 1, y = s > 0 ? n.y / s : 0;
    p.dpdu = now(p.time)(float(2 * M_PI * radius) * s * Vector3{-y, x, 0});
    p.dpdv = now(p.time)(float(M_PI * radius + height) * Vector3{-n.z * x, -n.z * y, s});
  }
  float area(float time) const override {
    return float(2 * M_PI * radius * (height + 2 * radius)) * length_squared(now(time)(Vector3{0, 0, 1}));
  }
  SurfaceSample sample_area(Point2 u, float time) const override {
    const double z = (2 * double(u.x) - 1) * (height / 2 + radius), phi = 2 * M_PI * double(u.y);
    const double n_z = (z - on_axis(z).z) / radius, s = std::sqrt(1 - n_z * n_z);
    SurfaceSample sample;
    sample.point = point({s * std::cos(phi), s * std::sin(phi), n_z}, z, time);
    sample.pdf = 1 / area(time);
    return sample;
  }

 private:
  DoublePoint3 on_axis(double z) const { return {0, 0, std::clamp(z, -height / 2, height / 2)}; }
  Transform now(float time) const { return transform.animated() ? transform.at(time) : transform.still(); }
  /// The ray in object space. The direction is not normalized, so t stays the same.
  std::pair<DoublePoint3, DoubleVector3> into(const Ray& ray) const {
    const Transform t = now(ray.time);
    const DoublePoint3 origin(ray.origin), o = t.back(origin);
    return {o, t.back(origin + DoubleVector3(ray.direction)) - o};
  }
  SurfacePoint point(const DoubleVector3& n, double z, float time) const {
    const DoublePoint3 q = on_axis(z) + radius * n;
    const Transform t = now(time);
    const double turn = std::atan2(n.y, n.x) / (2 * M_PI), arc = radius * std::atan2(std::hypot(n.x, n.y), -n.z);
    SurfacePoint p;
    p.position = Point3(t(q));
    p.object_position = Point3(q);
    p.object_normal = Normal3(Vector3(n));
    p.normal = p.shading_normal = normalize(t(p.object_normal));
    // Coordinates are rounded once, and again when the origin of a ray is moved off the surface.
    p.error = rounding_bound(3) * (length(p.position - Point3{}) + length(bounds_.diagonal()));
    p.uv = {float(turn - std::floor(turn)), float((arc + on_axis(z).z + height / 2) / (M_PI * radius + height))};
    p.time = time;
    p.object = this;
    return p;
  }
};

static const Register<Capsule> registered;
