// EmbreeScene: a bounding volume hierarchy by Embree (Wald et al. 2014, "Embree: a kernel framework for efficient CPU
// ray tracing"). Triangles, also those of deforming meshes, are Embree's own geometry, and so are nested scenes and instances
// that do not move. All other objects are user geometry. So are objects with an animated transform: Embree interpolates
// transforms in single precision, between evenly spaced keys and by another decomposition than AnimatedTransform, so rays
// would not hit where surface points were sampled.

#include "components/objects/meshes/triangle_object.h"
#include "etendue/scene.h"
#include "etendue/shader.h"
#include "geometry/embree_device.h"
#include "geometry/geometry.h"

namespace etendue {

class EmbreeScene final : public Scene {
  enum class Quality : std::uint8_t { low, medium, high };
  Quality quality = Quality::medium;
  bool compact = false;

 public:
  static void describe(Description<EmbreeScene>& d) {
    d.summary(
         "A scene searched by Embree's bounding volume hierarchies, which take less memory for a large mesh than BvhScene's.",
         "Wald et al. 2014, \"Embree: a kernel framework for efficient CPU ray tracing\"")
        .group("Structure")
        .member<&EmbreeScene::quality>("quality", "", "effort spent on the hierarchy: high takes longest to build",
                                       choices("low", "medium", "high"), Effect::rebuild)
        .member<&EmbreeScene::compact>("compact", "", "less memory, slower", Effect::rebuild);
  }

  bool find_nearest(const Ray& ray, Hit& hit) const override {
    Context context{{}, *this, ray, &hit, nullptr};
    RTCRayHit query;
    set_embree_ray(query.ray, ray, clock_);
    while (true) {
      query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
      embree_intersect(scene_.get(), context.embree, query);
      if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
      const unsigned instance = query.hit.instID[0];
      const bool nested = instance != RTC_INVALID_GEOMETRY_ID;
      if (complete(query.hit, nested ? ray_into(geometries_[instance].object->transform.still(), ray) : ray, hit)) [[likely]]
        return true;
      go_on_behind(query.ray, ray);
    }
  }

  // The filter function records each hit that Embree finds and rejects it, so that Embree continues the search.
  void find_all(const Ray& ray, HitList& list) const override {
    Context context{{}, *this, ray, nullptr, &list};
    const RTCFilterFunctionN filter = [](const RTCFilterFunctionNArguments* arguments) {
      Hit hit;
      if (complete(*arguments, hit)) reinterpret_cast<const Context*>(arguments->context)->list->add(hit);
      arguments->valid[0] = 0;
    };
    RTCRayHit query;
    set_embree_ray(query.ray, ray, clock_);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    embree_intersect(scene_.get(), context.embree, query, filter);
  }

  bool find_any(const Ray& ray) const override {
    Context context{{}, *this, ray, nullptr, nullptr};
    const RTCFilterFunctionN filter = [](const RTCFilterFunctionNArguments* arguments) {
      Hit hit;
      if (!complete(*arguments, hit)) arguments->valid[0] = 0;
    };
    RTCRay query;
    set_embree_ray(query, ray, clock_);
    embree_occluded(scene_.get(), context.embree, query, filter);
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
    int flags = RTC_SCENE_FLAG_ROBUST | embree_filter_flag;
    if (compact) flags |= RTC_SCENE_FLAG_COMPACT;
    rtcSetSceneFlags(scene_.get(), RTCSceneFlags(flags));
    geometries_.clear();
    views_.clear();
    others_.clear();
    levels_ = 0;
    clock_ = {};
    for (const SceneObject* object : finite) {
      if (const std::optional<TriangleView> view = still_triangles(*object))
        note(attach_triangles(scene_.get(), *view, effort), triangles_of(object, *view));
      else if (const std::optional<MovingTriangleView> moving = moving_triangles(*object))
        attach_moving_triangles(scene_.get(), *moving, effort, [&](unsigned id) { note(id, triangles_of(object, *moving)); });
      else if (const EmbreeScene* inner = instanced(*object))
        note(attach_instance(*inner, object->transform.still()), {object, inner});
      else
        others_.push_back(object);
    }
    if (!others_.empty()) note(attach_others(), {});
    rtcCommitScene(scene_.get());
    check_embree("building the scene");
  }

 private:
  /// A geometry of Embree: an object's triangles, or an object's nested scene (`inner`); neither: all other objects.
  struct Geometry {
    const SceneObject* object = nullptr;
    const EmbreeScene* inner = nullptr;
    std::uint32_t view = 0;  // for triangles: index in views_
  };
  Geometry triangles_of(const SceneObject* object, const MovingTriangleView& view) {
    views_.push_back(view);
    return {object, nullptr, std::uint32_t(views_.size() - 1)};
  }

