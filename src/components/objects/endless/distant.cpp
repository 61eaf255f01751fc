// Distant: a delta luminaire at infinity whose light travels in a single direction (directional light).

#include "etendue/infinite_object.h"
#include "geometry/geometry.h"
#include "geometry/without_extent.h"

namespace etendue {
namespace {

// The single direction is the limit of a disc of 1 sr at infinity, shrunk at constant irradiance (Extent::direction): its
// emission's radiance L [W m^-2 sr^-1 nm^-1], times 1 sr, is the irradiance E [W m^-2 nm^-1] on a plane perpendicular to the
// light, and the direction is sampled with pdf 1 / sr. The power through the disc of radius R that shades the whole scene is pi
// R^2 E: with area R^2 it is pi * area * L, as for any diffuse luminaire.
class Distant final : public InfiniteObject {
 public:
  static void describe(Description<Distant>& d) {
    d.summary(
         "A luminaire at infinity whose light all travels one way, like a sun without width. Its emission's radiance, times "
         "1 sr, is the irradiance [W/m^2 per nm] on a plane across the light; a power given to the emission is that of the "
         "light through the disc which shades the whole scene. Its transform turns it.")
        .group("Shape")
        .member<&Distant::direction>("direction", "1", "the way its light travels, of any length", Effect::rebuild);
  }

  void prepare() override {
    // In double: the squared length of a direction may be too large or too small for a float.
    const double x = double(direction.x), y = double(direction.y), z = double(direction.z),
                 l = std::sqrt(x * x + y * y + z * z);
    if (!(l > 0 && std::isfinite(l))) fail("direction", "must be finite and not zero");
    travel_ = normalize(Vector3{float(x / l), float(y / l), float(z / l)});
    refuse_surface(*this, "a luminaire at infinity");
  }

  Extent extent() const override { return Extent::direction; }
  void surface_point(const Ray& ray, const Hit&, SurfacePoint& p) const override {
    fill(ray.origin, normalize(ray.direction), ray.time, p);
  }

  /// R^2, see above [m^2].
  float area(float) const override { return radius_ * radius_; }

  SurfaceSample sample_visible(const Point3& from, Point2, float time) const override {
    SurfaceSample s;
    Transform scratch;
    const Transform& t = placed(transform, time, scratch);
    s.direction = -(t.identity() ? travel_ : normalize(t(travel_)));
    s.pdf = 1;
    s.delta = true;
    s.infinite = true;
    s.distance = infinity;
    fill(from, s.direction, time, s.point);
    return s;
  }
  /// 0: the direction is a delta distribution, which no other sampling technique can generate.
  float visible_pdf(const Point3&, const Vector3&, const SurfacePoint&) const override { return 0; }

  Vector3 direction{0, -1, 0};

 private:
  /// The light's point as seen from another point: outside the scene, as for an Environment, but without a normal.
  void fill(const Point3& from, const Vector3& towards, float time, SurfacePoint& p) const {
    p.position = from + (2 * radius_ + distance(from, centre_)) * towards;
    p.error = 0;
    p.normal = p.shading_normal = p.object_normal = Normal3{};
    p.object_position = Point3{} - travel_;
    p.uv = {positive_atan2(-travel_.x, travel_.z) * (1 / (2 * pi)),
            positive_atan2(std::sqrt(travel_.x * travel_.x + travel_.z * travel_.z), travel_.y) * inverse_pi};
    p.dpdu = p.dpdv = {};
    p.time = time;
    p.object = this;
    p.primitive = 0;
    p.u = p.v = 0;
  }

  Vector3 travel_{0, -1, 0};  // unit, in object space
};

const Register<Distant> registered;

}  // namespace
}  // namespace etendue
