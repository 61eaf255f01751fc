// Rectangle: a flat parallelogram, typically a luminaire or a wall.

#include "etendue/core/warp.h"
#include "etendue/mesh_facts.h"
#include "geometry/geometry.h"
#include "geometry/solid_angle.h"

namespace etendue {

class Rectangle final : public SceneObject, private MeshFacts {
  DoublePoint3 corner{-0.5, -0.5, 0};
  Vector3 edge_u{1, 0, 0}, edge_v{0, 1, 0};

 public:
  static void describe(Description<Rectangle>& d) {
    d.summary(
         "A parallelogram given by a corner and two edges; by default a unit square about the origin, facing +z. u goes along "
         "edge_u and v along edge_v, from 0 at the corner to 1.",
         "solid-angle sampling: Urena, Fajardo & King 2013")
        .group("Shape")
        .member<&Rectangle::corner>("corner", "m", "one of its corners", Effect::rebuild)
        .member<&Rectangle::edge_u>("edge_u", "m", "from the corner along u", Effect::rebuild)
        .member<&Rectangle::edge_v>("edge_v", "m", "from the corner along v; the front is on the side of edge_u x edge_v",
                                    Effect::rebuild);
  }

  void prepare() override {
    if (!is_finite(corner) || !is_finite(edge_u) || !is_finite(edge_v)) fail("corner", "the rectangle is not finite");
    const float u2 = length_squared(edge_u), v2 = length_squared(edge_v);
    if (!(length_squared(cross(edge_u, edge_v)) > 1e-12f * u2 * v2)) fail("edge_u", "the edges are parallel or have no length");
    transform.set_inner_origin(corner);
    still_ = at(transform.still());
    triangles_ = {{{0, 1, 2}, {0, 2, 3}}};
    Bounds3 box;
    for (int i = 0; i < 4; ++i) {
      // In double, so that corners which several objects place at the same position round to the same floats.
      const DoubleVector3 u = i == 1 || i == 2 ? edge_u : Vector3{}, v = i >= 2 ? edge_v : Vector3{};
      const DoublePoint3 at = DoublePoint3{} + (u + v);
      corners_[i] = Point3(transform.still()(at));
      box.add(transform.animated() ? Point3(at) : corners_[i]);
    }
    bounds_ = transform.animated() ? swept(transform, box) : box;
  }

  Bounds3 bounds() const override { return bounds_; }

  bool intersect(const Ray& ray, Hit& hit) const override {
    std::optional<World> scratch;
    const World& w = world(ray.time, scratch);
    const Vector3 c = w.corner - ray.origin, r = cross(c, ray.direction), n = w.scaled_normal;
    const float inverse = 1 / dot(n, ray.direction);
    const float t = dot(n, c) * inverse, s = dot(r, w.edge_v) * inverse, q = -dot(r, w.edge_u) * inverse;
    if (!(s >= 0 && s <= 1 && q >= 0 && q <= 1 && t > 0 && t < ray.maximum)) return false;
    hit.distance = t;
    hit.object = this;
    hit.depth = 0;
    set_part({s, q}, hit);
    return true;
  }

  LuminaireBounds luminaire_bounds() const override {
    if (transform.animated()) return {bounds_, {}};
    std::optional<World> scratch;
    return {bounds_, {Vector3(world(0, scratch).normal), 1}};
  }

  void surface_point(const Ray& ray, const Hit& hit, SurfacePoint& p) const override {
    std::optional<World> scratch;
    const World& w = world(ray.time, scratch);
    // Barycentric coordinates of the triangle (0, u, u+v) or (0, u+v, v).
    const Point2 uv = hit.primitive == 0 ? Point2{hit.u + hit.v, hit.v} : Point2{hit.u, hit.u + hit.v};
    fill(w, uv, ray.time, p);
    p.primitive = hit.primitive;
    p.u = hit.u;
    p.v = hit.v;
  }

  void tangents(SurfacePoint& p) const override {
    if (p.dpdu != Vector3{}) return;  // already set by a nested scene
    std::optional<World> scratch;
    const World& w = world(p.time, scratch);
    p.dpdu = w.edge_u;
    p.dpdv = w.edge_v;
  }

  float area(float time) const override {
    std::optional<World> scratch;
    return world(time, scratch).area;
  }
  float area_pdf(const SurfacePoint& p) const override { return 1 / area(p.time); }

  SurfaceSample sample_area(Point2 u, float time) const override {
    std::optional<World> scratch;
    const World& w = world(time, scratch);
    SurfaceSample s;
    fill_part(w, u, time, s.point);
    s.pdf = 1 / w.area;
    return s;
  }

