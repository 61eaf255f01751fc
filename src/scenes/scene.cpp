// What all scenes share: their lists of luminaires, and how they nest.

#include "etendue/scene.h"

#include <unordered_set>

#include "etendue/shader.h"
#include "objects/geometry.h"

namespace etendue {
namespace {

const Scene* as_scene(const SceneObject* object) { return dynamic_cast<const Scene*>(object); }

/// How many scenes lie in one another, this one not counted.
int nesting(const Scene& scene) {
  int deepest = 0;
  for (const Ref<SceneObject>& object : scene.objects)
    if (const Scene* inner = as_scene(object.get())) deepest = std::max(deepest, 1 + nesting(*inner));
  return deepest;
}

/// Calls for every object in nested scenes, at any depth, but not for the scene's own.
template <class F>
void for_nested(const Scene& scene, bool own, const F& call) {
  for (const Ref<SceneObject>& object : scene.objects) {
    if (const Scene* inner = as_scene(object.get()))
      for_nested(*inner, true, call);
    else if (own)
      call(*object);
  }
}

}  // namespace

void Scene::describe(Description<Scene>& d) {
  d.summary(
       "Objects, and a structure that finds what a ray meets. A scene is itself an object: scenes nest, and one that "
       "stands in several places is stored once. A nested scene's own shader, emission, interior, sides and priority say "
       "nothing.")
      .member<&Scene::objects>("objects", "", "what is in it", Effect::rebuild);
}

void Scene::prepare() {
  luminaires_.clear();
  infinite_.clear();
  interiors_.clear();
  bounds_ = {};
  has_interiors_ = has_null_surfaces_ = unbounded_ = false;
  const auto note_interior = [&](const SceneObject& object) {
    if (!object.shader) return;
    if (object.shader->possible_lobes() & pass_through) has_null_surfaces_ = true;
    if (!object.shader->transmits()) return;
    has_interiors_ = true;
    interiors_.push_back(object.bounds());
  };

  std::unordered_set<const SceneObject*> seen;
  for (size_t i = 0; i < objects.size(); ++i) {
    if (!objects[i]) fail("objects", "object " + std::to_string(i + 1) + " of the scene is none");
    if (!seen.insert(objects[i].get()).second) {
      const std::string name = objects[i]->origin ? objects[i]->origin->name : "";
      fail("objects", (name.empty() ? "object " + std::to_string(i + 1) : "'" + name + "'") +
                          " stands twice in the same scene; put it into scenes of its own, with their own transforms");
    }
    if (!objects[i]->transform.valid())
      objects[i]->fail("transform", "the transform is singular, or mirrors at some of its times only");
  }
  if (nesting(*this) > Hit::deepest_nesting)
    fail("objects", "scenes nest more than " + std::to_string(Hit::deepest_nesting) + " deep");

  // Luminaires of nested scenes are found by hits alone: those scenes gave them places in their own lists before.
  for_nested(*this, false, [&](SceneObject& object) {
    if (object.luminaire() && seen.contains(&object))
      object.fail("", "a luminaire stands both in a scene and in one nested in it");
    if (object.infinite()) object.fail("", "an object at infinity cannot stand in a nested scene");
    if (object.luminaire() && object.delta())
      object.fail("", "a luminaire without extent in a nested scene would never be found: put it into the outermost one");
    object.luminaire_index = -1;
  });
  for (const Ref<SceneObject>& object : objects)
    if (const Scene* inner = as_scene(object.get())) {
      has_null_surfaces_ |= inner->has_null_surfaces_;
      if (!inner->has_interiors_) continue;
      has_interiors_ = true;
      interiors_.push_back(inner->bounds());
    }

  std::vector<const SceneObject*> finite;
  for (const Ref<SceneObject>& object : objects) {
    const Scene* inner = as_scene(object.get());
    object->luminaire_index = -1;
    if (object->luminaire() && !object->infinite() && object->emission->only_at_infinity())
      object->fail("emission", "this emission is of light from infinity: it belongs on an Environment");
    if (object->interior && !inner && !object->closed())
      warn(object->class_info().name + ": the surface is not closed, so its interior is never entered",
           object->location_of("interior"));
    if (object->luminaire() && !inner) {
      object->luminaire_index = int(luminaires_.size());
      luminaires_.push_back(object.get());
      if (object->infinite() && !object->delta()) infinite_.push_back(object.get());
    }
    if (!inner) note_interior(*object);
    if (object->infinite()) continue;
    const Bounds3 box = object->bounds();
    if (box.empty()) continue;  // without extent: a point light, an empty scene
    if (!is_finite(box.low) || !is_finite(box.high) || !is_finite(box.diagonal()))
      object->fail("", "the object's bounds are not finite");
    if (object->unbounded()) {
      unbounded_ = true;
      if (object->luminaire() && !inner) object->fail("emission", "an object without end would give off endless power");
    } else {
      bounds_.add(box);
    }
    finite.push_back(object.get());
  }
  for (const Ref<SceneObject>& object : objects)
    if (object->infinite()) object->enclose(bounds_.empty() ? Point3{} : centre(), radius());
  build(finite);
}

Bounds3 Scene::bounds() const {
  if (unbounded_) return endless_box();
  return bounds_.empty() ? bounds_ : swept(transform, bounds_);
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
  const int before = list.size;
  all(t.identity() ? ray : ray_into(t, ray), list);
  for (int i = before; i < list.size; ++i) list.hits[i].scenes[list.hits[i].depth++] = this;
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
  hit.object->tangents(point);  // now: later the way out is forgotten
  for (int i = 0; i < hit.depth; ++i) {
    Transform scratch;
    const Transform& t = placed(hit.scenes[i]->transform, ray.time, scratch);
    if (!t.identity()) carry_out(t, point);
  }
}

void Scene::tangents(SurfacePoint& point) const {
  if (point.object && point.object != this) point.object->tangents(point);
}

float Scene::area(float time) const {
  // Exact when the scene's transform is a similarity.
  double sum = 0;
  for (const Ref<SceneObject>& object : objects)
    if (!object->infinite()) sum += double(object->area(time));
  return float(sum) * std::pow(std::abs(linear_determinant(transform.at(time))), 2.0f / 3);
}

SurfaceSample Scene::sample_area(Point2, float) const {
  return {};  // a scene is no luminaire
}

static const Register<Scene> registered;

}  // namespace etendue
