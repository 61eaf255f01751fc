#include "etendue/transport/subpath.h"

#include "etendue/transport/projection_map.h"
#include "etendue/transport/roulette.h"
#include "etendue/transport/walk.h"

namespace etendue {
namespace {

using Growing = Walk<false>;

/// Appends the last vertex of a walk.
SubpathVertex& add(const Growing& walk, float pdf, const EmissionPlane& front, std::vector<SubpathVertex>& subpath) {
  SubpathVertex& v = subpath.emplace_back();
  store_vertex(walk, subpath[subpath.size() - 2], pdf, front, v);
  return v;
}

struct StoringEvents : NoEvents {
  const Growing& walk;
  const EmissionPlane& front;
  std::vector<SubpathVertex>& subpath;
  SegmentEvents* events;
  const float& pdf;

  void emitted(const Spectrum& light) const {
    if (events) events->emitted(walk.length, light);
  }
  void through(const Medium& medium, float reach) const {
    if (events) events->through(medium, walk.ray, reach, walk.throughput);
  }
  void crossed_luminaire() const {
    if (!events) return;
    add(walk, pdf, front, subpath);
    events->crossed_luminaire();
    subpath.pop_back();
  }
};

/// pdf_reverse of the vertex `before` v: its pdf for a subpath from the other end, which comes to v from the direction `next`.
float reverse_pdf(const SubpathVertex& v, const SubpathVertex& before, const Vector3& next, Transport transport,
                  const CameraDirections* directions, const EmissionPlane& front) {
  float back = v.leaves_specularly ? 1 : scattering_pdf(v, next, v.out, adjoint(transport));
  if (transport == Transport::importance && !v.leaves_specularly) back = camera_pdf(directions, v, next, v.out, back);
  return vertex_pdf(back, v, before, v.out, v.mean_transmittance, front);
}

/// Traces a walk whose first vertex is stored already, and stores its vertices with their pdfs. `pdf`: of the first direction.
void grow(Growing& walk, float pdf, const SubpathLimits& limits, std::vector<SubpathVertex>& subpath, SegmentEvents* events) {
  const EmissionPlane front(walk.scene);
  const Roulette roulette{limits.roulette_depth};
  const bool from_camera = walk.transport == Transport::radiance;
  CameraDirections* const chosen = from_camera ? limits.directions : nullptr;
  float more = 1;  // product of p / p_scatter: without a guide the throughput would be larger by this factor, and that decides
                   // the roulette
  walk.stores_subpath = walk.observed = true;
  walk.levels = limits.levels;
  walk.reradiates = limits.levels != nullptr;
  walk.reradiates_in_media = walk.reradiates && limits.dyes;
  walk.level = subpath.front().level;
  const StoringEvents at{{}, walk, front, subpath, events, pdf};
  while (walk.length < walk.longest && walk.next_vertex(at)) {
    if (subpath.size() % 64 == 0 && walk.sample.aborted()) return;
    if (walk.vertex.kind == PathVertex::Kind::escape && walk.transport == Transport::importance) return;
    walk.choose_reradiation();
    SubpathVertex& v = add(walk, pdf, front, subpath);
    if (v.kind == PathVertex::Kind::escape) return;
    const bool chooses = chosen || (v.scatter && v.scatter->has_choice());
    const float choice = chooses ? walk.numbers.next() : (walk.numbers.skip(), 0.0f);
    const Point2 u = walk.numbers.next_pair();
    const CameraDirections::Choice way =
        chosen ? chosen->sample(walk, choice, u) : CameraDirections::Choice{walk.sample_direction(choice, u)};
    const auto& next = way.next;
    if (!next || (v.on_surface() && enters_subsurface(v.point, *next))) return;
    if (PathStates* const states = PathStates::current()) [[unlikely]] {
      const PathState before = subpath[subpath.size() - 2].path;
      v.path = from_camera ? states->scattered(before, v, next->direction, next->lobe)
                           : states->scattered_before(before, v, next->direction, next->lobe);
    }
    walk.leave(*next);
    v.leaves_specularly = walk.arrived_specularly;
    pdf = v.leaves_specularly ? 1 : next->pdf;
    if (limits.reverse_pdfs) {
      SubpathVertex& before = subpath[subpath.size() - 2];
      before.pdf_reverse = reverse_pdf(v, before, next->direction, walk.transport, limits.directions, front);
    }
    more *= way.more;
    if (!roulette.survives(walk, walk.roulette_weight() * more)) return;
  }
}

}  // namespace

void store_vertex(const Walk<false>& walk, const SubpathVertex& before, float pdf, const EmissionPlane& front,
                  SubpathVertex& v) {
  static_cast<PathVertex&>(v) = walk.vertex;
  v.infinite = v.kind == PathVertex::Kind::escape;
  v.hero_only = walk.sample.wavelengths.single();
  v.level = walk.level;
  v.throughput = walk.throughput;
  v.mean_transmittance = walk.segment_transmittance.average();
  if (v.in_medium())
    v.extinction = v.medium.coefficients(v.point.position, v.point.time, walk.sample.wavelengths).extinction().average();
  v.pdf_forward = vertex_pdf(pdf, before, v, walk.ray.direction, v.mean_transmittance, front);
}

float vertex_pdf(float pdf, const SubpathVertex& a, const SubpathVertex& b, const Vector3& direction, float mean_transmittance,
                 const EmissionPlane& front) {
  pdf *= mean_transmittance;
  if (b.infinite || b.kind == PathVertex::Kind::escape) return pdf;
  if (b.in_medium())
    pdf *= b.extinction;
  else if (b.point.normal != Normal3{})
    pdf *= std::abs(dot(b.point.normal, direction));
  if (a.parallel) return pdf;
  if (a.infinite) return pdf * front.pdf(b.point.position, direction);
  return pdf / length_squared(b.point.position - a.point.position);
}

SubpathVertex lens_vertex(const Camera& camera, const Point3& position, float time) {
  SubpathVertex lens;
  lens.kind = PathVertex::Kind::camera;
  lens.parallel = camera.parallel();
  lens.point.position = position;
  lens.point.time = time;
  lens.path = path_after_camera;
  return lens;
}

float camera_direction_pdf(const Camera& camera, const Ray& ray) {
  const CameraPdf pdf = camera.pdf(ray);
  return camera.parallel() ? pdf.position : pdf.direction;
}

void generate_camera_subpath(const RenderContext& context, const Ray& ray, const SubpathLimits& limits, SampleContext& sample,
                             std::vector<SubpathVertex>& subpath, SegmentEvents& events) {
  subpath.clear();
  subpath.push_back(lens_vertex(context.camera, context.camera.lens_point(ray), ray.time));
  Growing walk(context.scene, sample, ray, limits.longest);
  if (context.scene.has_interiors()) media_at(context.scene, ray.origin, ray.time, walk.media);
  grow(walk, camera_direction_pdf(context.camera, ray), limits, subpath, &events);
}

bool generate_light_subpath(const Scene& scene, const LightSampler& lights, float time, const SubpathLimits& limits,
                            SampleContext& sample, std::vector<SubpathVertex>& subpath, EmittedLight& light,
                            const ProjectionMap* targets, SegmentEvents* events) {
  subpath.clear();
  const bool leaves = targets ? targets->sample_emitted_light(scene, lights, sample.wavelengths, time, sample.numbers, light)
                              : sample_emitted_light(scene, lights, sample.wavelengths, time, sample.numbers, light);
  if (!leaves && !light.placed) return false;
  SubpathVertex& first = subpath.emplace_back();
  first.kind = PathVertex::Kind::luminaire;
  first.infinite = light.infinite;
  first.level = limits.levels ? limits.levels->count() : 0;
  first.point = light.point;
  first.pdf_forward = light.probability * (light.infinite ? light.pdf_direction : light.pdf_position);
  if (const PathStates* const states = PathStates::current()) [[unlikely]]
    first.path = states->begun(light.point.object);
  if (!leaves) return false;
  Growing walk(scene, sample, light.ray, limits.longest, Transport::importance, light.throughput());
  if (scene.has_interiors() && !light.infinite) {
    media_at(scene, light.ray.origin, time, walk.media);
    first.media = sample.arena.make<MediumStack>(walk.media);
  }
  if (const SceneObject* around = light.infinite ? scene.surroundings() : nullptr) {
    // Light from infinity starts at the boundary of the surroundings. If they have none, the light comes an infinite distance
    // through them, and is absorbed unless the extinction is 0.
    walk.media.surround(*around);
    Ray back = light.ray;
    back.direction = -light.ray.direction;
    if (const Medium medium = medium_in(walk.media); medium && within_object(medium, back) == infinity) {
      walk.throughput *= transmittance(medium, back, infinity, sample.wavelengths, sample.numbers);
      if (walk.throughput.black()) return false;
    }
  }
  // For a luminaire at infinity the pdf of the next vertex is that of the ray on the emission plane (vertex_pdf): the factor of
  // the direction is 1.
  grow(walk, light.infinite ? 1 : light.pdf_direction, limits, subpath, events);
  return true;
}

float pdf_emission_origin(const LightSampler& lights, const SubpathVertex& x1, const SubpathVertex& luminaire,
                          const Vector3& direction) {
  const SceneObject& object = *luminaire.point.object;
  const float choice = lights.probability(object);
  if (object.delta()) return choice;
  return choice * (luminaire.infinite ? object.visible_pdf(x1.point.position, direction, luminaire.point)
                                      : object.area_pdf(luminaire.point));
}

float next_event_point_pdf(const LightSampler& lights, const SubpathVertex& x1, const SubpathVertex& luminaire,
                           const Vector3& direction) {
  const SceneObject& object = *luminaire.point.object;
  const float choice = lights.probability(x1.point.position, x1.normal(), object);
  if (object.delta() || !(choice > 0)) return choice;
  const float pdf = choice * object.visible_pdf(x1.point.position, direction, luminaire.point);
  if (luminaire.infinite) return pdf;
  return pdf * std::abs(dot(luminaire.point.normal, direction)) / length_squared(luminaire.point.position - x1.point.position);
}

void record_subpath(std::vector<PathRecord::Vertex>& vertices, std::span<const SubpathVertex> walk) {
  for (const SubpathVertex& w : walk) {
    PathRecord::Vertex v;
    switch (w.kind) {
      case PathVertex::Kind::camera: v.kind = "camera"; break;
      case PathVertex::Kind::luminaire: v.kind = "luminaire"; break;
      case PathVertex::Kind::surface: v.kind = "surface"; break;
      case PathVertex::Kind::medium: v.kind = "volume"; break;
      case PathVertex::Kind::escape: v.kind = "escaped"; break;
    }
    if (w.point.object && !w.in_medium()) v.object = object_name(*w.point.object);
    v.position = w.point.position;
    v.normal = w.point.normal;
    v.throughput = w.throughput;
    v.pdf = w.pdf_forward;
    if (w.leaves_specularly) v.lobe = "specular";
    if (w.hero_only) v.note = "the hero wavelength alone";
    vertices.push_back(std::move(v));
  }
}

}  // namespace etendue
