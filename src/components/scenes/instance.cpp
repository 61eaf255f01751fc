// Instance: a further placement of a scene, optionally with another shader.

#include <map>
#include <mutex>

#include "etendue/scene.h"
#include "etendue/shader.h"
#include "geometry/geometry.h"
#include "geometry/scene_record.h"

namespace etendue {

namespace {

/// A stand-in for an object in the same place that differs from it only by its shader. Paths in media distinguish objects by
/// address, and the shader at a point is that of the point's object: so where an instance replaces shaders, hits refer to a
/// Reshaded instead of the object.
class Reshaded final : public SceneObject {
 public:
  static void describe(Description<Reshaded>& d) {
    d.summary("What stands for an object where an Instance has replaced its shader. It is made by instances alone.");
  }

  Reshaded(const SceneObject& other, const Ref<Shader>& with) : object(const_cast<SceneObject*>(&other)) {
    transform = object->transform;
    copy_surface_of(other, *this);
    shader = with;
    if (object->origin) origin = std::make_unique<Origin>(*object->origin);
  }

  Ref<SceneObject> object;

  Bounds3 bounds() const override { return object->bounds(); }
  bool intersect(const Ray& ray, Hit& hit) const override {
    if (!object->intersect(ray, hit)) return false;
    hit.object = this;
    return true;
  }
  bool occludes(const Ray& ray) const override { return object->occludes(ray); }
  void all_hits(const Ray& ray, HitList& list) const override {
    const int before = list.size;
    object->all_hits(ray, list);
    for (int i = before; i < list.size; ++i) list.hits[i].object = this;
  }
  void surface_point(const Ray& ray, const Hit& hit, SurfacePoint& p) const override {
    object->surface_point(ray, hit, p);
    p.object = this;
  }
  void tangents(SurfacePoint& p) const override { object->tangents(p); }
  float area(float time) const override { return object->area(time); }
  float area_error(float time) const override { return object->area_error(time); }
  SurfaceSample sample_area(Point2 u, float time) const override { return own(object->sample_area(u, time)); }
  float area_pdf(const SurfacePoint& p) const override { return object->area_pdf(p); }
  SurfaceSample sample_visible(const Point3& from, Point2 u, float time) const override {
    return own(object->sample_visible(from, u, time));
  }
  float visible_pdf(const Point3& from, const Vector3& direction, const SurfacePoint& p) const override {
    return object->visible_pdf(from, direction, p);
  }
  LuminaireBounds luminaire_bounds() const override { return object->luminaire_bounds(); }
  bool closed() const override { return object->closed(); }
  Extent extent() const override { return object->extent(); }
  const MeshFacts* mesh_facts() const override { return object->mesh_facts(); }

 private:
  SurfaceSample own(SurfaceSample s) const {
    s.point.object = this;
    return s;
  }
};

}  // namespace

/// The stand-ins of all objects of a scene, with one shader. Instances with the same scene and shader share them.
class ShaderReplacement {
 public:
  ShaderReplacement(const Scene& scene, const Ref<Shader>& shader) : version_(scene.version()) {
    std::vector<const SceneObject*> hittable;
    collect(scene, hittable);
    std::sort(hittable.begin(), hittable.end());
    hittable.erase(std::unique(hittable.begin(), hittable.end()), hittable.end());
    for (const SceneObject* object : hittable) {
      pairs_.push_back({object, make<Reshaded>(*object, shader)});
    }
  }

  const SceneObject* of(const SceneObject* object) const {
    const auto found = std::lower_bound(pairs_.begin(), pairs_.end(), object,
                                        [](const Pair& p, const SceneObject* o) { return p.object < o; });
    return found != pairs_.end() && found->object == object ? found->other.get() : object;
  }
  std::uint64_t version() const { return version_; }

  /// The ShaderReplacement of a scene, as it was last prepared, and a shader.
  static std::shared_ptr<const ShaderReplacement> shared(const Scene& scene, const Ref<Shader>& shader) {
    static std::mutex mutex;
    static auto* all = new std::map<std::pair<const Scene*, const Shader*>, std::weak_ptr<const ShaderReplacement>>;
    const std::lock_guard lock(mutex);
    std::erase_if(*all, [&](const auto& entry) { return entry.first.first == &scene && entry.second.expired(); });
    auto& known = (*all)[{&scene, shader.get()}];
    std::shared_ptr<const ShaderReplacement> made = known.lock();
    if (!made || made->version() != scene.version()) known = made = std::make_shared<const ShaderReplacement>(scene, shader);
    return made;
  }

