// A shape, out of tree: a capsule, the points at the distance r from a segment of the z axis that is h long.
#include "etendue/placed_object.h"

using namespace etendue;

// If c is the segment's nearest point to p, the unit normal at p is n = (p - c) / r. Two planes across the axis at the distance
// dz cut the area 2 pi r dz out of a sphere, as out of a cylinder (Archimedes, On the Sphere and Cylinder I). So the area of a
// capsule is 2 pi r (h + 2 r), and points with uniform height and azimuth are uniform by area.
class Capsule final : public PlacedObject {
  double radius = 0.5, height = 1;

 public:
  static void describe(Description<Capsule>& d) {
    d.summary("A cylinder about the z axis that ends in half balls; u goes around from +x towards +y, v from -z to +z.")
        .member<&Capsule::radius>("radius", "m", "of the cylinder and of its ends", more_than(0), Effect::rebuild)
        .member<&Capsule::height>("height", "m", "of the cylinder, without its ends", at_least(0), Effect::rebuild);
  }
  void prepare() override {
    if (!(radius > 0 && radius < 1e9)) fail("radius", "must be positive and below 1e9 m");
    if (!(height >= 0 && height < 1e9)) fail("height", "must not be negative and below 1e9 m");
    place();
  }
  bool closed() const override { return true; }

 protected:
  Bounds3 local_bounds() const override {
    const Vector3 corner{float(radius), float(radius), float(height / 2 + radius)};
    return {Point3{} - corner, Point3{} + corner};
  }

  // A line enters and leaves at the roots of the cylinder, or, where a root lies beyond an end, at those of the ball there.
  bool local_intersect(const Ray& ray, Hit& hit) const override {
    const DoublePoint3 o(ray.origin);
    const DoubleVector3 d(ray.direction);
    const double a = d.x * d.x + d.y * d.y, m = o.x * d.y - o.y * d.x, root = std::sqrt(a * radius * radius - m * m);
    if (a > 0 ? !(root >= 0) : std::hypot(o.x, o.y) > radius) return false;
    for (const double side : {-1.0, 1.0}) {
      double t = a > 0 ? (side * root - o.x * d.x - o.y * d.y) / a : side * HUGE_VAL;
      if (const double z = o.z + t * d.z; std::abs(z) > height / 2) {
        const DoubleVector3 q = o - on_axis(z), c = cross(q, d);
        t = (side * std::sqrt(dot(d, d) * radius * radius - dot(c, c)) - dot(q, d)) / dot(d, d);  // NaN: the line misses it
      }
      if (!(float(t) > 0 && float(t) < ray.maximum)) continue;
      hit.distance = float(t);
      hit.primitive = 0;
      hit.u = hit.v = 0;
      return true;
    }
    return false;
  }
  void local_point(const Ray& ray, const Hit& hit, LocalPoint& p) const override {
    const DoublePoint3 q = DoublePoint3(ray.origin) + double(hit.distance) * DoubleVector3(ray.direction);
    const DoubleVector3 away = q - on_axis(q.z);
    fill((1 / length(away)) * away, q.z, p);
  }

  double local_area() const override { return 2 * M_PI * radius * (height + 2 * radius); }
  float local_sample(Point2 u, LocalPoint& p) const override {
    const double z = (2 * double(u.x) - 1) * (height / 2 + radius), phi = 2 * M_PI * double(u.y);
    const double n_z = (z - on_axis(z).z) / radius, s = std::sqrt(1 - n_z * n_z);
    fill({s * std::cos(phi), s * std::sin(phi), n_z}, z, p);
    return float(1 / local_area());
  }
  Seams local_seams() const override {
    const double end = radius / (height + 2 * radius);
    return {{end, 1 - end}, {}};
  }

 private:
  DoublePoint3 on_axis(double z) const { return {0, 0, std::clamp(z, -height / 2, height / 2)}; }
  /// The point with the unit normal n, at the height z or beyond it.
  void fill(const DoubleVector3& n, double z, LocalPoint& p) const {
    const double s = std::hypot(n.x, n.y), x = s > 0 ? n.x / s : 1, y = s > 0 ? n.y / s : 0;
    const double turn = std::atan2(n.y, n.x) / (2 * M_PI), arc = radius * std::atan2(s, -n.z), whole = M_PI * radius + height;
    p.position = Point3(on_axis(z) + radius * n);
    p.normal = Normal3(Vector3(n));
    // Coordinates are rounded once, and again when the origin of a ray is moved off the surface.
    p.error = rounding_bound(3) * (length(p.position - Point3{}) + float(radius));
    p.uv = {float(turn - std::floor(turn)), float((arc + on_axis(z).z + height / 2) / whole)};
    p.dpdu = Vector3(2 * M_PI * radius * DoubleVector3{-n.y, n.x, 0});
    p.dpdv = Vector3(whole * DoubleVector3{-n.z * x, -n.z * y, s});
  }
};

static const Register<Capsule> registered;
