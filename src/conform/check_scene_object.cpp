// What holds of every scene object: one surface, whether rays meet it, points are chosen on it or areas are told.

#include <fmt/format.h>

#include "conform/conformance.h"
#include "conform/statistics.h"
#include "etendue/scene.h"
#include "etendue/shader.h"

namespace etendue::conform {
namespace {

std::string text_of(const Point3& p) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x, p.y, p.z); }
std::string text_of(const Vector3& v) { return text_of(Point3{} + v); }

/// What may be off by rounding or at borders: so many of n.
bool few(int wrong, int n, double share = 1e-3) { return wrong <= 3 + int(share * n); }

class ObjectTrial {
 public:
  ObjectTrial(Trial& t, const SceneObject& object)
      : trial(t),
        object_(object),
        bounds_(object.bounds()),
        centre_(bounds_.centre()),
        radius_(length(bounds_.diagonal()) / 2),
        time_(t.uniform()) {}

  void check() {
    trial.expect(is_finite(bounds_.low) && is_finite(bounds_.high) && radius_ > 0, "bounds are finite",
                 [&] { return text_of(bounds_.low) + " .. " + text_of(bounds_.high); });
    check_lines();
    if (dynamic_cast<const Scene*>(&object_)) return;  // a scene is no luminaire: no points are chosen on it
    check_points();
    check_tangents();
    for (const float away : {0.3f, 1.2f, 4.0f, 40.0f}) check_visible(centre_ + away * radius_ * trial.direction());
    check_moved();
  }

 private:
  float slack(const Point3& p) const { return 1e-4f * radius_ + 1e-5f * length(p - Point3{}); }
  bool in_bounds(const Bounds3& box, const Point3& p) const {
    const float s = slack(p);
    for (int i = 0; i < 3; ++i)
      if (!(p[i] >= box.low[i] - s && p[i] <= box.high[i] + s)) return false;
    return true;
  }
  SurfacePoint located(const Ray& ray, const Hit& hit) const {
    SurfacePoint p;
    object_.surface_point(ray, hit, p);
    return p;
  }
  Ray ray_of(const Point3& from, const Vector3& direction, float maximum = infinity) const {
    Ray ray;
    ray.origin = from;
    ray.direction = direction;
    ray.maximum = maximum;
    ray.time = time_;
    return ray;
  }

  /// Isotropic lines through a ball of radius R cross a surface of area A within it A / (2 pi R^2) times on average (Crofton).
  /// On the way: what a hit must be, and that shorter, longer and scaled rays agree.
  void check_lines() {
    const float r = 1.05f * radius_;
    statistics::Mean crossings;
    int disagree = 0, tested = 0;
    for (int i = trial.samples(30000); i > 0; --i) {
      const Vector3 d = trial.direction();
      const float across = r * std::sqrt(trial.uniform()), phi = 2 * pi * trial.uniform();
      Ray ray = ray_of(centre_ + Frame(Normal3(d)).to_world({across * std::cos(phi), across * std::sin(phi), -r}), d);
      int n = 0;
      for (Hit hit; n < 1000 && object_.intersect(ray, hit); ++n) {
        const SurfacePoint p = located(ray, hit);
        if (n == 0) {
          ++tested;
          disagree += !rays_agree(ray, hit.distance);
          check_hit(ray, hit, p);
        }
        p.leave(d, ray);
        hit = {};
      }
      if (n == 0) disagree += object_.occludes(ray);
      crossings.add(n);
    }
    trial.expect(few(disagree, tested), "shorter, longer and scaled rays and occlusion agree with the hit",
                 [&] { return fmt::format("{} of {} do not", disagree, tested); });
    const double scale = 2 * M_PI * double(r) * double(r), found = scale * crossings.mean(), said = double(object_.area(time_));
    trial.expect(
        std::abs(found - said) <
                scale * (Trial::significant_errors * crossings.error() + 10 / double(crossings.count())) + 1e-3 * said ||
            (dynamic_cast<const Scene*>(&object_) && !similar()),
        "the area is that which lines find",
        [&] { return fmt::format("{} m^2, but {} ± {} by lines", said, found, scale * crossings.error()); });
  }

  bool similar() const {
    const Transform t = object_.transform.at(time_);
    const float x = length(t(Vector3{1, 0, 0})), y = length(t(Vector3{0, 1, 0})), z = length(t(Vector3{0, 0, 1}));
    return std::abs(x - y) < 1e-4f * x && std::abs(x - z) < 1e-4f * x;
  }

