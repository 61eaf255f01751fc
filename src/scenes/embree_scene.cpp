// EmbreeScene: a bounding volume hierarchy by Embree (Wald et al. 2014, "Embree: a kernel framework for efficient CPU
// ray tracing"). Triangles are Embree's own, everything else comes in as user geometry.

#include "embree_device.h"
#include "etendue/scene.h"
#include "etendue/shader.h"

namespace etendue {

class EmbreeScene final : public Scene {
  enum class Quality : std::uint8_t { low, medium, high };
  Quality quality = Quality::medium;
  bool robust = false;
  bool compact = false;

 public:
  static void describe(Description<EmbreeScene>& d) {
    d.summary("A scene searched by Embree's bounding volume hierarchies: the fastest for all but a handful of triangles.",
              "Wald et al. 2014, \"Embree: a kernel framework for efficient CPU ray tracing\"")
        .member<&EmbreeScene::quality>("quality", "", "effort spent on the hierarchy: high takes longest to build",
                                       choices("low", "medium", "high"), Effect::rebuild)
        .member<&EmbreeScene::robust>("robust", "", "no ray slips between triangles that share an edge; slower",
                                      Effect::rebuild)
        .member<&EmbreeScene::compact>("compact", "", "less memory, slower", Effect::rebuild);
  }

  bool nearest(const Ray& ray, Hit& hit) const override {
    Context context{{}, &ray, &hit, nullptr};
    rtcInitIntersectContext(&context.embree);
    RTCRayHit query;
    set_embree_ray(query.ray, ray);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_.get(), &context.embree, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    const Geometry& geometry = geometries_[query.hit.geomID];
    if (!geometry.triangles) return true;  // the object filled the hit
    fill(hit, *geometry.object, query.ray.tfar, query.hit.primID, query.hit.u, query.hit.v);
    return true;
  }

  // Hits are noted as Embree finds them, and denied, so that it goes on.
  void all(const Ray& ray, HitList& list) const override {
    if (!has_interiors()) return Scene::all(ray, list);  // built without filters
    struct Collector : Context {
      const EmbreeScene* scene;
    } context{{{}, &ray, nullptr, &list}, this};
    rtcInitIntersectContext(&context.embree);
    context.embree.filter = [](const RTCFilterFunctionNArguments* arguments) {
      const Collector& c = *reinterpret_cast<const Collector*>(arguments->context);
      const RTCHit& found = *reinterpret_cast<const RTCHit*>(arguments->hit);
      Hit hit;
      fill(hit, *c.scene->geometries_[found.geomID].object, reinterpret_cast<const RTCRay*>(arguments->ray)->tfar, found.primID,
           found.u, found.v);
      c.list->add(hit);
      arguments->valid[0] = 0;
    };
    RTCRayHit query;
    set_embree_ray(query.ray, ray);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_.get(), &context.embree, &query);
  }

  bool any(const Ray& ray) const override {
    Context context{{}, &ray, nullptr, nullptr};
    rtcInitIntersectContext(&context.embree);
    RTCRay query;
    set_embree_ray(query, ray);
    rtcOccluded1(scene_.get(), &context.embree, &query);
    return query.tfar < 0;
  }

 protected:
  void build(std::span<const SceneObject* const> finite) override {
    scene_ = EmbreeSceneHandle(rtcNewScene(embree_device()));
    check_embree("making a scene");
    const RTCBuildQuality effort = quality == Quality::low      ? RTC_BUILD_QUALITY_LOW
                                   : quality == Quality::medium ? RTC_BUILD_QUALITY_MEDIUM
                                                                : RTC_BUILD_QUALITY_HIGH;
    rtcSetSceneBuildQuality(scene_.get(), effort);
    int flags = RTC_SCENE_FLAG_NONE;
    if (robust) flags |= RTC_SCENE_FLAG_ROBUST;
    if (compact) flags |= RTC_SCENE_FLAG_COMPACT;
    if (has_interiors()) flags |= RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;  // for `all`, which only asks about interiors
    rtcSetSceneFlags(scene_.get(), RTCSceneFlags(flags));
    geometries_.assign(finite.size(), {});
    for (const SceneObject* object : finite) {
      const std::optional<TriangleView> view = object->triangles();
      const unsigned id = view ? attach_triangles(scene_.get(), *view, effort) : attach_object(object);
      if (id >= geometries_.size()) geometries_.resize(id + 1);
      geometries_[id] = {object, view.has_value()};
    }
    rtcCommitScene(scene_.get());
    check_embree("building the scene");
  }