  SurfaceSample sample_visible(const Point3& from, Point2 u, float time) const override {
    std::optional<World> scratch;
    const World& w = world(time, scratch);
    SurfaceSample s;
    Vector3 seen_corner;
    if (w.near(from, seen_corner)) {
      if (w.perpendicular) {
        const SphericalRectangle r = w.seen(seen_corner);
        if (r.usable()) {
          const Point2 at = r.sample(u);
          fill_part(w, {clamp((at.x - seen_corner.x) / w.length_u, 0, 1), clamp((at.y - seen_corner.y) / w.length_v, 0, 1)},
                    time, s.point);
          complete_by_angle(s, from, 1 / r.solid_angle());
          return s;
        }
      } else {
        sample_half(w, from, u, time, s);
        return s;  // the same variable is returned everywhere, for copy elision
      }
    }
    fill_part(w, u, time, s.point);
    complete_by_area(s, from, 1 / w.area);
    return s;
  }

  float visible_pdf(const Point3& from, const Vector3& direction, const SurfacePoint& p) const override {
    std::optional<World> scratch;
    const World& w = world(p.time, scratch);
    Vector3 seen_corner;
    if (w.near(from, seen_corner)) {
      if (w.perpendicular) {
        const SphericalRectangle r = w.seen(seen_corner);
        if (r.usable()) return 1 / r.solid_angle();
      } else {
        const SphericalTriangle t = w.half(p.primitive, from);
        if (t.usable()) return 0.5f / t.solid_angle();
      }
    }
    const float cosine = std::abs(dot(p.normal, direction));
    return cosine > 0 ? distance_squared(p.position, from) / (cosine * w.area) : 0;
  }

  const MeshFacts* mesh_facts() const override { return this; }

 private:
  std::optional<TriangleView> triangles() const override {
    if (transform.animated()) return std::nullopt;
    return TriangleView{{corners_, 4}, triangles_};
  }

  /// The rectangle in the coordinates of the containing scene.
  struct World {
    Point3 corner;
    Vector3 edge_u, edge_v, scaled_normal, unit_u, unit_v;
    Normal3 normal;
    Vector3 half_diagonal;
    float length_u = 1, length_v = 1, area = 1, error = 0;
    float far_squared = 0;             // squared distance from the centre beyond which sampling by solid angle does not pay
    float margin_u = 0, margin_v = 0;  // least distance of points from 0 and 1: see `border`
    bool perpendicular = true;

    /// Whether sampling by solid angle pays. `origin` is set to the corner relative to the point, in coordinates along the
    /// edges and the normal (for perpendicular edges).
    [[gnu::always_inline]] inline bool near(const Point3& from, Vector3& origin) const {
      const Vector3 c = corner - from;
      // Most points are far away; a cheap test of the distance from the centre rejects them first.
      if (length_squared(c + half_diagonal) > far_squared) return false;
      origin = {dot(c, unit_u), dot(c, unit_v), dot(c, normal)};
      const float x = clamp(0, origin.x, origin.x + length_u), y = clamp(0, origin.y, origin.y + length_v);
      return area > worthwhile_solid_angle * (x * x + y * y + origin.z * origin.z);
    }
    SphericalRectangle seen(const Vector3& origin) const {
      return {origin.x, origin.x + length_u, origin.y, origin.y + length_v, origin.z};
    }
    SphericalTriangle half(std::uint32_t which, const Point3& from) const {
      const Point3 opposite = corner + (edge_u + edge_v);
      return which == 0 ? SphericalTriangle(from, corner, corner + edge_u, opposite)
                        : SphericalTriangle(from, corner, opposite, corner + edge_v);
    }
  };

