#include "etendue/transport/luminaires.h"

#include "etendue/core/warp.h"

namespace etendue {
namespace {

/// The beginning of light that passes `p`, unit `outward` the way it came. All bounded objects lie behind p, but surfaces
/// without end may lie before it, and light meets them first: it begins beyond the last of them. False: there is no last.
bool begin_before_all(const Scene& scene, const Point3& p, const Vector3& outward, float time, Point3& origin) {
  constexpr int most = 1000;
  Ray ray;
  ray.origin = origin = p;
  ray.direction = outward;
  ray.time = time;
  SurfacePoint point;
  for (int i = 0; i < most; ++i) {
    Hit hit;
    if (!scene.nearest(ray, hit)) return true;
    scene.locate(ray, hit, point);
    // So far that rounding on the long way does not matter.
    origin = point.position + (scene.radius() + 1e-3f * length(point.position - p)) * outward;
    ray.origin = point.exit(outward);
  }
  return false;
}

bool from_infinity(const Scene& scene, const SceneObject& luminaire, const Wavelengths& w, float time, Point2 position,
                   Point2 direction, EmittedLight& light) {
  const LightFront front(scene);
  const SurfaceSample s = luminaire.sample_visible(front.centre(), direction, time);
  if (!(s.density > 0)) return false;
  const Frame frame(Normal3(-s.direction));
  const Point2 across = front.sample(position);
  light.infinite = true;
  light.point = s.point;
  light.ray.direction = -s.direction;
  light.ray.origin = front.centre() + scene.radius() * s.direction + across.x * frame.s + across.y * frame.t;
  light.direction = s.density;
  light.position = front.density(light.ray.origin, s.direction);
  if (scene.unbounded() && !begin_before_all(scene, light.ray.origin, s.direction, time, light.ray.origin)) return false;
  light.radiance = luminaire.emission->radiance(s.point, light.ray.direction, w);
  return true;
}

}  // namespace

Point2 LightFront::sample(Point2 u) const {
  if (!endless_) {
    const Point2 p = warp::disc(u);
    return {radius_ * p.x, radius_ * p.y};
  }
  if (u.x < 0.5f) {
    const Point2 p = warp::disc({2 * u.x, u.y});
    return {radius_ * p.x, radius_ * p.y};
  }
  const float r = radius_ / (2 - 2 * u.x);
  float sine = 0, cosine = 0;
  sin_cos_turn(u.y, sine, cosine);
  return {r * cosine, r * sine};
}

bool sample_emitted_light(const Scene& scene, const LightSampler& lights, const Wavelengths& w, float time,
                          NumberStream& numbers, EmittedLight& light) {
  const float which = numbers.next();
  const Point2 position = numbers.next_pair(), direction = numbers.next_pair();
  const LightChoice choice = lights.choose(which);
  if (!choice.luminaire || !(choice.probability > 0)) return false;
  const SceneObject& luminaire = *choice.luminaire;
  light.choice = choice.probability;
  light.infinite = false;
  light.ray = {};
  light.ray.time = time;
  if (luminaire.infinite()) {
    if (!from_infinity(scene, luminaire, w, time, position, direction, light)) return false;
  } else {
    const SurfaceSample s = luminaire.sample_area(position, time);
    if (!(s.density > 0)) return false;
    const DirectionSample d = luminaire.emission->sample(s.point, direction);
    if (!(d.density > 0)) return false;
    light.point = s.point;
    light.position = s.density;
    light.direction = d.density;
    light.radiance = luminaire.emission->radiance(s.point, d.direction, w);
    if (s.point.normal == Normal3{}) {
      light.ray.origin = s.point.position;
      light.ray.direction = d.direction;
    } else {
      light.radiance *= std::abs(dot(s.point.normal, d.direction));
      s.point.leave(d.direction, light.ray);
      light.ray.time = time;
    }
  }
  return !light.radiance.black();
}

}  // namespace etendue