 private:
  struct Geometry {
    const SceneObject* object = nullptr;
    bool triangles = false;
  };

  /// What callbacks need: Embree hands its address back to them.
  struct Context {
    RTCIntersectContext embree;
    const Ray* ray;
    Hit* hit;
    HitList* list;  ///< where to note all hits instead
  };

  static void fill(Hit& hit, const SceneObject& object, float distance, std::uint32_t primitive, float u, float v) {
    hit.distance = distance;
    hit.object = &object;
    hit.primitive = primitive;
    hit.u = u;
    hit.v = v;
    hit.depth = 0;
  }

  unsigned attach_object(const SceneObject* object) {
    RTCGeometry geometry = rtcNewGeometry(embree_device(), RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, 1);
    rtcSetGeometryUserData(geometry, const_cast<SceneObject*>(object));
    rtcSetGeometryBoundsFunction(geometry, bounds_of, nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersect_object);
    rtcSetGeometryOccludedFunction(geometry, occluded_by_object);
    rtcCommitGeometry(geometry);
    const unsigned id = rtcAttachGeometry(scene_.get(), geometry);
    rtcReleaseGeometry(geometry);  // the scene holds it
    check_embree("taking in an object");
    return id;
  }

  static void bounds_of(const RTCBoundsFunctionArguments* arguments) {
    const Bounds3 box = static_cast<const SceneObject*>(arguments->geometryUserPtr)->bounds();
    // A little wider: Embree's test of a flat box must not miss what lies exactly in its plane.
    const auto margin = [](float low, float high) { return 1e-6f * std::max(std::abs(low), std::abs(high)) + 1e-30f; };
    const Vector3 m{margin(box.low.x, box.high.x), margin(box.low.y, box.high.y), margin(box.low.z, box.high.z)};
    RTCBounds& b = *arguments->bounds_o;
    b.lower_x = box.low.x - m.x;
    b.lower_y = box.low.y - m.y;
    b.lower_z = box.low.z - m.z;
    b.upper_x = box.high.x + m.x;
    b.upper_y = box.high.y + m.y;
    b.upper_z = box.high.z + m.z;
  }

  static void intersect_object(const RTCIntersectFunctionNArguments* arguments) {
    if (!arguments->valid[0]) return;
    RTCRayHit& query = *reinterpret_cast<RTCRayHit*>(arguments->rayhit);
    const Context& context = *reinterpret_cast<const Context*>(arguments->context);
    Ray ray = *context.ray;
    ray.maximum = query.ray.tfar;
    if (context.list) return static_cast<const SceneObject*>(arguments->geometryUserPtr)->all_hits(ray, *context.list);
    if (!static_cast<const SceneObject*>(arguments->geometryUserPtr)->intersect(ray, *context.hit)) return;
    query.ray.tfar = context.hit->distance;
    query.hit.geomID = arguments->geomID;
    query.hit.primID = 0;
  }

  static void occluded_by_object(const RTCOccludedFunctionNArguments* arguments) {
    if (!arguments->valid[0]) return;
    RTCRay& query = *reinterpret_cast<RTCRay*>(arguments->ray);
    const Context& context = *reinterpret_cast<const Context*>(arguments->context);
    if (static_cast<const SceneObject*>(arguments->geometryUserPtr)->occludes(*context.ray)) query.tfar = -infinity;
  }

  EmbreeSceneHandle scene_;
  std::vector<Geometry> geometries_;  // by Embree's number
};

static const Register<EmbreeScene> registered;

}  // namespace etendue