  /// The data of callbacks, which get the address of `embree`.
  struct Context {
    EmbreeContext embree;
    const EmbreeScene& scene;
    const Ray& ray;
    Hit* hit;
    HitList* list;  ///< null, or where all hits are recorded instead
  };

  void note(unsigned id, const Geometry& geometry) {
    if (id >= geometries_.size()) geometries_.resize(std::max<size_t>(id + 1, geometries_.size() * 3 / 2));
    geometries_[id] = geometry;
  }

  /// Completes a hit: fills it for triangles (hits on user geometry were filled when they were found), and adds the nested
  /// scenes around the object. The ray is in the coordinates of the scene that contains the triangle. False: the ray does not
  /// hit the triangle by the exact distance.
  bool complete(const RTCHit& found, const Ray& ray, Hit& hit) const {
    const unsigned instance = found.instID[0];
    const EmbreeScene& owner = instance == RTC_INVALID_GEOMETRY_ID ? *this : *geometries_[instance].inner;
    const Geometry& geometry = owner.geometries_[found.geomID];
    if (geometry.object) {
      const float t = exact_distance(owner.views_[geometry.view], found.primID, ray);
      if (!(t > 0 && t < ray.maximum)) return false;
      hit.distance = t;
      hit.object = geometry.object;
      hit.primitive = found.primID;
      hit.u = found.u;
      hit.v = found.v;
      hit.depth = 0;
    }
    note_way_out(instance, hit);
    return true;
  }
  /// The same for a hit that Embree passes to a filter function.
  static bool complete(const RTCFilterFunctionNArguments& asked, Hit& hit) {
    const Context& context = *reinterpret_cast<const Context*>(asked.context);
    Ray ray = ray_of(context, *reinterpret_cast<const RTCRay*>(asked.ray));
    ray.maximum = context.ray.maximum;  // tfar is the distance of the hit here
    return context.scene.complete(*reinterpret_cast<const RTCHit*>(asked.hit), ray, hit);
  }

  void note_way_out(unsigned instance, Hit& hit) const {
    if (instance == RTC_INVALID_GEOMETRY_ID) return;
    const SceneObject* object = geometries_[instance].object;
    // The object is the inner scene itself, or an instance of it.
    if (object == geometries_[instance].inner)
      hit.scenes[hit.depth++] = object;
    else
      static_cast<const Instance*>(object)->note_way_out(hit);
  }

  /// The triangles of a deforming mesh, if its times agree with this scene's clock, which the first such mesh sets.
  std::optional<MovingTriangleView> moving_triangles(const SceneObject& object) {
    const auto* mesh = dynamic_cast<const TriangleObject*>(&object);
    std::optional<MovingTriangleView> view = mesh ? mesh->moving_triangles() : std::nullopt;
    if (view && !keeps_time({view->times.front(), view->times.back()})) return std::nullopt;
    return view;
  }

  bool keeps_time(const EmbreeClock& clock) {
    if (!clock_.runs()) clock_ = clock;
    return !clock.runs() || clock == clock_;
  }

  /// The nested scene of an object, if Embree can traverse it as an instance: Embree supports RTC_MAX_INSTANCE_LEVEL_COUNT
  /// levels of instances, and only instances that do not move are passed to it. Else null.
  const EmbreeScene* instanced(const SceneObject& object) {
    const auto* inner = dynamic_cast<const EmbreeScene*>(scene_within(object));
    if (!inner || inner->levels_ >= RTC_MAX_INSTANCE_LEVEL_COUNT || object.transform.animated()) return nullptr;
    // Objects that are invisible to the camera are in a structure of their own, which Embree does not search.
    if (inner->has_unseen() || !inverted_well(object.transform.still(), object.bounds()) || !keeps_time(inner->clock_))
      return nullptr;
    levels_ = std::max(levels_, 1 + inner->levels_);
    return inner;
  }

