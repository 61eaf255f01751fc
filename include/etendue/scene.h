#pragma once
// Scene (an accelerator): finds what rays hit. Is itself a SceneObject, so scenes nest.

#include <memory>
#include <span>
#include <vector>

#include "etendue/scene_object.h"

namespace etendue {

class CoincidentLuminaires;
class NestedLuminaires;

class Scene : public SceneObject {
 public:
  using Interface = Scene;
  using Parent = SceneObject;
  static void describe(Description<Scene>&);

  std::vector<Ref<SceneObject>> objects;
  /// Of a nested scene that may choose, when it is prepared, from which point its objects count: the time at which the shutter
  /// opens [s]. Set by the Job.
  std::optional<float> chooses_centre;

  /// The nearest hit with t in (0, ray.maximum).
  bool nearest(const Ray& ray, Hit& hit) const { return careful_ ? nearest_with_care(ray, hit) : find_nearest(ray, hit); }
  /// Whether anything lies on the ray.
  bool any(const Ray& ray) const { return find_any(ray) || (unseen_ && !ray.of_camera && unseen_->find_any(ray)); }

  /// Whether anything lies on a shadow ray (null: there is none), and what the nearest hit of another one is. The two need
  /// nothing of each other, and asked one right after the other the processor works on both at once
  /// (docs/decisions/008-numbers-at-once.md).
  struct AnyAndNearest {
    bool any, nearest;
  };
  AnyAndNearest any_and_nearest(const Ray* shadow, const Ray& ray, Hit& hit) const {
    const bool blocked = shadow && any(*shadow);
    return {blocked, nearest(ray, hit)};
  }

  /// Every hit on a short ray, in no order; a scene that cannot tell gives the nearest. Objects that have a hit in the list
  /// already may be left out.
  void all(const Ray& ray, HitList& list) const {
    find_all(ray, list);
    if (unseen_ && !ray.of_camera) all_unseen(ray, list);
  }

  /// The surface point of a hit found by `nearest`, through all the nested scenes it lies in.
  void locate(const Ray& ray, const Hit& hit, SurfacePoint& point) const {
    locate_alone(ray, hit, point);
    if (coincident_) [[unlikely]]
      widen_coincident(hit, point);
  }
  /// The same, whatever else lies in that place.
  void locate_alone(const Ray& ray, const Hit& hit, SurfacePoint& point) const {
    if (hit.depth == 0) [[likely]]
      hit.object->surface_point(ray, hit, point);
    else
      locate_nested(ray, hit, point);
    point.footprint = ray.width + ray.spread * hit.distance;
    point.footprint_cosine = std::abs(dot(point.normal, ray.direction));
    point.ray_direction = ray.direction;
  }
  /// Whether the light that leaves a point of a luminaire in a direction is seen from there: in one place with others, one
  /// surface alone is, the same which rays from there meet (see CoincidentLuminaires). To be asked of points that were sampled;
  /// those that a ray met are seen. The point's error is then that of all surfaces there.
  bool in_front(SurfacePoint& point, const Vector3& direction) const {
    return !coincident_ || in_front_of_coincident(point, direction);
  }

  /// Objects that emit, those at infinity included. One in a nested scene is in the list once for each place where that
  /// stands, by an object that stands for it there (see SceneObject::original), as points on it name it.
  std::span<const SceneObject* const> luminaires() const { return luminaires_; }
  /// Luminaires at infinity that such a ray sees when it hits nothing; those without extent are not among them.
  std::span<const SceneObject* const> infinite_luminaires(const Ray& ray) const {
    return ray.of_camera ? std::span(infinite_).first(infinite_seen_) : std::span(infinite_);
  }
  /// Whether the camera is not to see everything that is in it.
  bool has_unseen() const { return has_unseen_; }
  /// A sphere around all finite objects.
  Point3 centre() const { return bounds_.empty() ? Point3{} : bounds_.centre(); }
  float radius() const { return bounds_.empty() ? 1.0f : length(bounds_.diagonal()) / 2; }
  /// Whether any surface lets paths into objects, so that media and indices must be tracked.
  bool has_interiors() const { return has_interiors_; }
  /// Whether any surface lets some light pass straight on, so that shadow rays may have to go through surfaces.
  bool has_null_surfaces() const { return has_null_surfaces_; }
  /// Whether a point may lie inside an object that paths can enter: a quick test by bounds.
  bool maybe_inside(const Point3& p) const {
    for (const Bounds3& box : interiors_)
      if (box.contains(p)) return interior_tree_.empty() || in_interior_tree(p);
    return false;
  }
  /// What all of space outside of other objects is filled with; null: nothing.
  const SceneObject* surroundings() const { return surroundings_; }
  /// How deep the scenes in it lie in one another; 0: it holds none.
  int nesting() const { return nesting_; }
  /// Another number each time a scene is prepared.
  std::uint64_t version() const { return version_; }
  /// Area [m^2] of the finite objects in it, in its own coordinates.
  double own_area(float time) const;
  /// The same for a scene that is an object under this transform: exact when that is a similarity.
  float placed_area(const AnimatedTransform& placed, float time) const;

