// Environment: a luminaire at infinity in all directions (environment map).

#include "etendue/core/warp.h"
#include "etendue/infinite_object.h"
#include "geometry/geometry.h"

namespace etendue {

class Environment final : public InfiniteObject {
 public:
  static void describe(Description<Environment>& d) {
    d.summary(
        "A sphere at infinity around the scene, which carries an emission shader; its transform turns it. Its +y axis is up; "
        "u runs from -z by +x, +z and -x around it, to the right as seen from inside, v from the pole at -y to that at +y.");
  }

  void prepare() override {
    for (const AnimatedTransform::Key& key : transform.keys())
      if (key.transform.valid() && similarity_scale(key.transform) == 0)
        fail("transform", "an environment can only be turned, not stretched");
  }

  /// The point where a ray that left the scene hits the environment: far outside the scene, with its normal towards the ray.
  void surface_point(const Ray& ray, const Hit&, SurfacePoint& p) const override {
    fill(ray.origin, normalize(ray.direction), ray.time, p, true);
  }

  void tangents(SurfacePoint& p) const override {
    if (p.dpdu != Vector3{}) return;
    const Frame frame(p.normal);
    p.dpdu = frame.s;
    p.dpdv = frame.t;
  }

  /// The area [m^2] of the scene's bounding sphere, through which the light enters: its power is pi * area * radiance, as for
  /// any diffuse luminaire.
  float area(float) const override { return 4 * pi * radius_ * radius_; }

  SurfaceSample sample_visible(const Point3& from, Point2 u, float time) const override {
    SurfaceSample s;
    if (emission && emission->knows_incident()) {
      const DirectionSample d = emission->sample_incident(u);
      if (!(d.pdf > 0)) return s;
      Transform scratch;
      const Transform& t = placed(transform, time, scratch);
      s.direction = t.identity() ? d.direction : normalize(t(d.direction));
      s.pdf = d.pdf;
    } else {
      s.direction = warp::sphere(u);
      s.pdf = warp::sphere_pdf;
    }
    s.infinite = true;
    s.distance = infinity;
    fill(from, s.direction, time, s.point, !emission || !emission->only_at_infinity());
    return s;
  }

  float visible_pdf(const Point3&, const Vector3& direction, const SurfacePoint& p) const override {
    if (!emission || !emission->knows_incident()) return warp::sphere_pdf;
    return emission->incident_pdf(inside(direction, p.time));
  }

  int most_visible_places() const override {
    return emission && emission->knows_incident() ? emission->most_incident_places() : 1;
  }
  IncidentPlaces visible_places(const Vector3& direction, float time) const override {
    if (emission && emission->knows_incident()) return emission->incident_places(inside(direction, time));
    // The inverse of warp::sphere.
    IncidentPlaces places;
    places.add({clamp((1 - direction.z) / 2, 0, one_minus_epsilon),
                std::min(positive_atan2(direction.y, direction.x) * (1 / (2 * pi)), one_minus_epsilon)},
               warp::sphere_pdf);
    return places;
  }

 private:
  Vector3 inside(const Vector3& direction, float time) const {
    Transform scratch;
    const Transform& t = placed(transform, time, scratch);
    return t.identity() ? direction : normalize(t.back(direction));
  }

  /// Emissions that are for infinity alone do not look at uv, which takes two arcus tangents.
  void fill(const Point3& from, const Vector3& direction, float time, SurfacePoint& p, bool with_uv) const {
    const Vector3 local = inside(direction, time);
    const float away = 2 * radius_ + distance(from, centre_);
    p.position = from + away * direction;
    p.error = 0;
    p.normal = Normal3(-direction);
    p.shading_normal = p.normal;
    p.uv = {};
    if (with_uv)
      p.uv = {positive_atan2(local.x, -local.z) * (1 / (2 * pi)),
              positive_atan2(std::sqrt(local.x * local.x + local.z * local.z), -local.y) * inverse_pi};
    p.dpdu = {};
    p.dpdv = {};
    p.object_position = Point3{local.x, local.y, local.z};
    p.object_normal = Normal3(-local);
    p.time = time;
    p.object = this;
    p.primitive = 0;
    p.u = 0;
    p.v = 0;
  }
};

static const Register<Environment> registered;

}  // namespace etendue