  /// Whether the inverse in single precision is as accurate as Scene::locate_nested assumes: measured in the outer scene, it
  /// displaces points of the box by no more than four roundings of their coordinates.
  static bool inverted_well(const Transform& placement, const Bounds3& box) {
    // Computed as by Embree: cofactors over the determinant, then the translation.
    const auto& m = placement.matrix();
    const Vector3 x{m[0], m[4], m[8]}, y{m[1], m[5], m[9]}, z{m[2], m[6], m[10]};
    const float scale = 1 / dot(x, cross(y, z));
    const Vector3 rows[3] = {scale * cross(y, z), scale * cross(z, x), scale * cross(x, y)};
    const Vector3 translation{m[3], m[7], m[11]};
    for (int corner = 0; corner < 8; ++corner) {
      const Point3 p = box.corner(corner);
      const Vector3 v = p - Point3{}, true_one = placement.back(p) - Point3{};
      Vector3 off;
      for (int k = 0; k < 3; ++k) off[k] = dot(rows[k], v) - dot(rows[k], translation) - true_one[k];
      if (!(length(placement(off)) <= rounding_bound(4) * (std::abs(p.x) + std::abs(p.y) + std::abs(p.z)))) return false;
    }
    return true;
  }

  unsigned attach_instance(const EmbreeScene& inner, const Transform& placement) {
    RTCGeometry geometry = rtcNewGeometry(embree_device(), RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, inner.scene_.get());
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, placement.matrix().data());
    rtcCommitGeometry(geometry);
    const unsigned id = rtcAttachGeometry(scene_.get(), geometry);
    rtcReleaseGeometry(geometry);  // the scene holds it
    check_embree("taking in a scene");
    return id;
  }

  /// All objects that are not Embree's own, as the primitives of one geometry.
  unsigned attach_others() {
    RTCGeometry geometry = rtcNewGeometry(embree_device(), RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, unsigned(others_.size()));
    rtcSetGeometryUserData(geometry, this);
    rtcSetGeometryBoundsFunction(geometry, bounds_of, nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersect_object);
    rtcSetGeometryOccludedFunction(geometry, occluded_by_object);
    rtcCommitGeometry(geometry);
    const unsigned id = rtcAttachGeometry(scene_.get(), geometry);
    rtcReleaseGeometry(geometry);  // the scene holds it
    check_embree("taking in objects");
    return id;
  }

  static const SceneObject& object_of(void* scene, unsigned primitive) {
    return *static_cast<const EmbreeScene*>(scene)->others_[primitive];
  }

  static void bounds_of(const RTCBoundsFunctionArguments* arguments) {
    const Bounds3 box = object_of(arguments->geometryUserPtr, arguments->primID).bounds();
    // Slightly enlarged: Embree's test of a flat box must not miss objects that lie exactly in its plane.
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

  /// The ray of a callback; within an instance the ray that Embree has transformed.
  static Ray ray_of(const Context& context, const RTCRay& query) {
    Ray ray = context.ray;
    ray.maximum = query.tfar;
    if (context.embree.instID[0] != RTC_INVALID_GEOMETRY_ID) {
      ray.origin = {query.org_x, query.org_y, query.org_z};
      ray.direction = {query.dir_x, query.dir_y, query.dir_z};
    }
    return ray;
  }

  static void intersect_object(const RTCIntersectFunctionNArguments* arguments) {
    if (!arguments->valid[0]) return;
    RTCRayHit& query = *reinterpret_cast<RTCRayHit*>(arguments->rayhit);
    const Context& context = *reinterpret_cast<const Context*>(arguments->context);
    const SceneObject& object = object_of(arguments->geometryUserPtr, arguments->primID);
    const Ray ray = ray_of(context, query.ray);
    const unsigned instance = context.embree.instID[0];
    if (context.list) {
      const int before = context.list->size;
      object.all_hits(ray, *context.list);
      for (int i = before; i < context.list->size; ++i) context.scene.note_way_out(instance, context.list->hits[i]);
      return;
    }
    if (!object.intersect(ray, *context.hit)) return;
    query.ray.tfar = context.hit->distance;
    query.hit.geomID = arguments->geomID;
    query.hit.primID = arguments->primID;
    query.hit.instID[0] = instance;
  }

  static void occluded_by_object(const RTCOccludedFunctionNArguments* arguments) {
    if (!arguments->valid[0]) return;
    RTCRay& query = *reinterpret_cast<RTCRay*>(arguments->ray);
    const Context& context = *reinterpret_cast<const Context*>(arguments->context);
    if (object_of(arguments->geometryUserPtr, arguments->primID).occludes(ray_of(context, query))) query.tfar = -infinity;
  }

  EmbreeSceneHandle scene_;
  std::vector<Geometry> geometries_;        // by Embree's geometry id
  std::vector<MovingTriangleView> views_;   // of all triangles, static or moving
  std::vector<const SceneObject*> others_;  // by Embree's primitive id within the user geometry
  int levels_ = 0;                          // of instances, as Embree counts them
  EmbreeClock clock_;
};

static const Register<EmbreeScene> registered;

}  // namespace etendue
