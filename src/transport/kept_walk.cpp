#include "etendue/transport/kept_walk.h"

#include "etendue/transport/emission_targets.h"
#include "etendue/transport/roulette.h"
#include "etendue/transport/walk.h"

namespace etendue {
namespace {

using Growing = Walk<false>;

/// Adds the vertex a walk has come to.
KeptVertex& add(const Growing& walk, float density, const LightFront& front, std::vector<KeptVertex>& kept) {
  KeptVertex& v = kept.emplace_back();
  keep(walk, kept[kept.size() - 2], density, front, v);
  return v;
}

struct KeptListener : NoListener {
  const Growing& walk;
  const LightFront& front;
  std::vector<KeptVertex>& kept;
  WalkListener* listener;
  const float& density;

  void emitted(const Spectrum& light) const {
    if (listener) listener->emitted(walk.length, light);
  }
  void through(const Medium& medium, float reach) const {
    if (listener) listener->through(medium, walk.ray, reach, walk.throughput);
  }
  void crossed_luminaire() const {
    if (!listener) return;
    add(walk, density, front, kept);
    listener->crossed_luminaire();
    kept.pop_back();
  }
};

/// Lets a walk grow whose first vertex is kept already. `density`: of its first direction.
void grow(Growing& walk, float density, const WalkLimits& limits, std::vector<KeptVertex>& kept, WalkListener* listener) {
  const LightFront front(walk.scene);
  const Roulette roulette{limits.roulette_depth};
  const bool from_camera = walk.transport == Transport::radiance;
  CameraDirections* const chosen = from_camera ? limits.directions : nullptr;
  float more = 1;  // the product of what directions are more likely than by scattering: so much more would be left without
  walk.keeps = walk.watched = true;
  const KeptListener at{{}, walk, front, kept, listener, density};
  while (walk.length < walk.longest && walk.next_vertex(at)) {
    if (kept.size() % 64 == 0 && walk.sample.aborted()) return;
    if (walk.vertex.kind == Vertex::Kind::escape && walk.transport == Transport::importance) return;
    KeptVertex& v = add(walk, density, front, kept);
    if (v.kind == Vertex::Kind::escape) return;
    const bool chooses = chosen || (v.scatter && v.scatter->has_choice());
    const float choice = chooses ? walk.numbers.next() : (walk.numbers.skip(), 0.0f);
    const Point2 u = walk.numbers.next_pair();
    const CameraDirections::Choice way =
        chosen ? chosen->sample(walk, choice, u) : CameraDirections::Choice{walk.sample_direction(choice, u)};
    const auto& next = way.next;
    if (!next || (v.on_surface() && enters_body(v.point, *next))) return;
    walk.leave(*next);
    v.specular = walk.specular;
    density = v.specular ? 1 : next->density;
    // Of the vertex before, had the walk come the other way through this one.
    float back = v.specular ? 1 : scattering_density(v, next->direction, v.out, adjoint(walk.transport));
    if (!from_camera && !v.specular) back = camera_density(limits.directions, v, next->direction, v.out, back);
    KeptVertex& before = kept[kept.size() - 2];
    before.reverse = vertex_density(back, v, before, v.out, v.chance, front);
    more *= way.more;
    if (!roulette.survives(walk, walk.left() * more)) return;
  }
}

}  // namespace

void keep(const Walk<false>& walk, const KeptVertex& before, float density, const LightFront& front, KeptVertex& v) {
  static_cast<Vertex&>(v) = walk.vertex;
  v.infinite = v.kind == Vertex::Kind::escape;
  v.single = walk.sample.wavelengths.single();
  v.throughput = walk.throughput;
  v.chance = walk.edge.average();
  if (v.in_medium())
    v.extinction = v.medium.coefficients(v.point.position, v.point.time, walk.sample.wavelengths).extinction().average();
  v.forward = vertex_density(density, before, v, walk.ray.direction, v.chance, front);
}

float vertex_density(float density, const KeptVertex& a, const KeptVertex& b, const Vector3& direction, float chance,
                     const LightFront& front) {
  density *= chance;
  if (b.infinite || b.kind == Vertex::Kind::escape) return density;
  if (b.in_medium())
    density *= b.extinction;
  else if (b.point.normal != Normal3{})
    density *= std::abs(dot(b.point.normal, direction));
  if (a.parallel) return density;
  if (a.infinite) return density * front.density(b.point.position, direction);
  return density / length_squared(b.point.position - a.point.position);
}

float camera_direction_density(const Camera& camera, const Ray& ray) {
  const CameraDensity density = camera.density(ray);
  return camera.parallel() ? density.position : density.direction;
}

void walk_from_camera(const RenderContext& context, const Ray& ray, const WalkLimits& limits, SampleContext& sample,
                      std::vector<KeptVertex>& kept, WalkListener& listener) {
  kept.clear();
  KeptVertex& lens = kept.emplace_back();
  lens.kind = Vertex::Kind::camera;
  lens.parallel = context.camera.parallel();
  lens.point.position = context.camera.lens_point(ray);
  lens.point.time = ray.time;
  Growing walk(context.scene, sample, ray, limits.longest);
  if (context.scene.has_interiors()) media_at(context.scene, ray.origin, ray.time, walk.media);
  grow(walk, camera_direction_density(context.camera, ray), limits, kept, &listener);
}

bool walk_from_luminaire(const Scene& scene, const LightSampler& lights, float time, const WalkLimits& limits,
                         SampleContext& sample, std::vector<KeptVertex>& kept, EmittedLight& light,
                         const EmissionTargets* targets, WalkListener* listener) {
  kept.clear();
  const bool leaves = targets ? targets->sample_emitted_light(scene, lights, sample.wavelengths, time, sample.numbers, light)
                              : sample_emitted_light(scene, lights, sample.wavelengths, time, sample.numbers, light);
  if (!leaves && !light.placed) return false;
  KeptVertex& first = kept.emplace_back();
  first.kind = Vertex::Kind::luminaire;
  first.infinite = light.infinite;
  first.point = light.point;
  first.forward = light.choice * (light.infinite ? light.direction : light.position);
  if (!leaves) return false;
  Growing walk(scene, sample, light.ray, limits.longest, Transport::importance, light.throughput());
  if (scene.has_interiors() && !light.infinite) {
    media_at(scene, light.ray.origin, time, walk.media);
    first.media = sample.arena.make<MediumStack>(walk.media);
  }
  if (const SceneObject* around = light.infinite ? scene.surroundings() : nullptr) {
    // It begins where what surrounds the scene does, and never comes through what has no beginning, but where nothing absorbs.
    walk.media.surround(*around);
    Ray back = light.ray;
    back.direction = -light.ray.direction;
    if (const Medium medium = medium_in(walk.media); medium && within_object(medium, back) == infinity) {
      walk.throughput *= transmittance(medium, back, infinity, sample.wavelengths, sample.numbers);
      if (walk.throughput.black()) return false;
    }
  }
  // From infinity, places in the scene are given by where the ray crosses the disc around it.
  grow(walk, light.infinite ? 1 : light.direction, limits, kept, listener);
  return true;
}

float begun_density(const LightSampler& lights, const KeptVertex& x1, const KeptVertex& luminaire, const Vector3& direction) {
  const SceneObject& object = *luminaire.point.object;
  const float choice = lights.probability(object);
  if (object.delta()) return choice;
  return choice * (luminaire.infinite ? object.visible_density(x1.point.position, direction, luminaire.point)
                                      : object.area_density(luminaire.point));
}

float sampled_density(const LightSampler& lights, const KeptVertex& x1, const KeptVertex& luminaire, const Vector3& direction) {
  const SceneObject& object = *luminaire.point.object;
  const float choice = lights.probability(x1.point.position, x1.normal(), object);
  if (object.delta() || !(choice > 0)) return choice;
  const float density = choice * object.visible_density(x1.point.position, direction, luminaire.point);
  if (luminaire.infinite) return density;
  return density * std::abs(dot(luminaire.point.normal, direction)) /
         length_squared(luminaire.point.position - x1.point.position);
}

void record_walk(std::vector<PathRecord::Vertex>& vertices, std::span<const KeptVertex> walk) {
  for (const KeptVertex& w : walk) {
    PathRecord::Vertex v;
    switch (w.kind) {
      case Vertex::Kind::camera: v.kind = "camera"; break;
      case Vertex::Kind::luminaire: v.kind = "luminaire"; break;
      case Vertex::Kind::surface: v.kind = "surface"; break;
      case Vertex::Kind::medium: v.kind = "volume"; break;
      case Vertex::Kind::escape: v.kind = "escaped"; break;
    }
    if (w.point.object && !w.in_medium()) v.object = object_name(*w.point.object);
    v.position = w.point.position;
    v.normal = w.point.normal;
    v.throughput = w.throughput;
    v.density = w.forward;
    if (w.specular) v.lobe = "specular";
    if (w.single) v.note = "the hero wavelength alone";
    vertices.push_back(std::move(v));
  }
}

void note_first_surface(const Scene& scene, const Ray& camera_ray, SampleContext& sample) {
  Ray ray = camera_ray;
  float crossed = 0;
  Hit hit;
  SurfacePoint point;
  for (int crossings = 0; crossings <= most_crossings && scene.nearest(ray, hit); ++crossings) {
    scene.locate(ray, hit, point);
    const Shader* shader = point.object->shader.get();
    if (shader && shader->possible_lobes() == pass_through) {
      crossed += hit.distance;
      ray.maximum -= hit.distance;
      ray.origin = point.exit(ray.direction);
      hit = {};
      continue;
    }
    const Scatter* scatter = shader ? bound(*shader, point, sample.wavelengths, sample.arena) : nullptr;
    sample.observe.first_surface(scene, point, hit, scatter, -ray.direction, sample.wavelengths, crossed);
    return;
  }
}

}  // namespace etendue
