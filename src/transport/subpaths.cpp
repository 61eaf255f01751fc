#include "subpaths.h"

#include "media.h"
#include "random_walk.h"

namespace etendue {

bool has_parallel_rays(const Camera& camera, int film_width) {
  const auto direction = [&](float x) { return camera.ray({x, 0.5f}, {0.5f, 0.5f}, camera.shutter_open).direction; };
  return film_width > 1 && direction(0.5f) == direction(float(film_width) - 0.5f);
}

float camera_direction_density(const Camera& camera, bool parallel, const Ray& ray) {
  const CameraDensity density = camera.density(ray);
  return parallel ? density.position : density.direction;
}

void walk_from_camera(const RenderContext& context, const Ray& ray, bool parallel, const WalkLimits& limits,
                      Wavelengths& wavelengths, SampleStream& random, Arena& arena, std::vector<Vertex>& path,
                      std::function<void(int, const Spectrum&)>* emitted, std::function<void()>* crossed) {
  path.clear();
  Vertex& lens = path.emplace_back();
  lens.kind = Vertex::Kind::camera;
  lens.parallel = parallel;
  lens.point.position = ray.origin;
  lens.point.time = ray.time;
  MediumStack media;
  if (context.scene.has_interiors()) media_at(context.scene, ray.origin, ray.time, media);
  WalkStart start;
  start.ray = ray;
  start.direction_density = camera_direction_density(context.camera, parallel, ray);
  start.longest = limits.longest;
  start.roulette_depth = limits.roulette_depth;
  start.sample = limits.sample;
  start.emitted = emitted;
  start.crossed = crossed;
  random_walk(context.scene, start, media, wavelengths, random, arena, path);
}

bool walk_from_luminaire(const Scene& scene, const LightSampler& lights, float time, const WalkLimits& limits,
                         Wavelengths& wavelengths, SampleStream& random, Arena& arena, std::vector<Vertex>& path,
                         EmittedLight& light) {
  path.clear();
  if (!sample_emitted_light(scene, lights, wavelengths, time, random, light)) return false;
  Vertex& first = path.emplace_back();
  first.kind = Vertex::Kind::luminaire;
  first.infinite = light.infinite;
  first.point = light.point;
  first.forward = light.choice * (light.infinite ? light.direction : light.position);
  MediumStack media;
  if (scene.has_interiors() && !light.infinite) {
    media_at(scene, light.ray.origin, time, media);
    first.media = arena.make<MediumStack>(media);
  }
  WalkStart start;
  start.ray = light.ray;
  start.throughput = light.throughput();
  // From infinity, places in the scene are given by where the ray crosses the disc around it.
  start.direction_density = light.infinite ? 1 : light.direction;
  start.transport = Transport::importance;
  start.longest = limits.longest;
  start.roulette_depth = limits.roulette_depth;
  start.sample = limits.sample;
  random_walk(scene, start, media, wavelengths, random, arena, path);
  return true;
}

float begun_density(const LightSampler& lights, const Vertex& x1, const Vertex& luminaire, const Vector3& direction) {
  const SceneObject& object = *luminaire.point.object;
  const float choice = lights.probability(object);
  if (object.delta()) return choice;
  return choice * (luminaire.infinite ? object.visible_density(x1.point.position, direction, luminaire.point)
                                      : object.area_density(luminaire.point));
}

float sampled_density(const LightSampler& lights, const Vertex& x1, const Vertex& luminaire, const Vector3& direction) {
  const SceneObject& object = *luminaire.point.object;
  const float choice = lights.probability(x1.point.position, x1.point.normal, object);
  if (object.delta() || !(choice > 0)) return choice;
  const float density = choice * object.visible_density(x1.point.position, direction, luminaire.point);
  if (luminaire.infinite) return density;
  return density * std::abs(dot(luminaire.point.normal, direction)) /
         length_squared(luminaire.point.position - x1.point.position);
}

}  // namespace etendue
