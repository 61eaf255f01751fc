// Checks of every scene object: ray intersection, sampling by area, and the stated area describe the same surface. See also
// check_object_views.cpp.

#include <fmt/format.h>

#include "etendue/scene.h"
#include "etendue/shader.h"
#include "object_trial.h"
#include "statistics.h"

namespace etendue::conform {

std::string text_of(const Point3& p) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x, p.y, p.z); }
std::string text_of(const Vector3& v) { return text_of(Point3{} + v); }

namespace {

bool similar(const ObjectTrial& o) {
  const Transform t = o.object.transform.at(o.time);
  const float x = length(t(Vector3{1, 0, 0})), y = length(t(Vector3{0, 1, 0})), z = length(t(Vector3{0, 0, 1}));
  return std::abs(x - y) < 1e-4f * x && std::abs(x - z) < 1e-4f * x;
}

bool rays_agree(const ObjectTrial& o, const Ray& ray, float t) {
  const float off = 1e-3f * t;
  Hit hit;
  Ray other = ray;
  other.maximum = t - off;
  // Structures pass the nearest hit so far to one object after the other: a miss must not change it.
  hit.distance = -1;
  if (o.object.intersect(other, hit) || o.object.occludes(other)) return false;
  o.trial.expect(hit.distance == -1 && !hit.object && hit.depth == 0, "a miss leaves the hit unchanged", [&] {
    return fmt::format("from {} towards {}: t {}", text_of(ray.origin), text_of(ray.direction), hit.distance);
  });
  other.maximum = t + off;
  if (!o.object.intersect(other, hit) || std::abs(hit.distance - t) > off || !o.object.occludes(other)) return false;
  HitList list;
  o.object.all_hits(other, list);
  if (list.size == 0) return false;
  other.direction = 3 * ray.direction;
  other.maximum = infinity;
  return o.object.intersect(other, hit) && std::abs(3 * hit.distance - t) < off;
}

void check_hit(const ObjectTrial& o, const Ray& ray, const Hit& hit, const SurfacePoint& p) {
  const float off = o.slack(p.position) + 4 * p.error;
  const auto where = [&] {
    return fmt::format("from {} towards {}: t {}, at {}, normal {}, error {}", text_of(ray.origin), text_of(ray.direction),
                       hit.distance, text_of(p.position), text_of(Vector3(p.normal)), p.error);
  };
  o.trial.expect(hit.object && hit.distance > 0 && distance(p.position, ray(hit.distance)) < off,
                 "a hit's point lies on the ray", where);
  o.trial.expect(o.inside(o.bounds, p.position), "bounds hold all points", where);
  o.trial.expect(std::abs(length(Vector3(p.normal)) - 1) < 1e-4f && std::abs(length(Vector3(p.shading_normal)) - 1) < 1e-4f &&
                     dot(p.normal, Vector3(p.shading_normal)) >= 0 && p.error >= 0 && p.error < 0.01f * o.radius + off &&
                     std::isfinite(p.uv.x) && std::isfinite(p.uv.y),
                 "normals are unit vectors and errors small", where);
  if (scene_within(o.object)) return;
  o.trial.expect(p.object == &o.object && distance(o.object.transform.from_origin(o.time)(p.object_position), p.position) < off,
                 "object coordinates are those before the transform", where);
}

/// Isotropic lines through a ball of radius R cross a surface of area A within it A / (2 pi R^2) times on average (Crofton).
/// Also checks each hit, and that shorter, longer and scaled rays agree with it.
void check_lines(const ObjectTrial& o) {
  const float r = 1.05f * o.radius;
  statistics::Mean crossings;
  int disagree = 0, tested = 0, inward = 0;
  for (int i = o.trial.samples(30000); i > 0; --i) {
    const Vector3 d = o.trial.direction();
    const float across = r * std::sqrt(o.trial.uniform()), phi = 2 * pi * o.trial.uniform();
    Ray ray = o.ray(o.centre + Frame(Normal3(d)).to_world({across * std::cos(phi), across * std::sin(phi), -r}), d);
    int n = 0;
    for (Hit hit; n < 1000 && o.object.intersect(ray, hit); ++n) {
      const SurfacePoint p = o.located(ray, hit);
      if (n == 0) {
        ++tested;
        disagree += !rays_agree(o, ray, hit.distance);
        inward += dot(p.normal, d) > 0;
        check_hit(o, ray, hit, p);
      }
      p.leave(d, ray);
      hit = {};
    }
    if (n == 0) disagree += o.object.occludes(ray);
    crossings.add(n);
  }
  o.trial.expect(ObjectTrial::few(disagree, tested), "shorter, longer and scaled rays and occlusion agree with the hit",
                 [&] { return fmt::format("{} of {} do not", disagree, tested); });
  o.trial.expect(!o.object.closed() || inward <= tested / 2, "normals of a closed object point outwards",
                 [&] { return fmt::format("{} of {} first hits have one that points inwards", inward, tested); });
  const double scale = 2 * M_PI * double(r) * double(r), found = scale * crossings.mean(), said = double(o.object.area(o.time));
  o.trial.expect(
      std::abs(found - said) <
              scale * (Trial::significant_errors * crossings.error() + 10 / double(crossings.count())) + 1e-3 * said ||
          (scene_within(o.object) && !similar(o)),
      "the area is that which lines find",
      [&] { return fmt::format("{} m^2, but {} ± {} by lines", said, found, scale * crossings.error()); });
}

/// Whether a short ray towards a point of the surface hits it, perhaps after other parts of the surface, and finds the same
/// normal.
bool found_nearby(const ObjectTrial& o, const SurfacePoint& p) {
  Vector3 away = o.trial.direction();
  if (std::abs(dot(p.normal, away)) < 0.2f) away = normalize(away + 0.5f * Vector3(p.normal));
  const float h = 0.02f * o.radius, off = o.slack(p.position) + 8 * p.error;
  Ray ray = o.ray(p.position + h * away, -away, 2 * h);
  for (int i = 0; i < 100; ++i) {
    Hit hit;
    if (!o.object.intersect(ray, hit)) return false;
    const SurfacePoint q = o.located(ray, hit);
    if (distance(q.position, p.position) < off + 0.01f * h && dot(q.normal, Vector3(p.normal)) > 0.99f) return true;
    q.leave(-away, ray);
    ray.maximum = 2 * h;
  }
  return false;
}

void check_points(const ObjectTrial& o) {
  const auto [lit, cone] = o.object.luminaire_bounds();
  statistics::Mean area;
  int missed = 0;
  const int n = o.trial.samples(20000);
  for (int i = 0; i < n; ++i) {
    const SurfaceSample s = o.sample_area();
    const SurfacePoint& p = s.point;
    const auto where = [&] {
      return fmt::format("{}, normal {}, density {}", text_of(p.position), text_of(Vector3(p.normal)), s.pdf);
    };
    if (!o.trial.expect(
            s.pdf > 0 && s.pdf < infinity && !s.delta && !s.infinite && p.object == &o.object && is_finite(p.position),
            "points by area are finite and have a density", where))
      return;
    o.trial.expect(std::abs(o.object.area_pdf(p) - s.pdf) < 1e-3f * s.pdf, "a sample's density by area is that of its point",
                   where);
    o.trial.expect(o.inside(o.bounds, p.position) && o.inside(lit, p.position), "bounds hold all points", where);
    o.trial.expect(dot(cone.axis, Vector3(p.normal)) >= cone.cosine - 1e-4f, "the cone of normals holds them", where);
    area.add(1 / double(s.pdf));
    missed += !found_nearby(o, p);
  }
  const double said = double(o.object.area(o.time));
  // Next to an edge a ray may hit the neighbouring face.
  o.trial.expect(ObjectTrial::few(missed, n, 5e-3), "rays find the points that were sampled by area",
                 [&] { return fmt::format("{} of {} were not found", missed, n); });
  o.trial.expect(std::abs(area.mean() - said) < Trial::significant_errors * area.error() + 1e-3 * said,
                 "densities by area integrate to 1 over the area",
                 [&] { return fmt::format("mean of 1 / density {} ± {} m^2, area {} m^2", area.mean(), area.error(), said); });
}

/// Whether some of the surface is very near, or all of it is seen edge on.
bool too_near(const ObjectTrial& o, const Point3& from) {
  for (int i = 0; i < 1000; ++i)
    if (o.object.occludes(o.ray(from, o.trial.direction(), 0.02f * o.radius))) return true;
  float cosine = 0;
  for (int i = 0; i < 100; ++i) {
    const SurfacePoint p = o.sample_area().point;
    cosine = std::max(cosine, std::abs(dot(p.normal, normalize(p.position - from))));
  }
  return cosine < 0.02f;
}

void check_scene_object(Trial& trial) {
  const SceneObject& object = trial.part<SceneObject>();
  if (object.unbounded()) {  // it has no area and no bounding box, and points cannot be sampled on it
    trial.expect(!(object.sample_area(trial.pair(), 0).pdf > 0), "on what has no end no points are chosen");
    return;
  }
  if (object.infinite() || object.delta() || object.bounds().empty()) {
    trial.expect(object.bounds().empty(), "what has no extent or lies at infinity has no bounds");
    return;
  }
  const ObjectTrial o(trial, object);
  trial.expect(is_finite(o.bounds.low) && is_finite(o.bounds.high) && o.radius > 0, "bounds are finite",
               [&] { return text_of(o.bounds.low) + " .. " + text_of(o.bounds.high); });
  check_lines(o);
  if (scene_within(object)) return;  // a scene is no luminaire: no points are chosen on it
  if (!(object.area(o.time) > 0)) {  // an empty solid: the line test above found area 0 too
    trial.expect(!(o.sample_area().pdf > 0), "on what has no area no points are chosen");
    return;
  }
  check_points(o);
  check_tangents(o);
  for (const float away : {0.3f, 1.2f, 4.0f, 40.0f}) {
    // Not directly at the surface nor in the plane of a flat object, where sample_visible may have an arbitrarily large
    // variance.
    Point3 from = o.centre + away * o.radius * trial.direction();
    for (int i = 0; i < 20 && too_near(o, from); ++i) from = o.centre + away * o.radius * trial.direction();
    check_seen_from(o, from);
  }
  check_moved(o);
}

const RegisterCheck<SceneObject> registered(check_scene_object);

}  // namespace
}  // namespace etendue::conform
