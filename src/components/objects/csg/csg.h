#pragma once
// Constructive solid geometry: solids made of closed objects by union, intersection and difference.

#include <memory>
#include <mutex>

#include "csg_walk.h"
#include "etendue/mesh_facts.h"
#include "etendue/object_container.h"

namespace etendue {

/// Base class of union, intersection and difference. Operands are placed in the solid's object space; each may move, and may be
/// a CSG solid itself. The surface of a solid consists of parts of its operands' surfaces, each with the operand's surface
/// coordinates; on the surface of a subtracted operand the sides are exchanged, and u is reversed.
class Csg : public SceneObject, public ObjectContainer, private MeshFacts {
 public:
  std::vector<Ref<SceneObject>> operands;

  void prepare() override;
  Bounds3 bounds() const override { return bounds_; }
  bool intersect(const Ray&, Hit&) const override;
  void all_hits(const Ray&, HitList&) const override;
  void surface_point(const Ray&, const Hit&, SurfacePoint&) const override;
  /// surface_point sets the tangents of every point. Here they are computed for a point that has lost them.
  void tangents(SurfacePoint&) const override;
  float area(float time) const override;
  float area_error(float time) const override;
  SurfaceSample sample_area(Point2 u, float time) const override;
  float area_pdf(const SurfacePoint&) const override;
  SurfaceSample sample_visible(const Point3& from, Point2 u, float time) const override;
  float visible_pdf(const Point3& from, const Vector3& direction, const SurfacePoint&) const override;
  bool closed() const override { return true; }
  const MeshFacts* mesh_facts() const override { return this; }
  std::vector<SceneObject*> placed_within() const override;

  /// The operand whose surface a point lies on. `there` receives the primitive, the object and the object coordinates of the
  /// point on the operand; its other fields are unchanged.
  const SceneObject& operand_at(const SurfacePoint& p, SurfacePoint& there) const;

 protected:
  /// A point is inside the solid if the weights of the operands that contain it add up to at least `least_weight` or, if that
  /// is 0, to the number of operands. The first operand's weight is 1.
  Csg(int weight_of_others, int least_weight);

  template <class T>
  static void describe_operands(Description<T>& d, const std::string& text) {
    d.group("Shape").template member<&Csg::operands>("operands", "", text, required, Effect::rebuild);
  }

 private:
  /// Encodes a primitive of an operand in one number: the number of the innermost operand (leaf of the CSG tree) in the upper
  /// bits, the number of its part in the lower ones.
  std::uint32_t encode(size_t operand, std::uint32_t primitive) const;
  size_t decode(std::uint32_t primitive, std::uint32_t& of_operand) const;

  /// The attribute of the operand whose surface the point lies on.
  int attribute(int number, const SurfacePoint&, float* values) const override;

  void check_operand(SceneObject&);
  void number_parts();
  void combine_bounds();
  bool something_left() const;
  void own_hit(const CsgCrossing&, Hit&) const;
  void own_point(const Ray&, const Hit&, SurfacePoint&) const;
  float error_of_coincident(size_t operand, const SurfacePoint&) const;

  bool first_seen(const Point3& from, const Vector3& direction, float time, SurfacePoint&) const;

  // Chords: lines along the axes, for area and samples; see csg_sampling.cpp.
  struct Place;  // position of a chord on a side of the bounding box
  Ray chord(const Place&, int axis, float time) const;
  static Place lattice_place(int i, int chords, int step);
  Place place_of(const Point3&, int axis) const;
  int crossings(const Ray&) const;
  double chord_area(const Transform&, float time, int chords, int step) const;
  double own_pdf(const Point3&, const Normal3&, float time) const;
  double side_area(int axis) const;

  const int weight_of_others_, given_least_weight_;
  int least_weight_ = 1;
  std::vector<CsgOperand> combined_;
  std::vector<const Csg*> nested_;         // for each operand; null if it is not a CSG solid
  std::vector<std::uint32_t> first_leaf_;  // for each operand, the number of its first leaf
  std::uint32_t leaves_ = 0;
  std::uint64_t most_parts_ = 1;  // largest number of parts of a leaf
  int shift_ = 32;                // number of low bits of a primitive that hold the leaf's own primitive
  std::vector<float> times_;      // times of all keys of the solid and its operands
  Bounds3 own_bounds_, bounds_;

  // Computed at the first call, since only luminaires need them.
  struct Areas {
    std::once_flag made;
    std::vector<float> times, values;  // area samples [m^2] and their times [s], several between two keys
    float error = 0;
  };
  const Areas& areas() const;
  std::unique_ptr<Areas> areas_;
};

}  // namespace etendue