  // As an object in another scene: transforms the ray and asks itself.
  void prepare() override;
  void prepare_again() override;
  Bounds3 bounds() const override;
  bool unbounded() const override { return unbounded_; }
  std::vector<SceneObject*> placed_within() const override;
  bool intersect(const Ray&, Hit&) const override;
  bool occludes(const Ray&) const override;
  void all_hits(const Ray&, HitList&) const override;
  void surface_point(const Ray&, const Hit&, SurfacePoint&) const override;
  void tangents(SurfacePoint&) const override;
  float area(float time) const override;
  SurfaceSample sample_area(Point2 u, float time) const override;

 protected:
  /// Builds the structure over finite objects; called by prepare. What the camera does not see is not among them: it has a
  /// structure of its own, so that none need know of it.
  virtual void build(std::span<const SceneObject* const> finite) = 0;
  /// What `nearest`, `any` and `all` say, of what was built.
  virtual bool find_nearest(const Ray&, Hit&) const = 0;
  virtual bool find_any(const Ray&) const = 0;
  virtual void find_all(const Ray& ray, HitList& list) const {
    Hit hit;
    if (find_nearest(ray, hit)) list.add(hit);
  }

 private:
  friend class Instance;
  void require_good_objects();
  struct Finite {
    std::vector<const SceneObject*> seen, unseen;  // by the camera
  };
  Finite survey();
  void note_interior(const SceneObject&);
  void choose_centre();
  void locate_nested(const Ray&, const Hit&, SurfacePoint&) const;
  Bounds3 placed_bounds(const AnimatedTransform& placed) const;
  bool nearest_with_care(const Ray&, Hit&) const;
  bool nearest_with_unseen(const Ray&, Hit&) const;
  void find_coincident();
  void widen_coincident(const Hit&, SurfacePoint&) const;
  bool in_front_of_coincident(SurfacePoint&, const Vector3& direction) const;
  void all_unseen(const Ray&, HitList&) const;
  bool note_unseen(const SceneObject&);
  bool in_interior_tree(const Point3&) const;
  void build_interior_tree(std::span<Bounds3>);

  Bounds3 bounds_;  // of the objects, in the scene's own coordinates
  std::vector<const SceneObject*> luminaires_;
  std::vector<const SceneObject*> infinite_;                // those that the camera sees come first
  size_t infinite_seen_ = 0;                                // so many
  Ref<Scene> unseen_;                                       // finite objects that the camera does not see; null: there are none
  std::shared_ptr<const CoincidentLuminaires> coincident_;  // null: there are none, or this scene is a nested one itself
  bool careful_ = false;                                    // whether `nearest` has to mind either
  const SceneObject* surroundings_ = nullptr;
  std::shared_ptr<const NestedLuminaires> nested_;  // null: there are none, or this scene is a nested one itself
  std::vector<Bounds3> interiors_;  // of the objects that paths can enter, and of scenes in which there are such; of many
                                    // such only the union, and the tree
  bool has_interiors_ = false, has_null_surfaces_ = false, has_unseen_ = false, unbounded_ = false;
  struct Node {
    Bounds3 box;
    std::uint32_t next = 0;  // after all below it; of a leaf 0
  };
  std::vector<Node> interior_tree_;  // depth first
  int nesting_ = 0;
  std::uint64_t version_ = 0;
};

class ShaderReplacement;

/// A scene placed once more: any number of instances share what is in it and the structure over it.
class Instance final : public SceneObject {
 public:
  static void describe(Description<Instance>&);

  Ref<Scene> scene;

  /// Completes a hit found in the scene, with a ray in its coordinates: notes the way out, and what stands for the object
  /// when this instance has a shader of its own.
  void note_way_out(Hit&) const;
  /// What hits in this instance may name instead of the scene's own objects; null: those themselves.
  const ShaderReplacement* replacement() const { return replacement_.get(); }

  void prepare() override;
  Bounds3 bounds() const override;
  bool unbounded() const override;
  bool intersect(const Ray&, Hit&) const override;
  bool occludes(const Ray&) const override;
  void all_hits(const Ray&, HitList&) const override;
  void surface_point(const Ray&, const Hit&, SurfacePoint&) const override;
  void tangents(SurfacePoint&) const override;
  float area(float time) const override;
  SurfaceSample sample_area(Point2 u, float time) const override;

 private:
  std::shared_ptr<const ShaderReplacement> replacement_;
};

/// The scene that an object is or places; null for all other objects.
const Scene* scene_within(const SceneObject&);

}  // namespace etendue