  bool rays_agree(const Ray& ray, float t) {
    const float off = 1e-3f * t;
    Hit hit;
    Ray other = ray;
    other.maximum = t - off;
    if (object_.intersect(other, hit) || object_.occludes(other)) return false;
    other.maximum = t + off;
    if (!object_.intersect(other, hit) || std::abs(hit.distance - t) > off || !object_.occludes(other)) return false;
    HitList list;
    object_.all_hits(other, list);
    if (list.size == 0) return false;
    other.direction = 3 * ray.direction;
    other.maximum = infinity;
    return object_.intersect(other, hit) && std::abs(3 * hit.distance - t) < off;
  }

  void check_hit(const Ray& ray, const Hit& hit, const SurfacePoint& p) {
    const float off = slack(p.position) + 4 * p.error;
    const auto where = [&] {
      return fmt::format("from {} towards {}: t {}, at {}, normal {}, error {}", text_of(ray.origin), text_of(ray.direction),
                         hit.distance, text_of(p.position), text_of(Vector3(p.normal)), p.error);
    };
    trial.expect(hit.object && hit.distance > 0 && distance(p.position, ray(hit.distance)) < off,
                 "a hit's point lies on the ray", where);
    trial.expect(in_bounds(bounds_, p.position), "bounds hold all points", where);
    trial.expect(std::abs(length(Vector3(p.normal)) - 1) < 1e-4f && std::abs(length(Vector3(p.shading_normal)) - 1) < 1e-4f &&
                     dot(p.normal, Vector3(p.shading_normal)) >= 0 && p.error >= 0 && p.error < 0.01f * radius_ + off &&
                     std::isfinite(p.uv.x) && std::isfinite(p.uv.y),
                 "normals are unit vectors and errors small", where);
    if (dynamic_cast<const Scene*>(&object_)) return;
    trial.expect(p.object == &object_ && distance(object_.transform.at(time_)(p.object_position), p.position) < off,
                 "object coordinates are those before the transform", where);
  }

  SurfaceSample sample_area() { return object_.sample_area(trial.pair(), time_); }

  void check_points() {
    const Bounds3 lit = object_.luminaire_bounds();
    const NormalCone cone = object_.normals();
    statistics::Mean area;
    int missed = 0;
    const int n = trial.samples(20000);
    for (int i = 0; i < n; ++i) {
      const SurfaceSample s = sample_area();
      const SurfacePoint& p = s.point;
      const auto where = [&] {
        return fmt::format("{}, normal {}, density {}", text_of(p.position), text_of(Vector3(p.normal)), s.density);
      };
      if (!trial.expect(
              s.density > 0 && s.density < infinity && !s.delta && !s.infinite && p.object == &object_ && is_finite(p.position),
              "points by area are finite and have a density", where))
        return;
      trial.expect(std::abs(object_.area_density(p) - s.density) < 1e-3f * s.density,
                   "a sample's density by area is that of its point", where);
      trial.expect(in_bounds(bounds_, p.position) && in_bounds(lit, p.position), "bounds hold all points", where);
      trial.expect(dot(cone.axis, Vector3(p.normal)) >= cone.cosine - 1e-4f, "the cone of normals holds them", where);
      area.add(1 / double(s.density));
      missed += !found_nearby(p);
    }
    const double said = double(object_.area(time_));
    trial.expect(few(missed, n), "rays find the points that were sampled by area",
                 [&] { return fmt::format("{} of {} were not found", missed, n); });
    trial.expect(std::abs(area.mean() - said) < Trial::significant_errors * area.error() + 1e-3 * said,
                 "densities by area integrate to 1 over the area",
                 [&] { return fmt::format("mean of 1 / density {} ± {} m^2, area {} m^2", area.mean(), area.error(), said); });
  }

  /// A short ray towards a point meets the surface there, perhaps after other parts of it, and finds the same normal.
  bool found_nearby(const SurfacePoint& p) {
    Vector3 away = trial.direction();
    if (std::abs(dot(p.normal, away)) < 0.2f) away = normalize(away + 0.5f * Vector3(p.normal));
    const float h = 0.02f * radius_, off = slack(p.position) + 8 * p.error;
    Ray ray = ray_of(p.position + h * away, -away, 2 * h);
    for (int i = 0; i < 100; ++i) {
      Hit hit;
      if (!object_.intersect(ray, hit)) return false;
      const SurfacePoint q = located(ray, hit);
      if (distance(q.position, p.position) < off + 0.01f * h && dot(q.normal, Vector3(p.normal)) > 0.99f) return true;
      q.leave(-away, ray);
      ray.maximum = 2 * h;
    }
    return false;
  }

