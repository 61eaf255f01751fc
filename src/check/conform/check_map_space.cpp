// Checks of every object map: in which space it reads a point. Its values do not depend on the origin of rendering space, which
// the program chooses; a map with a member `space` or `world` follows the object or stays in the world accordingly; and it
// computes the tangents that it reads.

#include <fmt/format.h>

#include <optional>

#include "etendue/scene_object.h"
#include "geometry/geometry.h"
#include "geometry/scene_record.h"
#include "map_trial.h"
#include "shader_trial.h"

namespace etendue::conform {
namespace {

/// An object of a class; `origin` is the origin of rendering space, in world space.
Ref<SceneObject> placed_object(const char* name, const Transform& transform, const DoublePoint3& origin = {}) {
  Ref<SceneObject> object = ref_cast<SceneObject>(Registry::instance().create(name));
  object->transform = transform;
  object->transform.set_origins(origin, {});
  scene_record(*object).rendering_origin = origin;
  object->prepare();
  return object;
}

/// Whether the map reads positions in world space, according to its members; empty: they do not say.
std::optional<bool> in_world(const ObjectMap& map) {
  if (map.class_info().find("space")) {
    const Value space = get(map, "space");
    if (const auto* text = space.as<std::string>()) return *text == "world";
  }
  if (map.class_info().find("world")) {
    const Value world = get(map, "world");
    if (const bool* yes = world.as<bool>()) return *yes;
  }
  return std::nullopt;
}

/// Whether some of the map's members are maps that vary, which may be in spaces of their own.
bool has_varying_inputs(const ObjectMap& map) {
  const auto varies = [](const Value& value) {
    const auto* part = value.as<Ref<Component>>();
    const Ref<ObjectMap> inner = part && *part ? ref_cast<ObjectMap>(*part) : nullptr;
    return inner && !inner->constant();
  };
  for (const Member& m : map.class_info().members) {
    if (m.kind != Kind::component) continue;
    const Value value = get(map, m.name);
    const auto* list = value.as<Value::List>();
    if (list ? std::ranges::any_of(*list, varies) : varies(value)) return true;
  }
  return false;
}

class SpaceTrial {
 public:
  SpaceTrial(Trial& t, const ObjectMap& map) : trial(t), map_(map), said_(in_world(map)), alone_(!has_varying_inputs(map)) {}

  void check() {
    for (const char* name : {"Rectangle", "Sphere"}) check_on(name);
    expect_few(by_origin_, "a value does not depend on the origin of rendering space");
    if (said_ && alone_)
      expect_few(by_place_, *said_ ? "in world space a value does not depend on the object's own coordinates"
                                   : "in the object's own space a value moves with the object");
    expect_few(by_tangents_, "a value is the same for a point with and without tangents");
  }

 private:
  /// How many of the points compared have different values, and the first of them.
  struct Comparison {
    int different = 0, tested = 0;
    std::string first;
  };

  void check_on(const char* name) {
    const Transform place = Transform::translate({0.5, 1, -0.3}) * Transform::rotate(1, {1, 0.5, 2}) *
                            Transform::scale({2, 2, trial.uniform() < 0.5f ? 2.0 : 0.7});
    const Transform by = Transform::translate({-1.3, 0.7, 2.1}) * Transform::rotate(2, {0.3, 1, -0.4});
    const auto some = [&] { return double(lerp(trial.uniform(), -8, 8)); };
    const double x = some(), y = some(), z = some();
    const Ref<SceneObject> object = placed_object(name, place), far = placed_object(name, place, {x, y, z}),
                           moved = placed_object(name, by * place);
    for (int i = trial.samples(400); i > 0; --i) {
      SurfacePoint p = object->sample_area(trial.pair(), 0).point;
      p.dpdu = p.dpdv = {};
      compare_places(p, *moved);
      if (trial.uniform() < 0.7f) {
        p.ray_direction = trial.direction();
        p.footprint = std::exp(lerp(trial.uniform(), -9, 1));
        p.footprint_cosine = std::abs(dot(p.normal, p.ray_direction));
      }
      SurfacePoint q = p;
      object->tangents(q);
      compare(p, q, by_tangents_);
      q.object = far.get();
      q.position = Point3(DoublePoint3(p.position) - (far->rendering_origin() - DoublePoint3{}));
      compare(p, q, by_origin_);
    }
  }

  /// The same point of the moved object, or another point of it that is at the same place in the world.
  void compare_places(const SurfacePoint& p, const SceneObject& moved) {
    if (!said_ || !alone_) return;
    const Transform& t = moved.transform.still();
    SurfacePoint q = p;
    q.object = &moved;
    if (*said_) {
      q.object_position = t.back(p.position);
      q.object_normal = normalize(normal_into(t, p.normal));
    } else {
      q.position = t(p.object_position);
      q.normal = q.shading_normal = normalize(t(p.object_normal));
    }
    compare(p, q, by_place_);
  }

  void compare(const SurfacePoint& p, const SurfacePoint& q, Comparison& all) {
    if (!steady(p)) return;
    ++all.tested;
    if (same(p, q)) return;
    if (all.different++ == 0)
      all.first = fmt::format("{} at ({}, {}, {}) becomes {}", map_.scalar(p), p.object_position.x, p.object_position.y,
                              p.object_position.z, map_.scalar(q));
  }

  bool same(const SurfacePoint& p, const SurfacePoint& q) const {
    const Wavelengths w = spread_wavelengths(500);
    const float a = map_.scalar(p), b = map_.scalar(q), tolerance = 2e-3f * (1 + std::abs(a));
    const Spectrum c = map_.reflectance(p, w), d = map_.reflectance(q, w);
    return std::abs(a - b) <= tolerance && (c - d).maximum() <= 2e-3f && (d - c).maximum() <= 2e-3f;
  }

  /// Whether the value does not change within the rounding errors of positions, as it does at the edges of a pattern.
  bool steady(const SurfacePoint& p) {
    for (int i = 0; i < 2; ++i) {
      const Vector3 off = (i == 0 ? 4e-6f : -4e-6f) * trial.direction();
      SurfacePoint q = p;
      q.position = p.position + off;
      q.object_position = p.object_position + off;
      if (!same(p, q)) return false;
    }
    return true;
  }

  void expect_few(const Comparison& all, const char* check) {
    trial.expect(all.different <= 3 + all.tested / 100, check,
                 [&] { return fmt::format("{} of {} values are different: {}", all.different, all.tested, all.first); });
  }

  Trial& trial;
  const ObjectMap& map_;
  const std::optional<bool> said_;
  const bool alone_;
  Comparison by_origin_, by_place_, by_tangents_;
};

}  // namespace

void check_map_space(Trial& trial, const ObjectMap& map) { SpaceTrial(trial, map).check(); }

}  // namespace etendue::conform