  World at(const Transform& t) const {
    World w;
    w.corner = t(Point3{});
    w.edge_u = t(edge_u);
    w.edge_v = t(edge_v);
    w.length_u = length(w.edge_u);
    w.length_v = length(w.edge_v);
    w.unit_u = w.edge_u / w.length_u;
    w.unit_v = w.edge_v / w.length_v;
    w.scaled_normal = cross(w.edge_u, w.edge_v);
    w.area = length(w.scaled_normal);
    const float side = t.flips() ? -1.0f : 1.0f;  // a mirroring transform reverses edge_u x edge_v, but not the front side
    w.normal = Normal3((side / w.area) * w.scaled_normal);
    w.half_diagonal = 0.5f * (w.edge_u + w.edge_v);
    const float reach = std::max(length(w.half_diagonal), length(w.edge_u - w.half_diagonal));
    w.far_squared = square(std::sqrt(w.area / worthwhile_solid_angle) + 1.001f * reach);
    w.perpendicular = std::abs(dot(w.unit_u, w.unit_v)) < 1e-5f;
    // The error bound of triangles (triangle_object.cpp), at the corner where it is largest; rounding of the edges and of the
    // corner tilts and shifts the plane.
    const Vector3 a = abs(w.edge_u), b = abs(w.edge_v), extent = a + b;
    const Vector3 x{a.y * b.z + a.z * b.y, a.z * b.x + a.x * b.z, a.x * b.y + a.y * b.x};
    const Vector3 furthest = Vector3{std::abs(w.corner.x), std::abs(w.corner.y), std::abs(w.corner.z)} + extent;
    w.margin_u = std::min(border * max_component(furthest) * w.length_v / w.area, 0.125f);
    w.margin_v = std::min(border * max_component(furthest) * w.length_u / w.area, 0.125f);
    w.error = along(w.normal, rounding_bound(5) * furthest + rounding_bound(8) * extent) +
              rounding_bound(3) * dot(x, extent) / w.area;
    return w;
  }

  const World& world(float time, std::optional<World>& scratch) const {
    if (!transform.animated()) [[likely]]
      return still_;
    return scratch.emplace(at(transform.at(time)));
  }

  template <class Part>  // a Hit or a SurfacePoint
  static void set_part(Point2 uv, Part& to) {
    // Without a branch, which would be mispredicted half of the time.
    const float lower = std::min(uv.x, uv.y), rest = std::abs(uv.x - uv.y);
    const bool second = uv.x < uv.y;
    to.primitive = second;
    to.u = second ? lower : rest;
    to.v = second ? rest : lower;
  }

  [[gnu::always_inline]] inline void fill(const World& w, Point2 uv, float time, SurfacePoint& p) const {
    p.position = w.corner + (clamp(uv.x, w.margin_u, 1 - w.margin_u) * w.edge_u +  //
                             clamp(uv.y, w.margin_v, 1 - w.margin_v) * w.edge_v);
    p.error = w.error;
    p.normal = w.normal;
    p.shading_normal = w.normal;
    p.uv = uv;
    p.dpdu = {};
    p.dpdv = {};
    p.time = time;
    p.object = this;
    if (!transform.animated()) [[likely]]
      fill_object_coordinates(transform, transform.still(), p);
    else
      fill_object_coordinates(transform, transform.at(time), p);
  }
  [[gnu::always_inline]] inline void fill_part(const World& w, Point2 uv, float time, SurfacePoint& p) const {
    fill(w, uv, time, p);
    set_part(uv, p);
  }

  /// Samples a parallelogram without right angles: one of its two triangles at random, then a point in it by solid angle.
  void sample_half(const World& w, const Point3& from, Point2 u, float time, SurfaceSample& s) const {
    const std::uint32_t which = u.x < 0.5f ? 0 : 1;
    u.x = std::min(2 * u.x - float(which), one_minus_epsilon);
    const SphericalTriangle t = w.half(which, from);
    if (!t.usable()) {
      const Point2 b = warp::triangle(u);
      fill(w, which == 0 ? Point2{b.x + b.y, b.y} : Point2{b.x, b.x + b.y}, time, s.point);
      s.point.primitive = which;
      s.point.u = b.x;
      s.point.v = b.y;
      complete_by_area(s, from, 1 / w.area);
      return;
    }
    const Vector3 direction = t.sample(u), c = w.corner - from, r = cross(c, direction);
    const float inverse = 1 / dot(w.scaled_normal, direction);
    Point2 uv{clamp(dot(r, w.edge_v) * inverse, 0, 1), clamp(-dot(r, w.edge_u) * inverse, 0, 1)};
    if (which == 0)  // rounding may put the point just outside the triangle
      uv.y = std::min(uv.x, uv.y);
    else
      uv.x = std::min(uv.x, uv.y);
    fill(w, uv, time, s.point);
    s.point.primitive = which;
    s.point.u = which == 0 ? uv.x - uv.y : uv.x;
    s.point.v = which == 0 ? uv.y : uv.y - uv.x;
    complete_by_angle(s, from, 0.5f / t.solid_angle());
  }

  World still_;
  Bounds3 bounds_;
  Point3 corners_[5];  // the fifth is padding, which Embree requires
  std::array<std::array<std::uint32_t, 3>, 2> triangles_{};
};

static const Register<Rectangle> registered;

}  // namespace etendue