 private:
  struct Pair {
    const SceneObject* object;
    Ref<const SceneObject> other;
  };

  /// Collects all objects that hits in a scene may refer to.
  static void collect(const Scene& scene, std::vector<const SceneObject*>& to) {
    for (const Ref<SceneObject>& object : scene.objects) {
      const auto* instance = dynamic_cast<const Instance*>(object.get());
      if (instance && instance->replacement())
        for (const Pair& pair : instance->replacement()->pairs_) to.push_back(pair.other.get());
      else if (const Scene* inner = scene_within(*object))
        collect(*inner, to);
      else
        to.push_back(object.get());
    }
  }

  std::vector<Pair> pairs_;  // sorted by the object's address
  std::uint64_t version_;
};

void Instance::describe(Description<Instance>& d) {
  d.summary(
       "A scene placed once more, under a transform of its own: what is in it and the structure over it are stored once "
       "for all instances. With a shader, everything in it has that shader instead of its own. The transform of the scene "
       "itself and the instance's emission, interior, sides and priority say nothing.",
       "Rubin & Whitted 1980, \"A 3-dimensional representation for fast rendering of complex scenes\"")
      .group("Content")
      .member<&Instance::scene>("scene", "", "what is placed", required, Effect::rebuild);
}

void Instance::prepare() {
  if (!scene) fail("scene", "an instance needs a scene, such as EmbreeScene { objects: [...] }");
  if (emission) fail("emission", "an instance emits what the objects in its scene do");
  if (interior) fail("interior", "an instance is filled as the objects in its scene are");
  transform.set_inner_origin(scene->transform.inner_origin());
  replacement_ = shader ? ShaderReplacement::shared(*scene, shader) : nullptr;
}

void Instance::note_way_out(Hit& hit) const {
  if (replacement_) hit.object = replacement_->of(hit.object);
  hit.scenes[hit.depth++] = this;
}

Bounds3 Instance::bounds() const { return scene->placed_bounds(transform); }

bool Instance::intersect(const Ray& ray, Hit& hit) const {
  Transform scratch;
  const Transform& t = placed(transform, ray.time, scratch);
  if (!scene->nearest(t.identity() ? ray : ray_into(t, ray), hit)) return false;
  note_way_out(hit);
  return true;
}

bool Instance::occludes(const Ray& ray) const {
  Transform scratch;
  const Transform& t = placed(transform, ray.time, scratch);
  return scene->any(t.identity() ? ray : ray_into(t, ray));
}

void Instance::all_hits(const Ray& ray, HitList& list) const {
  Transform scratch;
  const Transform& t = placed(transform, ray.time, scratch);
  HitList inside;  // only of this placement: hits that are in `list` already are elsewhere, even if on the same object
  scene->all(t.identity() ? ray : ray_into(t, ray), inside);
  for (int i = 0; i < inside.size; ++i) {
    note_way_out(inside.hits[i]);
    list.add(inside.hits[i]);
  }
}

void Instance::surface_point(const Ray& ray, const Hit& hit, SurfacePoint& point) const {
  scene->locate_nested(ray, hit, point);
}

void Instance::tangents(SurfacePoint& point) const {
  if (point.object && point.object != this) point.object->tangents(point);
}

float Instance::area(float time) const { return scene->placed_area(transform, time); }

SurfaceSample Instance::sample_area(Point2, float) const {
  return {};  // an instance is no luminaire
}

static const Register<Instance> registered;

// Registered, so that the class has a name, but without a function to create it by this name.
[[maybe_unused]] static const bool reshaded_known = [] {
  static RegistrationNode node{typeid(Reshaded), parent_type<Reshaded>(),
                               [](ClassInfo& info) {
                                 Description<Reshaded> d(info);
                                 Reshaded::describe(d);
                               },
                               nullptr, nullptr};
  enlist(node);
  return true;
}();

}  // namespace etendue
