// Path space: traces rays, chains and walks, and connects them to paths (light_path.h).

#include "etendue/transport/boundaries.h"
#include "etendue/transport/light_path.h"
#include "path_lobes.h"

namespace etendue {
namespace {

float next(ChoiceNumbers& choices) { return std::min(float(choices.next()), one_minus_epsilon); }
Point2 next_pair(ChoiceNumbers& choices) {
  const float x = next(choices);
  return {x, next(choices)};
}

/// Whether a ray with an end meets only surfaces that are hidden by priority, as PathSpace::follow passes them. `media` are
/// those at the ray's origin.
bool unoccluded(const Scene& scene, Ray ray, MediumStack media) {
  const Point3 end = ray(ray.maximum);
  for (int crossings = 0; crossings <= most_crossings; ++crossings) {
    Hit hit;
    if (!scene.nearest(ray, hit)) return true;
    SurfacePoint point;
    scene.locate(ray, hit, point);
    resolve_coincident(scene, ray, hit, point, media);
    if (!hidden_by_priority(media, *point.object)) return false;
    cross_boundary(media, *point.object, point.normal, ray.direction);
    ray.origin = point.exit(ray.direction);
    const Vector3 rest = end - ray.origin;
    if (!(dot(rest, ray.direction) > 0)) return true;
    ray.maximum = length(rest);
    ray.direction = rest / ray.maximum;
  }
  return false;
}

bool is_luminaire(const ChainVertex& v) { return v.point.object->luminaire() && !v.point.object->delta(); }

}  // namespace

ChainVertex PathSpace::lens(const LightPath& y) const {
  ChainVertex v;
  v.kind = PathVertex::Kind::camera;
  v.point.position = context.camera.lens_point(
      context.camera.ray({0.5f * float(context.image.width), 0.5f * float(context.image.height)}, y.lens, time));
  v.point.time = time;
  return v;
}

Vector3 PathSpace::camera_direction(Point2 film, const LightPath& y) const {
  return context.camera.ray(film, y.lens, time).direction;
}

bool PathSpace::follow(const ChainVertex& from, const Vector3& direction, LightPath& y, ChainVertex& to) const {
  const Scene& scene = context.scene;
  Ray ray = leaving_ray(from, direction);
  if (from.kind == PathVertex::Kind::camera) {
    const Camera::Reach reach = context.camera.reach(ray);
    ray.origin = ray(reach.nearest);
    ray.maximum = reach.farthest - reach.nearest;
    ray.of_camera = true;
  }
  MediumStack media;
  const bool tracks = scene.has_interiors();
  if (tracks) {
    if (from.on_surface() && from.media)
      media = *media_towards(from, direction, media);
    else
      media_at(scene, ray.origin, time, media);
  }
  to = {};
  Hit hit;
  for (int crossings = 0; crossings <= most_crossings; ++crossings) {
    if (!scene.nearest(ray, hit)) return false;
    scene.locate(ray, hit, to.point);
    if (tracks) {
      resolve_coincident(scene, ray, hit, to.point, media);
      if (hidden_by_priority(media, *to.point.object)) {
        cross_boundary(media, *to.point.object, to.point.normal, direction);
        ray.maximum -= hit.distance;
        ray.origin = to.point.exit(direction);
        hit = {};
        continue;
      }
      to.point.media = to.media = y.arena->make<MediumStack>(media);
    }
    to.out = -direction;
    to.lobes = smooth_lobes;
    to.scatter = scattering_at(to.point, to.out, y.wavelengths, *y.arena);
    return true;
  }
  return false;
}

std::optional<Vector3> PathSpace::follow_lobes(Walk& walk, const Vector3& direction, std::span<const Lobe> lobes,
                                               Transport transport, LightPath& y) const {
  Vector3 way = direction;
  ChainVertex to;
  for (const Lobe lobe : lobes) {
    if (!follow(walk.back(), way, y, to)) return {};
    const auto s = follow_specular(to, to.out, transport, lobe);
    if (!s) return {};
    to.leaves_specularly = true;
    to.lobe = lobe;
    way = s->direction;
    walk.push_back(to);
  }
  return way;
}

bool PathSpace::follow_chain(Walk& walk, const Vector3& direction, std::span<const Lobe> lobes, Transport transport,
                             LightPath& y, bool to_luminaire) const {
  const std::optional<Vector3> way = follow_lobes(walk, direction, lobes, transport, y);
  ChainVertex to;
  if (!way || !follow(walk.back(), *way, y, to)) return false;
  if (to_luminaire) {
    if (!is_luminaire(to)) return false;
    to.kind = PathVertex::Kind::luminaire;
  } else if (!to.scatters_smoothly()) {
    return false;
  }
  walk.push_back(to);
  return true;
}

bool PathSpace::follow_from_camera(Walk& walk, Point2 film, const LightPath& x, LightPath& y) const {
  const int k = x.length(), seen = x.smooth_before(k);
  std::vector<Lobe> lobes;
  if (seen + 1 < k) lobes = x.lobes(k - 1, seen + 1);
  return follow_chain(walk, camera_direction(film, y), lobes, Transport::radiance, y, seen == 0);
}

bool PathSpace::walk(Walk& walk, int count, Transport transport, ChoiceNumbers& choices, LightPath& y,
                     bool to_luminaire) const {
  const size_t given = walk.size();
  for (; count > 0; --count) {
    ChainVertex to;
    if (walk.empty()) {
      const LightChoice choice = lights.choose(next(choices));
      if (!choice.luminaire || choice.luminaire->infinite() || choice.luminaire->delta()) return false;
      const SurfaceSample s = choice.luminaire->sample_area(next_pair(choices), time);
      if (!(s.pdf > 0)) return false;
      to.kind = PathVertex::Kind::luminaire;
      to.point = s.point;
      walk.push_back(to);
      continue;
    }
    ChainVertex& from = walk.back();
    Vector3 way;
    if (from.kind == PathVertex::Kind::camera) {
      const Point2 u = next_pair(choices);
      way = camera_direction({u.x * float(context.image.width), u.y * float(context.image.height)}, y);
    } else if (from.kind == PathVertex::Kind::luminaire) {
      const DirectionSample d = from.point.object->emission->sample(from.point, next_pair(choices));
      if (!(d.pdf > 0)) return false;
      way = d.direction;
    } else {
      if (!from.scatter) return false;
      const Vector3 out = normalize(walk[walk.size() - 2].point.position - from.point.position);
      size_t chosen = 0;
      double u = choices.next();
      for (; chosen < std::size(lobe_groups); ++chosen)
        if ((u -= lobe_share(from, out, lobe_groups[chosen])) < 0) break;
      if (chosen == std::size(lobe_groups)) return false;  // nothing is scattered; or by rounding
      const bool specular_one = lobe_groups[chosen] != smooth_lobes;
      if (specular_one && walk.size() == given) return false;  // the vertices that were given stay smooth
      const auto s = specular_one ? follow_specular(from, out, transport, Lobe(lobe_groups[chosen]))
                                  : from.scatter->sample(out, next(choices), next_pair(choices), {transport, smooth_lobes});
      if (!s || enters_subsurface(from.point, *s)) return false;
      from.leaves_specularly = specular_one;
      from.lobe = Lobe(s->lobe);
      way = s->direction;
    }
    if (!follow(from, way, y, to)) return false;
    const bool ends = to_luminaire && count == 1;
    if (ends && is_luminaire(to)) to.kind = PathVertex::Kind::luminaire;
    walk.push_back(to);
    if (ends ? !is_luminaire(to) : !to.scatter || !to.scatter->has(vertex_lobes)) return false;
  }
  return true;
}

bool PathSpace::visible(const LightPath& path, int i) const {
  const ChainVertex &a = path.x[size_t(i)], &b = path.x[size_t(i) + 1];
  const ChainVertex &from = a.on_surface() ? a : b, &to = a.on_surface() ? b : a;
  Ray ray;
  if (to.kind == PathVertex::Kind::camera) {
    const Vector3 way = to.point.position - from.point.position;
    ray = leaving_ray(from, normalize(way));
    Ray seen = ray;
    seen.direction = -ray.direction;
    ray.maximum = (length(way) - context.camera.reach(seen).nearest) * SurfacePoint::almost_there;
  } else {
    ray = connecting_ray(from, to);
  }
  ray.of_camera = b.kind == PathVertex::Kind::camera;
  if (ray.of_camera && unseen(a)) return false;
  if (!context.scene.has_interiors()) return !context.scene.any(ray);
  MediumStack scratch;
  const MediumStack* const media = media_towards(from, ray.direction, scratch);
  return !media || media->empty() ? !context.scene.any(ray) : unoccluded(context.scene, ray, *media);
}

bool PathSpace::joined(LightPath& y, const Walk& light, int b, const Walk& camera, int c) const {
  y.x.assign(light.begin(), light.begin() + b);
  y.x.insert(y.x.end(), camera.rend() - c, camera.rend());
  // The last vertex of each walk is connected here, so it does not count as specular.
  if (b == 0) {
    if (!is_luminaire(y.x.front())) return false;
    y.x.front().leaves_specularly = false;
    y.x.front().kind = PathVertex::Kind::luminaire;
    return complete(y);
  }
  for (const int end : {b - 1, b}) {
    ChainVertex& v = y.x[size_t(end)];
    v.leaves_specularly = false;
    if (v.on_surface() && !v.scatters_smoothly()) return false;
  }
  return complete(y) && visible(y, b - 1);
}

bool PathSpace::join(LightPath& y, const std::vector<ChainVertex>& rest, int r, ChoiceNumbers& choices) const {
  const int b = std::min(int(choices.next() * (r + 1)), r);
  const bool meets = y.x.empty() && b == 0;
  if (!walk(y.x, b, Transport::importance, choices, y)) return false;
  // The camera walk is in reverse order of the vertices.
  std::vector<ChainVertex> camera(rest.rbegin(), rest.rend());
  if (!walk(camera, r - b, Transport::radiance, choices, y, meets)) return false;
  const auto joins = [](const ChainVertex& v) { return !v.on_surface() || v.scatters_smoothly(); };
  if (!meets && !(joins(y.x.back()) && joins(camera.back()))) return false;
  const int joint = int(y.x.size()) - 1;
  y.x.insert(y.x.end(), camera.rbegin(), camera.rend());
  return complete(y) && (meets || visible(y, joint));
}

}  // namespace etendue
