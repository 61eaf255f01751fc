// Checks of every scene object: the solid angle in which it is seen, its tangents, and moved copies. See also
// check_scene_object.cpp.

#include <fmt/format.h>

#include "etendue/describe/registry.h"
#include "etendue/shader.h"
#include "object_trial.h"
#include "statistics.h"

namespace etendue::conform {

/// Measures the solid angle in which the object is seen from a point, in eight cells of angle and azimuth around the direction
/// to its centre: by rays, and by points of sample_visible as the mean of 1 / pdf of those that are visible.
void check_seen_from(const ObjectTrial& o, const Point3& from) {
  constexpr size_t cells = 8;
  const Vector3 to = o.centre - from;
  const float d = length(to), sine = 1.02f * o.radius / d;
  const bool around = sine >= 1;
  const float height =
      around ? 2 : sine * sine / (1 + std::sqrt(1 - sine * sine));  // 1 - cos of the half-angle of the bounding sphere
  const Frame frame(Normal3(to / d));
  const auto cell = [&](const Vector3& v) {
    const float h = length_squared(v - Vector3(frame.n)) / 2;
    return size_t(2 * int(dot(v, frame.s) > 0) + int(dot(v, frame.t) > 0) + (h > height / 4 ? 4 : 0));
  };
  // Of a luminaire only what emits counts: sample_visible need not choose points on a dark side.
  const auto shines = [&](const SurfacePoint& p, const Vector3& v) {
    return !o.object.emission || o.object.emission->emits(p, -v);
  };
  const auto meets = [&](const Vector3& v) {
    const Ray ray = o.ray(from, v);
    if (!o.object.emission) return o.object.occludes(ray);
    Hit hit;
    return o.object.intersect(ray, hit) && shines(o.located(ray, hit), v);
  };
  std::array<statistics::Mean, cells> rays, samples;
  const int n = o.trial.samples(40000);
  for (int i = 0; i < n; ++i) {
    const float h = height * o.trial.uniform(), phi = 2 * pi * o.trial.uniform(), r = safe_sqrt(h * (2 - h));
    const Vector3 v = frame.to_world({r * std::cos(phi), r * std::sin(phi), 1 - h});
    const size_t hit = meets(v) ? cell(v) : cells;
    for (size_t k = 0; k < cells; ++k) rays[k].add(k == hit ? 2 * M_PI * double(height) : 0);
  }
  int disagree = 0, behind = 0;
  for (int i = 0; i < n; ++i) {
    const SurfaceSample s = o.object.sample_visible(from, o.trial.pair(), o.time);
    size_t seen = cells;
    double value = 0;
    if (s.pdf > 0) {
      const SurfacePoint& p = s.point;
      const auto where = [&] {
        return fmt::format("from {} to {}: direction {}, distance {}, density {}", text_of(from), text_of(p.position),
                           text_of(s.direction), s.distance, s.pdf);
      };
      o.trial.expect(s.pdf < infinity && std::abs(length(s.direction) - 1) < 1e-4f && !s.delta && !s.infinite &&
                         distance(from + s.distance * s.direction, p.position) < o.slack(p.position) + 1e-4f * s.distance,
                     "points to be seen lie where their direction and distance say", where);
      const float again = o.object.visible_pdf(from, s.direction, p);
      disagree += !(std::abs(again - s.pdf) < 1e-2f * s.pdf) && std::abs(dot(p.normal, s.direction)) > 1e-2f;
      Hit hit;
      const float off = 1e-4f * s.distance + 4 * p.error;
      if (!shines(p, s.direction)) {
        // a sample on a side that does not emit
      } else if (o.object.intersect(o.ray(from, s.direction), hit) && hit.distance < s.distance + off) {
        // Another part of the object may lie in front of the point.
        if (hit.distance > s.distance - (hit.primitive == p.primitive ? off : 1e-6f * s.distance + p.error)) {
          seen = cell(s.direction);
          value = 1 / double(s.pdf);
        }
      } else if (std::abs(dot(p.normal, s.direction)) > 1e-2f) {  // for a thin object seen edge on, rounding decides
        ++behind;
      }
    }
    for (size_t k = 0; k < cells; ++k) samples[k].add(k == seen ? value : 0);
  }
  const std::string place = fmt::format("from {} ({:.2f} radii away)", text_of(from), d / o.radius);
  o.trial.expect(ObjectTrial::few(behind, n, 5e-3), "rays find the points that were sampled to be seen",
                 [&] { return fmt::format("{}: {} of {} were not found", place, behind, n); });
  o.trial.expect(ObjectTrial::few(disagree, n), "the density of a point seen is that of its sample",
                 [&] { return fmt::format("{}: {} of {} differ", place, disagree, n); });
  for (size_t k = 0; k < cells; ++k) {
    const double margin = Trial::significant_errors * std::hypot(rays[k].error(), samples[k].error()) +
                          10 * (2 * M_PI * double(height) + samples[k].largest()) / n + 3e-3 * rays[k].mean();
    o.trial.expect(std::abs(rays[k].mean() - samples[k].mean()) <= margin,
                   "points sampled to be seen have densities of the solid angle seen", [&] {
                     return fmt::format("{}, cell {}: {:.5g} ± {:.2g} sr by rays, {:.5g} ± {:.2g} sr by samples", place, k,
                                        rays[k].mean(), rays[k].error(), samples[k].mean(), samples[k].error());
                   });
  }
}

namespace {

/// Finds two points of the surface about a step apart. `off` is the relative error of the displacement that the tangents at the
/// first point predict from the difference of uv. False: a point was not found, or a seam of the coordinates lies between them.
bool step_off(const ObjectTrial& o, const SurfacePoint& start, float phi, float step, SurfacePoint& a, float& off) {
  const auto down = [&](const Point3& over, SurfacePoint& p) {
    Hit hit;
    const Ray ray = o.ray(over + step * Vector3(start.normal), -Vector3(start.normal), 2 * step);
    if (!o.object.intersect(ray, hit)) return false;
    p = o.located(ray, hit);
    return true;
  };
  SurfacePoint b;
  const Frame frame(start.normal);
  if (!down(start.position, a) || !down(start.position + step * (std::cos(phi) * frame.s + std::sin(phi) * frame.t), b))
    return false;
  const float du = b.uv.x - a.uv.x, dv = b.uv.y - a.uv.y;
  if (a.primitive != b.primitive || std::abs(du) > 0.3f || std::abs(dv) > 0.3f || (du == 0 && dv == 0)) return false;
  o.object.tangents(a);
  const Vector3 moved = b.position - a.position;
  off = length(du * a.dpdu + dv * a.dpdv - moved) / length(moved);
  return true;
}

/// Whether `tangents` finds the same for a point that has lost them, as maps need that compare a point with what it was before
/// the transforms of instances.
bool found_again(const ObjectTrial& o, const SurfacePoint& p) {
  SurfacePoint bare = p;
  bare.dpdu = bare.dpdv = {};
  o.object.tangents(bare);
  return length(bare.dpdu - p.dpdu) <= 1e-2f * length(p.dpdu) && length(bare.dpdv - p.dpdv) <= 1e-2f * length(p.dpdv);
}

}  // namespace

/// Checks that dpdu and dpdv are tangent and that they predict where a point with slightly different coordinates lies. At the
/// distance d from a pole of the coordinates, or where the surface bends within d, the relative error of this prediction for a
/// step h is about h / d: smaller steps have smaller errors if the tangents are right. On the flat sides of a long ellipsoid a
/// few per cent of all points are so near to a pole that the error for a step of a thousandth of its length exceeds `largest`.
void check_tangents(const ObjectTrial& o) {
  constexpr float largest = 0.06f;
  int wrong = 0, lost = 0, tested = 0;
  for (int i = o.trial.samples(4000); i > 0; --i) {
    const SurfacePoint start = o.sample_area().point;
    const float phi = 2 * pi * o.trial.uniform(), first = 1e-3f * o.radius;
    float off = 0;
    SurfacePoint a;
    if (!step_off(o, start, phi, first, a, off)) continue;
    ++tested;
    lost += !found_again(o, a);
    const bool spans = is_finite(a.dpdu) && is_finite(a.dpdv) &&
                       o.trial.expect(std::abs(dot(a.normal, a.dpdu)) < 2e-3f * length(a.dpdu) &&
                                          std::abs(dot(a.normal, a.dpdv)) < 2e-3f * length(a.dpdv),
                                      "tangents lie in the surface", [&] {
                                        return fmt::format("at {}, normal {}: dpdu {}, dpdv {}", text_of(a.position),
                                                           text_of(Vector3(a.normal)), text_of(a.dpdu), text_of(a.dpdv));
                                      });
    // Below a certain step size rounding errors dominate.
    for (float step = first / 4; !(off < largest) && step > std::max(first / 64, 100 * a.error); step /= 4)
      if (!step_off(o, start, phi, step, a, off)) break;
    wrong += !spans || !(off < largest);
  }
  o.trial.expect(ObjectTrial::few(wrong, tested, 0.01), "tangents are the change of position with surface coordinates",
                 [&] { return fmt::format("{} of {} steps lead elsewhere", wrong, tested); });
  o.trial.expect(ObjectTrial::few(lost, tested, 0.01), "tangents are found again for a point without them",
                 [&] { return fmt::format("{} of {} points get none, or others", lost, tested); });
}

/// A copy that is translated, rotated and scaled must give the same hits, transformed.
void check_moved(const ObjectTrial& o) {
  if (o.object.transform.animated()) return;
  const float scale = 1.7f;
  const Transform by =
      Transform::translate({1, -2, 0.5f}) * Transform::rotate(1.1f, {1, 0.3f, -0.7f}) * Transform::scale({scale, scale, scale});
  const Ref<SceneObject> moved = ref_cast<SceneObject>(copy(o.object));
  moved->transform = by * o.object.transform.keys().front().transform;
  prepare_tree(*moved);
  const float area = o.object.area(o.time);
  o.trial.expect(std::abs(moved->area(o.time) / area - scale * scale) < 1e-3f, "a moved copy is the same elsewhere", [&] {
    return fmt::format("area {} m^2 becomes {} m^2 at {} times the size", area, moved->area(o.time), scale);
  });
  int wrong = 0;
  const int n = o.trial.samples(2000);
  for (int i = 0; i < n; ++i) {
    const Point3 to = o.sample_area().point.position, from = to + 0.5f * o.radius * o.trial.direction();
    const Ray ray = o.ray(from, normalize(to - from));
    Ray other = ray;
    other.origin = by(ray.origin);
    other.direction = by(ray.direction);
    Hit near, far;
    const bool hit = o.object.intersect(ray, near);
    if (hit != moved->intersect(other, far)) ++wrong;
    if (!hit || !far) continue;
    const SurfacePoint a = o.located(ray, near);
    SurfacePoint b;
    moved->surface_point(other, far, b);
    wrong += distance(by(a.position), b.position) > 10 * o.slack(b.position) ||
             dot(normalize(by(a.normal)), Vector3(b.normal)) < 0.999f ||
             distance(a.object_position, b.object_position) > 10 * o.slack(a.object_position) + 1e-3f * o.radius;
  }
  o.trial.expect(ObjectTrial::few(wrong, n, 5e-3), "a moved copy is the same elsewhere",
                 [&] { return fmt::format("{} of {} rays differ", wrong, n); });
}

}  // namespace etendue::conform