  /// dpdu and dpdv span the surface, and tell where a point with slightly other coordinates lies.
  void check_tangents() {
    int wrong = 0, tested = 0;
    const float step = 4e-3f * radius_;
    for (int i = trial.samples(4000); i > 0; --i) {
      const SurfacePoint start = sample_area().point;
      const auto down = [&](const Point3& over, SurfacePoint& p) {
        Hit hit;
        const Ray ray = ray_of(over + step * Vector3(start.normal), -Vector3(start.normal), 2 * step);
        if (!object_.intersect(ray, hit)) return false;
        p = located(ray, hit);
        return true;
      };
      SurfacePoint a, b;
      const float phi = 2 * pi * trial.uniform();
      const Frame frame(start.normal);
      if (!down(start.position, a) || !down(start.position + step * (std::cos(phi) * frame.s + std::sin(phi) * frame.t), b))
        continue;
      const float du = b.uv.x - a.uv.x, dv = b.uv.y - a.uv.y;
      if (a.primitive != b.primitive || std::abs(du) > 0.3f || std::abs(dv) > 0.3f || (du == 0 && dv == 0)) continue;  // a seam
      object_.tangents(a);
      const bool spans = is_finite(a.dpdu) && is_finite(a.dpdv) &&
                         trial.expect(std::abs(dot(a.normal, a.dpdu)) < 2e-3f * length(a.dpdu) &&
                                          std::abs(dot(a.normal, a.dpdv)) < 2e-3f * length(a.dpdv),
                                      "tangents lie in the surface", [&] {
                                        return fmt::format("at {}, normal {}: dpdu {}, dpdv {}", text_of(a.position),
                                                           text_of(Vector3(a.normal)), text_of(a.dpdu), text_of(a.dpdv));
                                      });
      const Vector3 moved = b.position - a.position;
      ++tested;
      wrong += !spans || length(du * a.dpdu + dv * a.dpdv - moved) > 0.06f * length(moved);
    }
    trial.expect(few(wrong, tested, 0.03), "tangents are the change of position with surface coordinates",
                 [&] { return fmt::format("{} of {} steps lead elsewhere", wrong, tested); });
  }

  /// In eight cells around the direction to the middle, by angle and azimuth: the solid angle in which the object is seen, by
  /// rays, and by points sampled to be seen from there, as the mean of 1 / density of those that are.
  void check_visible(const Point3& from) {
    constexpr size_t cells = 8;
    const Vector3 to = centre_ - from;
    const float d = length(to), sine = 1.02f * radius_ / d;
    const bool around = sine >= 1;
    const float height = around ? 2 : sine * sine / (1 + std::sqrt(1 - sine * sine));  // 1 - cos of the ball's angle
    const Frame frame(Normal3(to / d));
    const auto cell = [&](const Vector3& v) {
      const float h = length_squared(v - Vector3(frame.n)) / 2;
      return size_t(2 * int(dot(v, frame.s) > 0) + int(dot(v, frame.t) > 0) + (h > height / 4 ? 4 : 0));
    };
    std::array<statistics::Mean, cells> rays, samples;
    const int n = trial.samples(40000);
    for (int i = 0; i < n; ++i) {
      const float h = height * trial.uniform(), phi = 2 * pi * trial.uniform(), r = safe_sqrt(h * (2 - h));
      const Vector3 v = frame.to_world({r * std::cos(phi), r * std::sin(phi), 1 - h});
      const size_t hit = object_.occludes(ray_of(from, v)) ? cell(v) : cells;
      for (size_t k = 0; k < cells; ++k) rays[k].add(k == hit ? 2 * M_PI * double(height) : 0);
    }
    int disagree = 0, behind = 0;
    for (int i = 0; i < n; ++i) {
      const SurfaceSample s = object_.sample_visible(from, trial.pair(), time_);
      size_t seen = cells;
      double value = 0;
      if (s.density > 0) {
        const SurfacePoint& p = s.point;
        const auto where = [&] {
          return fmt::format("from {} to {}: direction {}, distance {}, density {}", text_of(from), text_of(p.position),
                             text_of(s.direction), s.distance, s.density);
        };
        trial.expect(s.density < infinity && std::abs(length(s.direction) - 1) < 1e-4f && !s.delta && !s.infinite &&
                         distance(from + s.distance * s.direction, p.position) < slack(p.position) + 1e-4f * s.distance,
                     "points to be seen lie where their direction and distance say", where);
        const float again = object_.visible_density(from, s.direction, p);
        disagree += !(std::abs(again - s.density) < 1e-2f * s.density) && std::abs(dot(p.normal, s.direction)) > 1e-2f;
        Hit hit;
        const float off = 1e-3f * s.distance + 4 * p.error;
        if (object_.intersect(ray_of(from, s.direction), hit) && hit.distance < s.distance + off) {
          if (hit.distance > s.distance - off) {
            seen = cell(s.direction);
            value = 1 / double(s.density);
          }
        } else {
          ++behind;
        }
      }
      for (size_t k = 0; k < cells; ++k) samples[k].add(k == seen ? value : 0);
    }
    const std::string place = fmt::format("from {} ({:.2f} radii away)", text_of(from), d / radius_);
    trial.expect(few(behind, n, 5e-3), "rays find the points that were sampled to be seen",
                 [&] { return fmt::format("{}: {} of {} were not found", place, behind, n); });
    trial.expect(few(disagree, n), "the density of a point seen is that of its sample",
                 [&] { return fmt::format("{}: {} of {} differ", place, disagree, n); });
    for (size_t k = 0; k < cells; ++k) {
      const double margin = Trial::significant_errors * std::hypot(rays[k].error(), samples[k].error()) +
                            10 * (rays[k].largest() + samples[k].largest()) / n + 3e-3 * rays[k].mean();
      trial.expect(std::abs(rays[k].mean() - samples[k].mean()) < margin,
                   "points sampled to be seen have densities of the solid angle seen", [&] {
                     return fmt::format("{}, cell {}: {:.5g} ± {:.2g} sr by rays, {:.5g} ± {:.2g} sr by samples", place, k,
                                        rays[k].mean(), rays[k].error(), samples[k].mean(), samples[k].error());
                   });
    }
  }

