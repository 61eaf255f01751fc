#pragma once
// PlacedLuminaire: what stands for a luminaire of a nested scene in one of the places where that scene stands.

#include <optional>

#include "etendue/scene.h"
#include "geometry/geometry.h"

namespace etendue {

/// One of the scenes, or instances, that lie in one another around an object.
struct Placement {
  const SceneObject* scene = nullptr;
  const Placement* outer = nullptr;  ///< null: it stands in the outermost scene
};

/// Carries a point out of a nested scene. A structure may take rays into it by an inverse of its own, in single precision:
/// where Transform's rounds one row by its own terms, that one may by the largest of all (see EmbreeScene, which checks it).
inline void carry_out_of_scene(const Transform& transform, SurfacePoint& point) {
  carry_out(transform, point);
  const Point3& p = point.position;
  point.error += rounding_bound(8) * (std::abs(p.x) + std::abs(p.y) + std::abs(p.z));
}

/// The transforms of nested scenes at a time: M is all of them, from the coordinates of the innermost to those of the outermost
/// scene. They are applied one by one, as rays are taken in and hits carried out.
class WayOut {
 public:
  WayOut(const Placement* innermost, float time);

  Point3 back(Point3) const;
  Vector3 back(Vector3) const;
  Vector3 operator()(Vector3) const;
  void carry_out(SurfacePoint&) const;
  /// The other way: positions, normals and the error. Tangents become zero.
  void take_in(SurfacePoint&) const;
  Ray into(const Ray&) const;
  /// |det M|: by how much volumes grow.
  double volume() const;
  /// By how much an area with a unit normal inside grows: |det M| |M^-T n|.
  double area_stretch(const Normal3&) const;
  /// By how much M enlarges when it is a similarity; 0: it is none.
  float similarity() const;
  Normal3 carry(Normal3) const;  ///< M^-T n, not normalized

 private:
  int size_ = 0;
  const Transform* steps_[Hit::deepest_nesting];  // innermost first; those that do nothing are left out
  std::optional<Transform> moved_[Hit::deepest_nesting];
};

/// How the normals of an object are spread over its area: to find areas under transforms that are no similarities.
class NormalSpread {
 public:
  NormalSpread(const SceneObject&, float time);
  struct MediumInterval {
    double value = 0, error = 0;  ///< the latter relative
  };
  /// By how much the way out enlarges the object's area.
  MediumInterval stretch(const WayOut&) const;

 private:
  struct Part {
    Normal3 normal;
    float weight;
  };
  std::vector<Part> fine_, coarse_;  // how far these differ tells the error; none: exact
};

class NestedLuminaires;

/// In all it does it asks the object in the nested scene, which may stand for another one itself where an Instance has replaced
/// shaders. With M the map from there to the outermost scene:
///   per area,         p = p_inner / (|det M| |M^-T n|), n the unit normal inside;
///   per solid angle,  p = p_inner |M w|^3 / |det M|, w the unit direction inside: a cone of directions dw around w cuts the
///                     volume dw r^3 / 3 out of a ball, which M enlarges by det M, and r by |M w|.
/// A point's density does not change, as no transform changes how strong it is; nor does a single direction's.
///
/// Its area is that of the outermost scene, so an amount of light an emission is asked for is what it gives off there.
class PlacedLuminaire final : public SceneObject {
 public:
  static void describe(Description<PlacedLuminaire>&);

  /// `inner` is what hits name.
  PlacedLuminaire(const SceneObject& inner, const Placement&, const NestedLuminaires&);

  const SceneObject& inner() const { return *inner_; }
  const Placement& place() const { return place_; }
  /// How far its area is stretched, to be called before it is used. `still` is the inner object's at time 0, null: a formula
  /// does.
  void find_stretch(const NormalSpread* still);

  const SceneObject& original() const override { return inner_->original(); }
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
  Bounds3 luminaire_bounds() const override { return swept_out(inner_->luminaire_bounds()); }
  NormalCone normals() const override;
  bool closed() const override { return inner_->closed(); }
  bool infinite() const override { return inner_->infinite(); }
  bool delta() const override { return inner_->delta(); }
  int attribute(int number, const SurfacePoint& p, float* values) const override {
    return inner_->attribute(number, p, values);
  }

 private:
  Bounds3 swept_out(Bounds3) const;
  SurfacePoint inside(const WayOut&, const SurfacePoint&) const;
  void own(const WayOut&, SurfaceSample&) const;
  double area_under(const WayOut&, float time) const;

  Ref<const SceneObject> inner_;
  const Placement& place_;
  const NestedLuminaires& all_;
  float stretch_ = 0, stretch_error_ = 0;  // of the area, where nothing moves
};

}  // namespace etendue
