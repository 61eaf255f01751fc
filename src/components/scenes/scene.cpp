// Base class of scenes: lists of luminaires and interiors, nesting, and objects that are invisible to the camera.

#include "etendue/scene.h"

#include <algorithm>
#include <atomic>
#include <unordered_set>

#include "coincident_luminaires.h"
#include "etendue/reradiation.h"
#include "etendue/shader.h"
#include "etendue/transport/medium_stack.h"
#include "geometry/scene_record.h"
#include "hidden_fluorescence.h"
#include "nested_luminaires.h"

namespace etendue {
namespace {

/// Calls call(inner) once for every nested scene, at any depth.
template <class F>
void for_nested(const Scene& scene, std::unordered_set<const Scene*>& seen, const F& call) {
  for (const Ref<SceneObject>& object : scene.objects) {
    const auto* instance = dynamic_cast<const Instance*>(object.get());
    Scene* inner = instance ? instance->scene.get() : dynamic_cast<Scene*>(object.get());
    if (!inner || !seen.insert(inner).second) continue;
    call(*inner);
    for_nested(*inner, seen, call);
  }
}

/// Whether the surface or the interior of an object fluoresces, or any in a scene within. An instance's shader replaces all
/// shaders of its scene, but not their interiors.
bool fluoresces(const SceneObject& object) {
  const Scene* inner = scene_within(object);
  if (inner && inner->has_fluorescence()) return true;
  return inner != &object && (fluorescent(object.shader.get()) || dyed(object.interior.get()));
}

/// Finds objects that are too small for the precision of floats at their position, for a single warning.
class Coarse {
 public:
  void look(const SceneObject& object, const Bounds3& box) {
    const float size = max_component(box.diagonal()), away = max_component(abs(box.centre() - Point3{}));
    // An object of size 0 cannot be distorted. For objects smaller than `least` the squares of areas underflow.
    constexpr float least = 1e-9f;
    if (!(size > 0) || object.unbounded() || (size > 8 * rounding_bound(2) * away && size > least)) return;
    if (count_++ > 0) return;
    first_ = &object;
    size_ = size;
    away_ = away;
  }
  void say() const {
    if (count_ == 0) return;
    const std::string who = fmt::format("{}{}", first_->class_info().name,
                                        count_ > 1 ? fmt::format(" and {} other objects", count_ - 1) : std::string());
    if (size_ > 8 * rounding_bound(2) * away_)
      warn(fmt::format("{}: {:.3g} m large; below 1e-9 m light is not computed exactly. Give lengths in another unit", who,
                       size_),
           first_->location_of());
    else
      warn(fmt::format("{}: {:.3g} m large and {:.3g} m away from the origin of coordinates, where places are told apart by "
                       "{:.3g} m: it is misshapen or not seen. Move the camera nearer, or leave it out",
                       who, size_, away_, rounding_bound(2) * away_),
           first_->location_of());
  }