  /// A copy that is moved, turned and enlarged is the same, moved, turned and enlarged.
  void check_moved() {
    if (object_.transform.animated()) return;
    const float scale = 1.7f;
    const Transform by = Transform::translate({1, -2, 0.5f}) * Transform::rotate(1.1f, {1, 0.3f, -0.7f}) *
                         Transform::scale({scale, scale, scale});
    const Ref<SceneObject> moved = ref_cast<SceneObject>(copy(object_));
    moved->transform = by * object_.transform.still();
    moved->prepare();
    const float area = object_.area(time_);
    trial.expect(std::abs(moved->area(time_) / area - scale * scale) < 1e-3f, "a moved copy is the same elsewhere", [&] {
      return fmt::format("area {} m^2 becomes {} m^2 at {} times the size", area, moved->area(time_), scale);
    });
    int wrong = 0;
    const int n = trial.samples(2000);
    for (int i = 0; i < n; ++i) {
      const Point2 u = trial.pair();
      const SurfacePoint a = object_.sample_area(u, time_).point, b = moved->sample_area(u, time_).point;
      Hit near, far;
      const Point3 from = a.position + 0.5f * radius_ * trial.direction();
      const Ray ray = ray_of(from, normalize(a.position - from));
      Ray other = ray;
      other.origin = by(ray.origin);
      other.direction = by(ray.direction);
      const bool hit = object_.intersect(ray, near), hit_moved = moved->intersect(other, far);
      wrong += distance(by(a.position), b.position) > 10 * slack(b.position) ||
               dot(normalize(by(a.normal)), Vector3(b.normal)) < 0.999f || hit != hit_moved ||
               (hit && std::abs(near.distance - far.distance) > 0.01f * near.distance);
    }
    trial.expect(few(wrong, n, 5e-3), "a moved copy is the same elsewhere",
                 [&] { return fmt::format("{} of {} points or rays differ", wrong, n); });
  }

  Trial& trial;
  const SceneObject& object_;
  Bounds3 bounds_;
  Point3 centre_;
  float radius_, time_;
};

}  // namespace

void check_scene_object(Trial& trial) {
  const SceneObject& object = trial.part<SceneObject>();
  if (object.infinite() || object.delta() || object.bounds().empty()) {
    trial.expect(object.bounds().empty(), "what has no extent or lies at infinity has no bounds");
    return;
  }
  ObjectTrial(trial, object).check();
}

}  // namespace etendue::conform
