#pragma once
// Scene: a set of objects with an acceleration structure for ray intersection (Aggregate in pbrt, Scene and its kd-tree in
// Mitsuba), and Instance, another placement of a scene. Both are SceneObjects themselves, so scenes nest.
//
// A new acceleration structure must implement `build`, `find_nearest` and `find_any`. Optional: `find_all`, so that coincident
// surfaces are found. Everything else (lists of luminaires, nesting, invisible objects, media) is implemented here.

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "etendue/infinite_object.h"
#include "etendue/object_container.h"

namespace etendue {

class CoincidentLuminaires;
class NestedLuminaires;

class Scene : public SceneObject, public ObjectContainer {
 public:
  using Interface = Scene;
  using Parent = SceneObject;
  static void describe(Description<Scene>&);

  std::vector<Ref<SceneObject>> objects;

  /// Finds the nearest hit with t in (0, ray.maximum).
  bool nearest(const Ray& ray, Hit& hit) const { return careful_ ? nearest_with_care(ray, hit) : find_nearest(ray, hit); }
  /// Whether any object occludes the ray.
  bool any(const Ray& ray) const { return find_any(ray) || (unseen_ && !ray.of_camera && unseen_->find_any(ray)); }

  /// Whether a shadow ray is occluded (null: no shadow ray), and the nearest hit of another ray. The two queries are
  /// independent, so the processor overlaps them if one directly follows the other (docs/decisions/008-numbers-at-once.md).
  struct AnyAndNearest {
    bool any, nearest;
  };
  AnyAndNearest any_and_nearest(const Ray* shadow, const Ray& ray, Hit& hit) const {
    const bool blocked = shadow && any(*shadow);
    return {blocked, nearest(ray, hit)};
  }

  /// Adds all hits along a short ray, in no order; a structure that does not implement find_all adds the nearest only. Objects
  /// with a hit already in the list may be omitted.
  void all(const Ray& ray, HitList& list) const {
    find_all(ray, list);
    if (unseen_ && !ray.of_camera) all_unseen(ray, list);
  }

  /// The surface point of a hit found by `nearest`, transformed out of all nested scenes that contain it.
  void locate(const Ray& ray, const Hit& hit, SurfacePoint& point) const {
    locate_alone(ray, hit, point);
    if (coincident_) [[unlikely]]
      widen_coincident(hit, point);
  }
  /// The same without widening the point's error to that of coincident surfaces.
  void locate_alone(const Ray& ray, const Hit& hit, SurfacePoint& point) const {
    if (hit.depth == 0) [[likely]]
      hit.object->surface_point(ray, hit, point);
    else
      locate_nested(ray, hit, point);
    point.footprint = ray.width + ray.spread * hit.distance;
    point.footprint_cosine = std::abs(dot(point.normal, ray.direction));
    point.ray_direction = ray.direction;
  }
  /// Whether a sampled point of a luminaire is the surface that is visible from a direction, where several surfaces coincide.
  /// Exactly one of them is visible, the same that rays from that direction hit (see CoincidentLuminaires). Must be called for
  /// sampled points only; points hit by rays are visible. Widens the point's error to that of all coincident surfaces.
  bool in_front(SurfacePoint& point, const Vector3& direction) const {
    return !coincident_ || in_front_of_coincident(point, direction);
  }

  /// The objects that emit, including those at infinity. A luminaire in a nested scene is in the list once for each placement
  /// of that scene, represented by a proxy (see SceneObject::original), which is also the object of surface points on it.
  std::span<const SceneObject* const> luminaires() const { return luminaires_; }
  /// The luminaires at infinity that a ray sees if it hits nothing; without delta lights.
  std::span<const SceneObject* const> infinite_luminaires(const Ray& ray) const {
    return ray.of_camera ? std::span(infinite_).first(infinite_seen_) : std::span(infinite_);
  }
  /// Whether some objects are invisible to the camera (SceneObject::visible_to_camera).
  bool has_unseen() const { return has_unseen_; }
  /// The bounding sphere of all finite objects.
  Point3 centre() const { return bounds_.empty() ? Point3{} : bounds_.centre(); }
  float radius() const { return bounds_.empty() ? 1.0f : length(bounds_.diagonal()) / 2; }
  /// Whether paths can enter any object, so that media and refractive indices must be tracked.
  bool has_interiors() const { return has_interiors_; }
  /// Whether any surface has null scattering, so that shadow rays may have to continue through surfaces.
  bool has_null_surfaces() const { return has_null_surfaces_; }
  /// Whether any surface or medium fluoresces, so that the wavelengths of a path may change.
  bool has_fluorescence() const { return has_fluorescence_; }
  /// Whether a point may lie inside an object that paths can enter: a quick conservative test by bounding boxes.
  bool maybe_inside(const Point3& position) const {
    for (const Bounds3& box : interiors_)
      if (box.contains(position)) return interior_tree_.empty() || in_interior_tree(position);
    return false;
  }
  /// The object whose interior fills all space outside of other objects; null: vacuum.
  const SurroundingObject* surroundings() const { return surroundings_; }
  /// Whether the scene chooses the origin of its object space when it is prepared (see AnimatedTransform).
  bool chooses_origin() const { return chooses_origin_at_.has_value(); }
  /// The depth of nested scenes; 0: the scene contains no other scene.
  int nesting() const { return nesting_; }
  /// A new unique number each time a scene is prepared.
  std::uint64_t version() const { return version_; }
  /// Area [m^2] of the contained finite objects, in the scene's object space.
  double own_area(float time) const;
  /// The same under a transform; exact if the transform is a similarity.
  float placed_area(const AnimatedTransform& placed, float time) const;