 private:
  const SceneObject* first_ = nullptr;
  size_t count_ = 0;
  float size_ = 0, away_ = 0;
};

/// Changes the origin of the coordinates around an object, and correspondingly those of the objects within it if it is not a
/// scene; prepares it again.
void move_origin(SceneObject& object, const DoublePoint3& outer, float time) {
  DoublePoint3 inner = object.transform.inner_origin();
  if (scene_record(object).follows_scene && !scene_within(object)) {
    inner = object.transform.written(time).back(outer);
    for (SceneObject* part : objects_within(object)) move_origin(*part, inner, time);
  }
  object.transform.set_origins(outer, inner);
  object.prepare();
}

/// If all surfaces are unbounded, a sphere of radius 1 m replaces the scene's bounding sphere, around which light paths begin.
/// It lies around the world's origin; but if this is so far from the origin of rendering space, near the camera, that floats
/// would be too coarse there, it lies around that origin.
Bounds3 for_endless_ones(const DoublePoint3& rendering_origin) {
  constexpr double near = 1e5;
  const DoubleVector3 away = DoublePoint3{} - rendering_origin;
  const Point3 middle = length(away) < near ? Point3{} + Vector3(away) : Point3{};
  const float half = 1 / std::sqrt(3.0f);
  Bounds3 cube;
  cube.add(middle - Vector3{half, half, half});
  cube.add(middle + Vector3{half, half, half});
  return cube;
}

/// The structure for objects that are invisible to the camera, in scenes of any class.
constexpr const char* structure_of_unseen = "BvhScene";

/// If there are more boxes of interiors than this, a tree is built over them.
constexpr size_t few_interiors = 16;

}  // namespace

const Scene* scene_within(const SceneObject& object) {
  if (const auto* instance = dynamic_cast<const Instance*>(&object)) return instance->scene.get();
  return dynamic_cast<const Scene*>(&object);
}

bool shines(const SceneObject& object) {
  return object.luminaire() && (object.delta() || object.infinite() || !object.bounds().empty());
}

void Scene::describe(Description<Scene>& d) {
  d.summary(
       "Objects, and a structure that finds what a ray meets. A scene is itself an object: scenes nest, and one that "
       "stands in several places is stored once. Its luminaires are luminaires in each of these places; amounts of light "
       "they are asked for (a power in watts) are those of each place, whatever its size. A nested scene's own shader, "
       "emission, interior, sides and priority say nothing, and what the camera does not see is said of the objects in it.")
      .group("Content")
      .member<&Scene::objects>("objects", "", "what is in it", Effect::rebuild);
}

std::vector<SceneObject*> Scene::placed_within() const {
  std::vector<SceneObject*> all;
  for (const Ref<SceneObject>& object : objects) all.push_back(object.get());
  return all;
}

// The objects' positions are known only from their bounds, in floats far from the current origin. That is precise enough to
// choose a better origin; with it the objects are prepared once more.
void Scene::choose_origin() {
  Bounds3 all;
  for (const Ref<SceneObject>& object : objects)
    if (object && !object->infinite() && !object->unbounded()) all.add(object->bounds());
  if (all.empty() || !is_finite(all.low) || !is_finite(all.high)) return;
  // Up to this distance, relative to the objects' extent, positions are rounded by no more than 4e-6 of the extent.
  constexpr float far = 64;
  const Vector3 away = all.centre() - Point3{};
  if (!(max_component(abs(away)) > far * max_component(all.diagonal()))) return;
  const DoublePoint3 inner_origin = transform.inner_origin() + DoubleVector3(away);
  transform.set_inner_origin(inner_origin);
  for (const Ref<SceneObject>& object : objects) move_origin(*object, inner_origin, *chooses_origin_at_);
}

void Scene::prepare() {
  require_good_objects();
  if (chooses_origin()) choose_origin();
  const Finite finite = survey();
  build(finite.seen);
  unseen_ = finite.unseen.empty() ? nullptr : ref_cast<Scene>(Registry::instance().create(structure_of_unseen));
  if (unseen_) unseen_->build(finite.unseen);
  find_coincident();
}

// The acceleration structure is kept, as the objects' positions have not changed.
void Scene::prepare_again() {
  require_good_objects();
  survey();
  find_coincident();
}

void Scene::require_good_objects() {
  nesting_ = 0;
  std::unordered_set<const SceneObject*> seen;
  for (size_t i = 0; i < objects.size(); ++i) {
    if (!objects[i]) fail("objects", "object " + std::to_string(i + 1) + " of the scene is none");
    if (!seen.insert(objects[i].get()).second) {
      const std::string name = objects[i]->origin ? objects[i]->origin->name : "";
      fail("objects", (name.empty() ? "object " + std::to_string(i + 1) : "'" + name + "'") +
                          " stands twice in the same scene; put it into a scene, and that into an Instance for each place");
    }
    if (!objects[i]->transform.valid())
      objects[i]->fail("transform",
                       "the transform is singular or beyond what can be counted with, or mirrors at some of its times only");
    if (const Scene* inner = scene_within(*objects[i])) nesting_ = std::max(nesting_, 1 + inner->nesting_);
  }
  if (nesting_ > Hit::deepest_nesting)
    fail("objects", "scenes nest more than " + std::to_string(Hit::deepest_nesting) + " deep");
}

/// Records whether paths can enter an object, and whether its surface has null scattering.
void Scene::note_interior(const SceneObject& object) {
  const bool null_surfaces = object.shader && object.shader->possible_lobes() & null_scattering;
  // A sheet may bound a medium (see enterable). If an instance's shader is a sheet, its objects are assumed to have interiors.
  const bool may_enter =
      object.shader && (object.shader->transmits() || (is_sheet(*object.shader) && (object.interior || scene_within(object))));
  const Scene* inner = scene_within(object);
  // An instance's shader replaces all shaders of its scene.
  const bool asks_inside = inner && (inner == &object || !object.shader);
  has_null_surfaces_ |= asks_inside ? inner->has_null_surfaces_ : null_surfaces;
  if (!(asks_inside ? inner->has_interiors_ : may_enter)) return;
  has_interiors_ = true;
  interiors_.push_back(object.bounds());
}

/// Whether an object is invisible to camera rays and belongs into the separate structure; checks that this is possible.
bool Scene::note_unseen(const SceneObject& object) {
  const Scene* inner = scene_within(object);
  if (inner && !object.visible_to_camera)
    object.fail("visible_to_camera",
                "it is said of each object in a scene, and of a scene as a whole nothing; what an Import holds is seen");
  if (inner) {
    if (inner->has_unseen_ && inner != &object && object.shader && (object.shader->transmits() || is_sheet(*object.shader)))
      object.fail("shader", "light cannot be let into a scene with objects that the camera does not see");
    has_unseen_ |= inner->has_unseen_;
    return false;
  }
  if (object.visible_to_camera) return false;
  if (object.surrounds() || enterable(object))
    object.fail("visible_to_camera",
                "light goes into this object, so the camera would see what fills it: it cannot be left out");
  if (object.delta()) return false;  // no ray hits it anyway
  has_unseen_ = true;
  return !object.infinite();
}

void Scene::find_coincident() {
  coincident_.reset();
  careful_ = bool(unseen_);
  coincident_ = CoincidentLuminaires::of(*this);
  careful_ |= bool(coincident_);
}

bool Scene::nearest_with_care(const Ray& ray, Hit& hit) const {
  if (!(unseen_ ? nearest_with_unseen(ray, hit) : find_nearest(ray, hit))) return false;
  if (coincident_) coincident_->settle(*this, ray, hit);
  return true;
}

void Scene::widen_coincident(const Hit& hit, SurfacePoint& point) const { coincident_->widen(*this, hit, point); }

bool Scene::in_front_of_coincident(SurfacePoint& point, const Vector3& direction) const {
  return coincident_->in_front(*this, point, direction);
}

bool Scene::nearest_with_unseen(const Ray& ray, Hit& hit) const {
  const bool found = find_nearest(ray, hit);
  if (ray.of_camera) return found;
  Ray rest = ray;
  if (found) rest.maximum = hit.distance;
  return unseen_->find_nearest(rest, hit) || found;
}

void Scene::all_unseen(const Ray& ray, HitList& list) const {
  HitList more;
  unseen_->find_all(ray, more);
  const auto known = [&](const Hit& hit) {  // in a scene over the objects of another scene (Import) hits may be found twice
    return std::any_of(list.hits, list.hits + list.size,
                       [&](const Hit& h) { return h.object == hit.object && h.distance == hit.distance; });
  };
  for (int i = 0; i < more.size; ++i)
    if (!known(more.hits[i])) list.add(more.hits[i]);
}

/// Collects the scene's luminaires, interiors, bounds and surroundings, and returns the objects that rays can hit.
Scene::Finite Scene::survey() {
  luminaires_.clear();
  infinite_.clear();
  interiors_.clear();
  interior_tree_.clear();
  bounds_ = {};
  surroundings_ = nullptr;
  static std::atomic<std::uint64_t> versions{0};
  version_ = ++versions;
  has_interiors_ = has_null_surfaces_ = has_fluorescence_ = has_unseen_ = unbounded_ = false;
  // Luminaires of nested scenes are represented by PlacedLuminaires. The indices that they got when the nested scenes were
  // prepared are reset.
  std::unordered_set<const Scene*> visited;
  for_nested(*this, visited, [](Scene& inner) {
    for (const Ref<SceneObject>& object : inner.objects) {
      if (object->infinite() && !object->delta())
        object->fail("", (object->surrounds() ? "surroundings" : "an environment") +
                             std::string(" cannot stand in a nested scene: what is all around belongs into the outermost one"));
      scene_record(*object).luminaire_index = -1;
    }
    inner.luminaires_.clear();
    inner.infinite_.clear();
    inner.nested_.reset();
    inner.coincident_.reset();
    inner.careful_ = bool(inner.unseen_);
  });
  const std::shared_ptr<NestedLuminaires> nested = NestedLuminaires::of(*this);
  nested_ = nested;

  Finite finite;
  Coarse coarse;
  HiddenFluorescence hidden_fluorescence;
  for (const Ref<SceneObject>& object : objects) {
    const Scene* inner = scene_within(*object);
    scene_record(*object).luminaire_index = -1;
    if (object->luminaire() && !object->infinite() && object->emission->only_at_infinity())
      object->fail("emission", "this emission is of light from infinity: it belongs on an Environment");
    if (shines(*object) && !inner) {
      scene_record(*object).luminaire_index = int(luminaires_.size());
      luminaires_.push_back(object.get());
      if (object->infinite() && !object->delta()) infinite_.push_back(object.get());
    }
    const bool unseen = note_unseen(*object);
    has_fluorescence_ |= fluoresces(*object);
    if (object->shader) hidden_fluorescence.refuse(*object->shader);
    if (object->surrounds()) {
      if (surroundings_) object->fail("", "there are surroundings already: a scene stands in one thing alone");
      surroundings_ = dynamic_cast<const SurroundingObject*>(object.get());
      if (!surroundings_) object->fail("", "its class states surroundings but is no SurroundingObject");
      has_interiors_ = true;
      // In the surrounding medium light from infinity is scattered to the objects also from positions beside them, so all
      // positions across the light's direction contribute, as with an unbounded object.
      Ray any;
      any.direction = {0, 0, 1};
      unbounded_ |= std::isfinite(surroundings_->reach(any));
      continue;
    }
    note_interior(*object);
    if (object->infinite()) continue;
    const Bounds3 box = object->bounds();
    if (box.empty()) continue;  // without extent: a point light, an empty scene
    if (!is_finite(box.low) || !is_finite(box.high) || !is_finite(box.diagonal()))
      object->fail("", "the object's bounds are not finite");
    // For longer edges the squares of products of edges overflow.
    constexpr float largest = 2 * SceneObject::endless;
    if (!object->unbounded() && max_component(box.diagonal()) > largest)
      object->fail("", "the object is larger than 2e9 m, which is beyond what can be counted with");
    coarse.look(*object, box);
    if (object->unbounded()) {
      unbounded_ = true;
      if (object->luminaire() && !inner) object->fail("emission", "an object without end would give off endless power");
    } else {
      bounds_.add(box);
    }
    (unseen ? finite.unseen : finite.seen).push_back(object.get());
  }
  const auto seen = std::stable_partition(infinite_.begin(), infinite_.end(),
                                          [](const SceneObject* object) { return object->visible_to_camera; });
  infinite_seen_ = size_t(seen - infinite_.begin());
  coarse.say();
  if (unbounded_ && bounds_.empty()) bounds_ = for_endless_ones(transform.inner_origin());
  if (interiors_.size() > few_interiors) {
    std::vector<Bounds3> boxes;
    boxes.swap(interiors_);
    build_interior_tree(boxes);
    interiors_ = {interior_tree_.front().box};
  }
  for (const Ref<SceneObject>& object : objects)
    if (auto* infinite = dynamic_cast<InfiniteObject*>(object.get())) infinite->enclose(centre(), radius());
  if (nested) {
    nested->enclose(centre(), radius());
    luminaires_.reserve(luminaires_.size() + nested->all().size());
    for (const Ref<PlacedLuminaire>& luminaire : nested->all()) {
      scene_record(*luminaire).luminaire_index = int(luminaires_.size());
      luminaires_.push_back(luminaire.get());
    }
  }
  for (const SceneObject* luminaire : luminaires_) luminaire->emission->objects_changed();
  return finite;
}

void Scene::build_interior_tree(std::span<Bounds3> boxes) {
  Bounds3 all;
  for (const Bounds3& box : boxes) all.add(box);
  const size_t place = interior_tree_.size();
  interior_tree_.push_back({all, 0});
  if (boxes.size() == 1) return;
  const Vector3 d = all.diagonal();
  const int axis = d.x > d.y ? (d.x > d.z ? 0 : 2) : (d.y > d.z ? 1 : 2);
  const auto middle = boxes.begin() + std::ptrdiff_t(boxes.size() / 2);
  std::nth_element(boxes.begin(), middle, boxes.end(),
                   [axis](const Bounds3& a, const Bounds3& b) { return a.centre()[axis] < b.centre()[axis]; });
  build_interior_tree({boxes.begin(), middle});
  build_interior_tree({middle, boxes.end()});
  interior_tree_[place].next = std::uint32_t(interior_tree_.size());
}

bool Scene::in_interior_tree(const Point3& p) const {
  for (size_t i = 0; i < interior_tree_.size();) {
    const Node& node = interior_tree_[i];
    const bool inside = node.box.contains(p);
    if (inside && node.next == 0) return true;
    i = inside || node.next == 0 ? i + 1 : node.next;
  }
  return false;
}

Bounds3 Scene::bounds() const { return placed_bounds(transform); }

Bounds3 Scene::placed_bounds(const AnimatedTransform& placed) const {
  if (unbounded_) return endless_box();
  return bounds_.empty() ? bounds_ : swept(placed, bounds_);
}

bool Scene::intersect(const Ray& ray, Hit& hit) const {
  Transform scratch;
  const Transform& t = placed(transform, ray.time, scratch);
  if (!nearest(t.identity() ? ray : ray_into(t, ray), hit)) return false;
  hit.scenes[hit.depth++] = this;
  return true;
}

void Scene::all_hits(const Ray& ray, HitList& list) const {
  Transform scratch;
  const Transform& t = placed(transform, ray.time, scratch);
  HitList inside;  // only of this placement: hits that are in `list` already are elsewhere, even if on the same object
  all(t.identity() ? ray : ray_into(t, ray), inside);
  for (int i = 0; i < inside.size; ++i) {
    Hit& hit = inside.hits[i];
    hit.scenes[hit.depth++] = this;
    list.add(hit);
  }
}

bool Scene::occludes(const Ray& ray) const {
  Transform scratch;
  const Transform& t = placed(transform, ray.time, scratch);
  return any(t.identity() ? ray : ray_into(t, ray));
}

void Scene::surface_point(const Ray& ray, const Hit& hit, SurfacePoint& point) const { locate_nested(ray, hit, point); }

void Scene::locate_nested(const Ray& ray, const Hit& hit, SurfacePoint& point) const {
  Ray local = ray;
  for (int i = hit.depth; i-- > 0;) {
    Transform scratch;
    const Transform& t = placed(hit.scenes[i]->transform, ray.time, scratch);
    if (!t.identity()) local = ray_into(t, local);
  }
  hit.object->surface_point(local, hit, point);
  hit.object->tangents(point);  // now, as the point does not store the nested scenes
  for (int i = 0; i < hit.depth; ++i) {
    Transform scratch;
    const Transform& t = placed(hit.scenes[i]->transform, ray.time, scratch);
    if (!t.identity()) carry_out_of_scene(t, point);
  }
  if (nested_ && point.object->luminaire())
    if (const PlacedLuminaire* luminaire = nested_->find(hit)) point.object = luminaire;
}

void Scene::tangents(SurfacePoint& point) const {
  if (point.object && point.object != this) point.object->tangents(point);
}

double Scene::own_area(float time) const {
  double sum = 0;
  for (const Ref<SceneObject>& object : objects)
    if (!object->infinite() && !object->delta()) sum += double(object->area(time));
  return sum;
}

float Scene::placed_area(const AnimatedTransform& placed, float time) const {
  return float(own_area(time)) * std::pow(std::abs(placed.at(time).determinant()), 2.0f / 3);
}

float Scene::area(float time) const { return placed_area(transform, time); }

SurfaceSample Scene::sample_area(Point2, float) const {
  return {};  // a scene is no luminaire
}

static const Register<Scene> registered;

}  // namespace etendue
