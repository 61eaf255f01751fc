#include "transport/luminaire_sampling.h"

#include "etendue/warp.h"

namespace etendue {
namespace {

bool from_infinity(const Scene& scene, const SceneObject& luminaire, const Wavelengths& w, float time, Point2 position,
                   Point2 direction, EmittedLight& light) {
  const SurfaceSample s = luminaire.sample_visible(scene.centre(), direction, time);
  if (!(s.density > 0)) return false;
  const float radius = scene.radius();
  const Frame frame(Normal3(-s.direction));
  const Point2 across = warp::disc(position);
  light.infinite = true;
  light.point = s.point;
  light.ray.direction = -s.direction;
  light.ray.origin = scene.centre() + radius * (s.direction + across.x * frame.s + across.y * frame.t);
  light.direction = s.density;
  light.position = 1 / (pi * square(radius));
  light.radiance = luminaire.emission->radiance(s.point, light.ray.direction, w);
  return true;
}

}  // namespace

bool sample_emitted_light(const Scene& scene, const LightSampler& lights, const Wavelengths& w, float time,
                          SampleStream& random, EmittedLight& light) {
  const float which = random.next();
  const Point2 position = random.next_pair(), direction = random.next_pair();
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
