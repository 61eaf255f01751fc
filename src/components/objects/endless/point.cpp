// Point: a delta luminaire at a point (point light, spot light).

#include "geometry/geometry.h"
#include "geometry/without_extent.h"

namespace etendue {
namespace {

// A point is the limit of a sphere with a cross section of 1 m^2, shrunk at constant power (Extent::point). Its area is
// that of the sphere, 4 m^2, since a sphere of cross section pi r^2 has the area 4 pi r^2. Its emission's radiance L [W m^-2
// sr^-1 nm^-1], times 1 m^2, is its intensity I [W sr^-1 nm^-1]. A DiffuseEmission of power P = pi * area * L then has I = P /
// (4 pi).
//
// Seen from distance r, 1 m^2 of cross section fills the solid angle 1 / r^2, so a pdf of 1 / m^2 is a pdf of r^2 / sr: the
// estimate L / r^2 of the irradiance on a plane perpendicular to the light is I / r^2, as it must be.
class Point final : public SceneObject {
 public:
  static void describe(Description<Point>& d) {
    d.summary(
         "A delta light at a point, which rays never hit. Its emission's radiance, times 1 m^2, is its intensity "
         "[W/sr per nm]: a DiffuseEmission sends the same into all directions, a SpotEmission into a cone. Its transform moves "
         "and turns it; a stretch changes only where it is, not how strong it is.")
        .group("Shape")
        .member<&Point::position>("position", "m", "where it is", Effect::rebuild);
  }

  void prepare() override {
    if (!is_finite(position)) fail("position", "a point lies at a finite place");
    transform.set_inner_origin(position);
    refuse_surface(*this, "a point");
  }

  Extent extent() const override { return Extent::point; }

  Bounds3 bounds() const override { return {}; }
  LuminaireBounds luminaire_bounds() const override {
    Bounds3 b;
    b.add(Point3{});
    return {swept(transform, b), {}};
  }
  bool intersect(const Ray&, Hit&) const override { return false; }
  bool occludes(const Ray&) const override { return false; }
  void surface_point(const Ray& ray, const Hit&, SurfacePoint& p) const override { fill(ray.time, p); }
  void tangents(SurfacePoint&) const override {}  // no surface: they stay zero

  /// The area of the sphere whose limit the point is [m^2].
  float area(float) const override { return 4; }
  SurfaceSample sample_area(Point2, float time) const override {
    SurfaceSample s;
    fill(time, s.point);
    s.pdf = 1;
    s.delta = true;
    return s;
  }
  float area_pdf(const SurfacePoint&) const override { return 1; }

  SurfaceSample sample_visible(const Point3& from, Point2, float time) const override {
    SurfaceSample s;
    fill(time, s.point);
    s.delta = true;
    const Vector3 to = s.point.position - from;
    s.pdf = length_squared(to);  // 0 from the point itself: there is no direction
    s.distance = std::sqrt(s.pdf);
    s.direction = s.distance > 0 ? to / s.distance : Vector3{0, 0, 1};
    return s;
  }
  /// 0: the direction is a delta distribution, which no other sampling technique can generate.
  float visible_pdf(const Point3&, const Vector3&, const SurfacePoint&) const override { return 0; }

  DoublePoint3 position{0, 0, 0};

 private:
  void fill(float time, SurfacePoint& p) const {
    Transform scratch;
    const Transform& t = placed(transform, time, scratch);
    p.position = t(Point3{});
    p.error = 0;  // there is no surface from which the position could deviate
    p.normal = p.shading_normal = p.object_normal = Normal3{};
    p.uv = {};
    p.dpdu = p.dpdv = {};
    p.object_position = Point3(position);
    p.time = time;
    p.object = this;
    p.primitive = 0;
    p.u = p.v = 0;
  }
};

const Register<Point> registered;

}  // namespace
}  // namespace etendue
