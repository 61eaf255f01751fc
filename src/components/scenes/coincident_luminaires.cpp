#include "coincident_luminaires.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "etendue/core/error.h"
#include "etendue/mesh_facts.h"
#include "etendue/transport/boundaries.h"
#include "etendue/transport/path_sink.h"

namespace etendue {
namespace {

/// A surface at the position of a point, with the hit that found it.
struct Coincident {
  SurfacePoint point;
  Hit hit;
};

/// Whether both points lie on the same part of the same object. Only meshes are divided into parts here: the parts of other
/// objects touch along edges only.
bool same_part(const SurfacePoint& a, const SurfacePoint& b) {
  return a.object == b.object && (a.primitive == b.primitive || !still_triangles(a.object->original()));
}

bool in_one_place(const Scene& scene, const SurfacePoint& a, const SurfacePoint& b) {
  const float apart = std::abs(dot(a.normal, b.position - a.position));
  return apart <= std::max(reach_of_coincidence(scene, a), reach_of_coincidence(scene, b));
}

/// Calls found(coincident) for every surface close to a point along its normal, including the point's own surface.
template <class Found>
void for_coincident(const Scene& scene, const SurfacePoint& p, const Found& found) {
  const float reach = 2 * reach_of_coincidence(scene, p);
  Ray probe;
  probe.direction = -Vector3(p.normal);
  probe.origin = p.position - reach * probe.direction;
  probe.maximum = 2 * reach;
  probe.time = p.time;
  HitList list;
  scene.all(probe, list);
  for (int i = 0; i < list.size; ++i) {
    Coincident c;
    c.hit = list.hits[i];
    scene.locate_alone(probe, c.hit, c.point);
    found(c);
  }
}

bool emits_to(const SurfacePoint& p, const Vector3& direction) {
  return p.object->luminaire() && p.object->emission->emits(p, direction);
}

/// Enlarges the error of a point to include a coincident surface.
void widen_by(SurfacePoint& p, const SurfacePoint& other) {
  p.error = std::max(p.error, std::abs(dot(p.normal, other.position - p.position)) + other.error);
}

/// Collects luminaires that are hidden by coincident luminaires emitting to the same side, for a single warning.
class Hidden {
 public:
  void look(const SurfacePoint& shown, const SurfacePoint& hidden) {
    const SceneObject& object = hidden.object->original();
    if (!told_.insert(&object).second || first_) return;
    first_ = &object;
    before_ = &shown.object->original();
  }
  void say() const {
    if (!first_) return;
    const int line = before_->location_of().line;
    const std::string others = told_.size() > 1 ? fmt::format(", as {} more,", told_.size() - 1) : std::string();
    const std::string where = before_ == first_ ? std::string("itself: faces lie on faces")
                                                : fmt::format("another luminaire, {}{}", object_name(*before_),
                                                              line > 0 ? fmt::format(" (line {})", line) : std::string());
    warn(fmt::format("{}{} lies in one place with {}, and both send light to the same side. There, that of the first alone "
                     "leaves, and the other's is lost. Move one of them a little",
                     object_name(*first_), others, where),
         first_->location_of());
  }

