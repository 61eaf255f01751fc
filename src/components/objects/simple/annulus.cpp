// Annulus: a flat ring.

#include "geometry/double_ray.h"
#include "geometry/quadric_roots.h"

namespace etendue {
namespace {

class Annulus final : public PlacedObject {
 public:
  static void describe(Description<Annulus>& d) {
    d.summary(
         "A flat ring about the origin in the xy plane, facing +z; surface coordinates are as on a Disc of its outer radius, "
         "or "
         "by `coordinates` those of the ring.")
        .group("Shape")
        .member<&Annulus::inner_radius>("inner_radius", "m", "of its hole; 0: none", at_least(0), Effect::rebuild, soft(0, 100))
        .member<&Annulus::radius>("radius", "m", "its outer radius", more_than(0), Effect::rebuild, soft(0.01, 100),
                                  logarithmic)
        .member<&Annulus::sweep>("sweep", "deg", "how much of a turn there is, from x towards y", Range{0, 360, true},
                                 Effect::rebuild)
        .member<&Annulus::coordinates>("coordinates", "",
                                       "surface coordinates; square: those of the square around it; around: u from 0 to 1 over "
                                       "the sweep, v from 0 at the outer radius to 1 at the inner",
                                       choices("square", "around"));
  }

  void prepare() override {
    if (!(radius > 0 && radius < infinity)) fail("radius", "must be positive and finite");
    if (!(inner_radius >= 0 && inner_radius < radius)) fail("inner_radius", "must be smaller than radius, and not negative");
    if (!(sweep > 0 && sweep <= 360)) fail("sweep", "must be above 0 and at most 360 deg");
    sector_ = Sector(double(sweep) * (M_PI / 180));
    low_ = double(inner_radius) * double(inner_radius);
    high_ = double(radius) * double(radius);
    if (!(float(local_area()) > 0 && float(local_area()) < infinity)) fail("radius", "the ring's area is no float");
    place();
  }

  LuminaireBounds luminaire_bounds() const override {
    if (transform.animated()) return {bounds(), {}};
    return {bounds(), {Vector3(normalize(transform.still()(Normal3(0, 0, 1)))), 1}};
  }

  float inner_radius = 0.5f, radius = 1, sweep = 360;
  enum class Coordinates : std::uint8_t { square, around } coordinates = Coordinates::square;

 protected:
  Bounds3 local_bounds() const override {
    Bounds3 box;
    box.add(Point3{-radius, -radius, 0});
    box.add(Point3{radius, radius, 0});
    return box;
  }

  bool local_intersect(const Ray& ray, Hit& hit) const override {
    const DoubleRay r(ray);
    const double t = -r.origin[2] / r.direction[2], x = r.at(t, 0), y = r.at(t, 1), d2 = x * x + y * y;
    return d2 >= low_ && d2 <= high_ && sector_.holds(x, y) && take_hit(ray, t, 0, hit);
  }

  void local_point(const Ray& ray, const Hit& hit, LocalPoint& p) const override {
    const DoubleRay r(ray);
    const double t = exact_distance(hit);
    point_at(r.at(t, 0), r.at(t, 1), p);
  }

  double local_area() const override { return sector_.share() * M_PI * (high_ - low_); }

  float local_sample(Point2 u, LocalPoint& p) const override {
    const double r = std::sqrt(low_ + double(u.y) * (high_ - low_)), phi = sector_.angle() * double(u.x);
    point_at(r * std::cos(phi), r * std::sin(phi), p);
    return float(1 / local_area());
  }

 private:
  void point_at(double x, double y, LocalPoint& p) const {
    flat_point(x, y, 0, double(radius), true, double(radius), p);
    if (coordinates == Coordinates::square) return;
    // (x, y) = (R - v (R - r)) (cos(u sweep), sin(u sweep)).
    const double wide = double(radius) - double(inner_radius), length = std::hypot(x, y);
    const double c = length > 0 ? x / length : 1, s = length > 0 ? y / length : 0;
    const double about = sector_.angle() * std::max(length, 1e-6 * double(radius));
    p.uv = {sector_.part(x, y), clamp(float((double(radius) - length) / wide), 0, 1)};
    p.dpdu = {float(-about * s), float(about * c), 0};
    p.dpdv = {float(-wide * c), float(-wide * s), 0};
  }

  Sector sector_;
  double low_ = 0, high_ = 1;  // squared inner and outer radius [m^2]
};

const Register<Annulus> registered;

}  // namespace
}  // namespace etendue
