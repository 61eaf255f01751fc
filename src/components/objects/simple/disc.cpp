// Disc: a flat circular disc.

#include "etendue/core/warp.h"
#include "geometry/geometry.h"

namespace etendue {

class Disc final : public SceneObject {
  float radius = 1;
  enum class Coordinates : std::uint8_t { square, polar, around } coordinates = Coordinates::square;

 public:
  static void describe(Description<Disc>& d) {
    d.summary(
         "A disc about the origin in the xy plane, facing +z. u goes along x and v along y, from 0 to 1 over the square around "
         "it; or, by `coordinates`, outwards and around, or around and inwards.")
        .group("Shape")
        .member<&Disc::radius>("radius", "m", "its radius", more_than(0), Effect::rebuild, soft(0.01, 100), logarithmic)
        .member<&Disc::coordinates>(
            "coordinates", "",
            "surface coordinates; square: those of the square around it; polar: u from 0 in the middle "
            "to 1 at the rim, v from 0 to 1 around from x towards y; around: u from 0 to 1 around from x "
            "towards y, v from 0 at the rim to 1 in the middle",
            choices("square", "polar", "around"));
  }

  void prepare() override {
    if (!(radius > 0 && radius < infinity)) fail("radius", "the radius must be positive and finite");
    still_ = at(transform.still());
    if (transform.animated()) {
      Bounds3 box;
      box.add(Point3{-radius, -radius, 0});
      box.add(Point3{radius, radius, 0});
      bounds_ = swept(transform, box);
    } else {
      // Points c + a cos(phi) + b sin(phi) extend to sqrt(a_k^2 + b_k^2) from c along axis k.
      const auto reach = [&](int k) { return (1 + 4e-7f) * std::hypot(still_.axis_u[k], still_.axis_v[k]); };
      const Vector3 r{reach(0), reach(1), reach(2)};
      bounds_ = {};
      bounds_.add(still_.centre - r);
      bounds_.add(still_.centre + r);
    }
  }

  Bounds3 bounds() const override { return bounds_; }

  bool intersect(const Ray& ray, Hit& hit) const override {
    World scratch;
    const World& w = world(ray.time, scratch);
    // O + t D = c + u a + v b, solved as for a triangle (triangle_test.h).
    const Vector3 c = w.centre - ray.origin, r = cross(c, ray.direction);
    const float inverse = 1 / dot(w.scaled_normal, ray.direction);
    const float t = dot(w.scaled_normal, c) * inverse, u = dot(r, w.axis_v) * inverse, v = -dot(r, w.axis_u) * inverse;
    if (!(t > 0 && t < ray.maximum && u * u + v * v <= 1)) return false;
    hit.distance = t;
    hit.object = this;
    hit.primitive = 0;
    hit.u = u;
    hit.v = v;
    hit.depth = 0;
    return true;
  }

  void surface_point(const Ray& ray, const Hit& hit, SurfacePoint& p) const override {
    World scratch;
    fill(world(ray.time, scratch), {hit.u, hit.v}, ray.time, p);
  }

  void tangents(SurfacePoint& p) const override {
    if (p.dpdu != Vector3{}) return;  // already set by a nested scene
    World scratch;
    const World& w = world(p.time, scratch);
    if (coordinates == Coordinates::square) {
      p.dpdu = 2 * w.axis_u;
      p.dpdv = 2 * w.axis_v;
      return;
    }
    // (x, y) = u (cos 2 pi v, sin 2 pi v), or with the roles of u and v exchanged (v as 1 - v); at the centre, where the
    // azimuth is undefined, that of the x axis is used.
    const float r = std::hypot(p.u, p.v), c = r > 0 ? p.u / r : 1, s = r > 0 ? p.v / r : 0;
    const Vector3 outwards = c * w.axis_u + s * w.axis_v;
    const Vector3 about = (2 * pi * std::max(r, 1e-6f)) * (c * w.axis_v - s * w.axis_u);
    p.dpdu = coordinates == Coordinates::polar ? outwards : about;
    p.dpdv = coordinates == Coordinates::polar ? about : -outwards;
  }

  LuminaireBounds luminaire_bounds() const override {
    World scratch;
    return {bounds(), transform.animated() ? NormalCone{} : NormalCone{Vector3(world(0, scratch).normal), 1}};
  }

  float area(float time) const override {
    World scratch;
    return world(time, scratch).area;
  }

  SurfaceSample sample_area(Point2 u, float time) const override {
    World scratch;
    const World& w = world(time, scratch);
    SurfaceSample s;
    fill(w, warp::disc(u), time, s.point);  // a linear map preserves uniform distributions
    s.pdf = 1 / w.area;
    return s;
  }

 private:
  /// The disc (an ellipse, if the transform stretches it) in the coordinates of the containing scene: centre + u axis_u + v
  /// axis_v with u^2 + v^2 <= 1.
  struct World {
    Point3 centre;
    Vector3 axis_u, axis_v, scaled_normal;
    Normal3 normal;
    float area = pi, error = 0;
  };

  World at(const Transform& t) const {
    World w;
    w.centre = t(Point3{0, 0, 0});
    w.axis_u = t(Vector3{radius, 0, 0});
    w.axis_v = t(Vector3{0, radius, 0});
    w.scaled_normal = cross(w.axis_u, w.axis_v);
    const float l = length(w.scaled_normal);
    w.area = pi * l;
    w.normal = Normal3(((t.flips() ? -1.0f : 1.0f) / l) * w.scaled_normal);
    // The error bound of triangles (triangle_object.cpp), evaluated at the rim.
    const Vector3 a = abs(w.axis_u), b = abs(w.axis_v), extent = a + b;
    const Vector3 x{a.y * b.z + a.z * b.y, a.z * b.x + a.x * b.z, a.x * b.y + a.y * b.x};
    const Vector3 furthest = Vector3{std::abs(w.centre.x), std::abs(w.centre.y), std::abs(w.centre.z)} + extent;
    w.error =
        along(w.normal, rounding_bound(4) * furthest + rounding_bound(8) * extent) + rounding_bound(3) * dot(x, extent) / l;
    return w;
  }

  const World& world(float time, World& scratch) const {
    if (!transform.animated()) [[likely]]
      return still_;
    scratch = at(transform.at(time));
    return scratch;
  }

  void fill(const World& w, Point2 on_disc, float time, SurfacePoint& p) const {
    p.position = w.centre + (on_disc.x * w.axis_u + on_disc.y * w.axis_v);
    p.error = w.error;
    p.normal = w.normal;
    p.shading_normal = w.normal;
    if (coordinates == Coordinates::square) {
      p.uv = {(on_disc.x + 1) / 2, (on_disc.y + 1) / 2};
    } else {
      const float turn = std::atan2(on_disc.y, on_disc.x) / (2 * pi);
      const float r = std::hypot(on_disc.x, on_disc.y), whole = turn < 0 ? std::min(turn + 1, one_minus_epsilon) : turn;
      p.uv = coordinates == Coordinates::polar ? Point2{r, whole} : Point2{whole, std::max(1 - r, 0.0f)};
    }
    p.dpdu = {};
    p.dpdv = {};
    p.time = time;
    p.object = this;
    p.primitive = 0;
    p.u = on_disc.x;
    p.v = on_disc.y;
    Transform scratch;
    fill_object_coordinates(transform, placed(transform, time, scratch), p);
  }

  World still_;
  Bounds3 bounds_;
};

static const Register<Disc> registered;

}  // namespace etendue