 private:
  std::unordered_set<const SceneObject*> told_;
  const SceneObject *first_ = nullptr, *before_ = nullptr;
};

/// The time at the fraction u, in [0, 1), of the interval in which an object moves; 0 if it does not move.
float time_of(const SceneObject& object, float u) {
  if (!object.transform.animated()) return 0;
  const auto& keys = object.transform.keys();
  return std::lerp(float(keys.front().time), float(keys.back().time), u);
}

}  // namespace

/// Pairs of a luminaire and a coincident surface, each pair of objects once, in the order in which they were found.
struct CoincidentLuminaires::Pairs {
  void add(const SurfacePoint& luminaire, const SurfacePoint& other) {
    if (known.insert({luminaire.object, other.object}).second) found.push_back({luminaire, other});
  }
  std::vector<Pair> found;
  std::set<std::pair<const SceneObject*, const SceneObject*>> known;
};

std::shared_ptr<const CoincidentLuminaires> CoincidentLuminaires::of(const Scene& scene) {
  auto all = std::make_shared<CoincidentLuminaires>();
  all->note(scene);
  return all->met_.empty() ? nullptr : all;
}

void CoincidentLuminaires::note(const Scene& scene) {
  // The number of points in all, so that the time is negligible, and the largest number for one luminaire.
  constexpr size_t together = size_t(1) << 17, most = 512;
  const std::span<const SceneObject* const> luminaires = scene.luminaires();
  const size_t step = luminaires.size() / together + 1;
  const size_t count = std::clamp(together / std::max(luminaires.size(), size_t(1)), size_t(1), most);
  Pairs pairs;
  for (size_t i = 0; i < luminaires.size(); i += step)
    if (!luminaires[i]->infinite() && !luminaires[i]->delta()) look_at(scene, *luminaires[i], count, pairs);
  // The numbers for the fourth rule: luminaires first, in the order of the scene.
  std::unordered_set<const SceneObject*> shared;
  for (const Pair& p : pairs.found) shared.insert({p.luminaire.object, p.other.object});
  for (const SceneObject* luminaire : luminaires)
    if (shared.contains(luminaire)) numbers_.try_emplace(luminaire, int(numbers_.size()));
  for (const Pair& p : pairs.found) numbers_.try_emplace(p.other.object, int(numbers_.size()));
  Hidden hidden;
  for (const Pair& p : pairs.found)
    for (const Vector3& side : {Vector3(p.luminaire.normal), -Vector3(p.luminaire.normal)})
      if (emits_to(p.luminaire, side) && emits_to(p.other, side) && goes_before(p.other, p.luminaire, side))
        hidden.look(p.other, p.luminaire);
  hidden.say();
}

void CoincidentLuminaires::look_at(const Scene& scene, const SceneObject& luminaire, size_t count, Pairs& pairs) {
  for (size_t i = 0; i < count; ++i) {
    // The lattice of the plastic number (Roberts 2018, "The unreasonable effectiveness of quasirandom sequences").
    const double x = 0.7548776662466927 * double(i + 1), y = 0.5698402909980532 * double(i + 1);
    const Point2 u{std::min(float(x - std::floor(x)), one_minus_epsilon),
                   std::min(float(y - std::floor(y)), one_minus_epsilon)};
    const SurfaceSample s = luminaire.sample_area(u, time_of(luminaire, (float(i) + 0.5f) / float(count)));
    if (!(s.pdf > 0)) continue;
    const SceneObject* own = nullptr;  // the luminaire, as hits refer to it
    bool shared = false;
    for_coincident(scene, s.point, [&](const Coincident& c) {
      if (same_part(c.point, s.point)) {
        own = c.hit.object;
      } else if (in_one_place(scene, s.point, c.point)) {
        shared = true;
        met_.insert(c.hit.object);
        pairs.add(s.point, c.point);
      }
    });
    if (shared && own) met_.insert(own);
  }
}

bool CoincidentLuminaires::goes_before(const SurfacePoint& a, const SurfacePoint& b, const Vector3& direction) const {
  const SceneObject &x = *a.object, &y = *b.object;
  if (boundary_goes_before(x, y) != boundary_goes_before(y, x)) return boundary_goes_before(x, y);
  const bool shines = emits_to(a, direction);
  if (shines != emits_to(b, direction)) return shines;
  if (!shines && bool(x.shader) != bool(y.shader)) return bool(x.shader);
  if (&x == &y) return a.primitive < b.primitive;
  const auto of_x = numbers_.find(&x), of_y = numbers_.find(&y);
  if (of_x == numbers_.end() || of_y == numbers_.end()) return of_x != numbers_.end();
  return of_x->second < of_y->second;
}

void CoincidentLuminaires::settle(const Scene& scene, const Ray& ray, Hit& hit) const {
  if (!met_.contains(hit.object)) return;
  SurfacePoint first;
  scene.locate_alone(ray, hit, first);
  // All hits of the same ray up to a slightly larger distance, as distances are rounded and surface points have errors.
  const float across = std::max(std::abs(dot(first.normal, ray.direction)), 1e-4f);
  Ray longer = ray;
  longer.maximum =
      std::min(ray.maximum, hit.distance * (1 + 8 * rounding_bound(1)) + 2 * reach_of_coincidence(scene, first) / across);
  HitList list;
  scene.all(longer, list);
  SurfacePoint best = first;
  for (int i = 0; i < list.size; ++i) {
    SurfacePoint other;
    scene.locate_alone(ray, list.hits[i], other);
    if (same_part(other, best) || same_part(other, first) || !in_one_place(scene, first, other)) continue;
    if (!goes_before(other, best, -ray.direction)) continue;
    best = other;
    hit = list.hits[i];
  }
}

bool CoincidentLuminaires::in_front(const Scene& scene, SurfacePoint& p, const Vector3& direction) const {
  if (!numbers_.contains(p.object)) return true;
  bool front = true;
  const SurfacePoint own = p;
  for_coincident(scene, own, [&](const Coincident& c) {
    if (same_part(c.point, own) || !in_one_place(scene, own, c.point)) return;
    front &= goes_before(own, c.point, direction);
    widen_by(p, c.point);
  });
  return front;
}

void CoincidentLuminaires::widen(const Scene& scene, const Hit& hit, SurfacePoint& p) const {
  if (!met_.contains(hit.object)) return;
  const SurfacePoint own = p;
  for_coincident(scene, own, [&](const Coincident& c) {
    if (!same_part(c.point, own) && in_one_place(scene, own, c.point)) widen_by(p, c.point);
  });
}

}  // namespace etendue
