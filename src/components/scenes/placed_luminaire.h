#pragma once
// PlacedLuminaire: represents a luminaire of a nested scene in one of the scene's placements.

#include <optional>

#include "etendue/mesh_facts.h"
#include "etendue/scene.h"
#include "geometry/geometry.h"

namespace etendue {

/// One of the nested scenes, or instances, that contain an object: a list from the innermost outwards.
struct Placement {
  const SceneObject* scene = nullptr;
  const Placement* outer = nullptr;  ///< null: `scene` is an object of the outermost scene
};

/// Transforms a point from a nested scene to the scene around it. A structure may transform rays into the nested scene by its
/// own inverse in single precision. Where the rounding error of each row of Transform's inverse depends on the terms of this
/// row, that of the structure's inverse may depend on the largest term of all rows (see EmbreeScene, which checks its inverse),
/// so the point's error is enlarged.
inline void carry_out_of_scene(const Transform& transform, SurfacePoint& point) {
  carry_out(transform, point);
  const Point3& p = point.position;
  point.error += rounding_bound(8) * (std::abs(p.x) + std::abs(p.y) + std::abs(p.z));
}

/// The transforms of nested scenes at a time: M is their product, from the coordinates of the innermost to those of the
/// outermost scene. They are applied one by one, as rays are transformed inwards and hits outwards.
class WayOut {
 public:
  WayOut(const Placement* innermost, float time);

  Point3 back(Point3) const;
  Vector3 back(Vector3) const;
  Vector3 operator()(Vector3) const;
  void carry_out(SurfacePoint&) const;
  /// The inverse of carry_out for position, normals and error. Tangents become zero.
  void take_in(SurfacePoint&) const;
  Ray into(const Ray&) const;
  /// |det M|, the scale factor of volumes.
  double volume() const;
  /// The scale factor of an area with a unit normal n in the nested scene: |det M| |M^-T n|.
  double area_stretch(const Normal3&) const;
  /// The scale factor of lengths if M is a similarity, else 0.
  float similarity() const;
  Normal3 carry(Normal3) const;  ///< M^-T n, not normalized

 private:
  int size_ = 0;
  const Transform* steps_[Hit::deepest_nesting];  // innermost first, without identities
  std::optional<Transform> moved_[Hit::deepest_nesting];
};

/// The distribution of an object's normals over its area, for computing its area under transforms that are not similarities.
class NormalSpread {
 public:
  NormalSpread(const SceneObject&, float time);
  struct Stretch {
    double value = 0, error = 0;  ///< the scale factor, and its relative error
  };
  /// The factor by which M scales the object's area.
  Stretch stretch(const WayOut&) const;

 private:
  struct Part {
    Normal3 normal;
    float weight;
  };
  std::vector<Part> fine_, coarse_;  // the difference of their results estimates the error; coarse_ empty: exact
};

class NestedLuminaires;

/// All functions call those of the object in the nested scene, which may itself be a stand-in if an Instance replaces shaders.
/// With M the transform from the nested scene to the outermost scene, the pdfs are
///   per area,         p = p_inner / (|det M| |M^-T n|), n the unit normal in the nested scene;
///   per solid angle,  p = p_inner |M w|^3 / |det M|, w the unit direction in the nested scene: a cone of directions dw around
///   w
///                     cuts the volume dw r^3 / 3 out of a ball; M scales this volume by |det M| and r by |M w|.
/// The pdf of a point light does not change, as transforms do not change its intensity; nor does that of a single direction.
///
/// The area is measured in the outermost scene, so a requested amount of light (ShapedEmission) is the amount emitted there.
class PlacedLuminaire final : public SceneObject, private MeshFacts {
 public:
  static void describe(Description<PlacedLuminaire>&);

  /// `inner` is the object that hits refer to.
  PlacedLuminaire(const SceneObject& inner, const Placement&, const NestedLuminaires&);

  const SceneObject& inner() const { return *inner_; }
  const Placement& place() const { return place_; }
  /// Computes the scale factor of the area; must be called before the object is used. `still` is the NormalSpread of the inner
  /// object at time 0; null: it is not needed.
  void find_stretch(const NormalSpread* still);

  Bounds3 bounds() const override { return swept_out(inner_->bounds()); }
  bool intersect(const Ray&, Hit&) const override;
  bool occludes(const Ray&) const override;
  void surface_point(const Ray&, const Hit&, SurfacePoint&) const override;
  void tangents(SurfacePoint&) const override;
  float area(float time) const override;
  float area_error(float time) const override { return inner_->area_error(time) + stretch_error_; }
  SurfaceSample sample_area(Point2 u, float time) const override;
  float area_pdf(const SurfacePoint&) const override;
  SurfaceSample sample_visible(const Point3& from, Point2 u, float time) const override;
  float visible_pdf(const Point3& from, const Vector3& direction, const SurfacePoint&) const override;
  LuminaireBounds luminaire_bounds() const override;
  bool closed() const override { return inner_->closed(); }
  Extent extent() const override { return inner_->extent(); }
  const MeshFacts* mesh_facts() const override { return this; }

 private:
  // The attributes alone: the triangles of the object in the nested scene are in other coordinates.
  int attribute(int number, const SurfacePoint& p, float* values) const override {
    const MeshFacts* facts = inner_->mesh_facts();
    return facts ? facts->attribute(number, p, values) : 0;
  }

  NormalCone carried_out(const NormalCone&) const;
  Bounds3 swept_out(Bounds3) const;
  SurfacePoint inside(const WayOut&, const SurfacePoint&) const;
  void own(const WayOut&, SurfaceSample&) const;
  double area_under(const WayOut&, float time) const;

  Ref<const SceneObject> inner_;
  const Placement& place_;
  const NestedLuminaires& all_;
  float stretch_ = 0, stretch_error_ = 0;  // scale factor of the area and its error, if nothing moves
};

}  // namespace etendue