  // The scene as an object in another scene: transforms the ray into object space and calls the functions above.
  void prepare() override;
  void prepare_again() override;
  Bounds3 bounds() const override;
  Extent extent() const override { return unbounded_ ? Extent::unbounded : Extent::bounded; }
  std::vector<SceneObject*> placed_within() const override;
  bool intersect(const Ray&, Hit&) const override;
  bool occludes(const Ray&) const override;
  void all_hits(const Ray&, HitList&) const override;
  void surface_point(const Ray&, const Hit&, SurfacePoint&) const override;
  void tangents(SurfacePoint&) const override;
  float area(float time) const override;
  SurfaceSample sample_area(Point2 u, float time) const override;

 protected:
  /// Builds the acceleration structure over finite objects; called by `prepare`. Objects that are invisible to the camera are
  /// not included: they have a separate structure, so subclasses need not handle them.
  virtual void build(std::span<const SceneObject* const> finite) = 0;
  /// `nearest`, `any` and `all` for the objects of `build`.
  virtual bool find_nearest(const Ray&, Hit&) const = 0;
  virtual bool find_any(const Ray&) const = 0;
  virtual void find_all(const Ray& ray, HitList& list) const {
    Hit hit;
    if (find_nearest(ray, hit)) list.add(hit);
  }

 private:
  friend class Instance;
  friend struct SceneRecordAccess;
  void require_good_objects();
  struct Finite {
    std::vector<const SceneObject*> seen, unseen;  // visible and invisible to the camera
  };
  Finite survey();
  void note_interior(const SceneObject&);
  void choose_origin();
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

  Bounds3 bounds_;  // of the objects, in the scene's object space
  std::vector<const SceneObject*> luminaires_;
  std::vector<const SceneObject*> infinite_;                // luminaires at infinity; those visible to the camera come first
  size_t infinite_seen_ = 0;                                // the number of those visible to the camera
  Ref<Scene> unseen_;                                       // finite objects invisible to the camera; null: none
  std::shared_ptr<const CoincidentLuminaires> coincident_;  // null: none, or this scene is nested in another one
  bool careful_ = false;                                    // whether unseen_ or coincident_ is set
  const SurroundingObject* surroundings_ = nullptr;
  std::shared_ptr<const NestedLuminaires> nested_;  // null: none, or this scene is nested in another one
  std::vector<Bounds3> interiors_;  // bounds of the objects that paths can enter, and of scenes with such objects; if there are
                                    // many, only their union, and interior_tree_
  bool has_interiors_ = false, has_null_surfaces_ = false, has_unseen_ = false, unbounded_ = false, has_fluorescence_ = false;
  struct Node {
    Bounds3 box;
    std::uint32_t next = 0;  // index of the node after all descendants; 0 for a leaf
  };
  std::vector<Node> interior_tree_;  // in depth-first order
  int nesting_ = 0;
  std::uint64_t version_ = 0;
  std::optional<float> chooses_origin_at_;  // set by the Job: the time at which the shutter opens [s]
};

class ShaderReplacement;

/// Another placement of a scene (object instancing): any number of instances share its objects and acceleration structure.
class Instance final : public SceneObject {
 public:
  static void describe(Description<Instance>&);

  Ref<Scene> scene;

  /// Completes a hit that was found in the scene by a ray in its object space: appends this instance to Hit::scenes, and
  /// replaces the object by its proxy if this instance has a shader of its own.
  void note_way_out(Hit&) const;
  /// The proxies that hits in this instance refer to instead of the scene's objects; null: there are none.
  const ShaderReplacement* replacement() const { return replacement_.get(); }

  void prepare() override;
  Bounds3 bounds() const override;
  Extent extent() const override { return scene ? scene->extent() : Extent::bounded; }
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

/// The object itself if it is a scene, the placed scene if it is an instance; null for all other objects.
const Scene* scene_within(const SceneObject&);

}  // namespace etendue
