#pragma once
// Constructive solid geometry: solids made of closed objects by union, intersection and difference.

#include <memory>
#include <mutex>

#include "csg_walk.h"
#include "etendue/shader.h"  // objects own shaders

namespace etendue {

/// What union, intersection and difference share. Operands are placed in the solid's own coordinates; each may move, and may be
/// such a solid in turn. The surface of a solid consists of parts of its operands' surfaces, each with the surface coordinates
/// it has there; on what was taken away the sides are exchanged, and u runs backwards.
class Csg : public SceneObject {
 public:
  std::vector<Ref<SceneObject>> operands;

  void prepare() override;
  Bounds3 bounds() const override { return bounds_; }
  bool intersect(const Ray&, Hit&) const override;
  void all_hits(const Ray&, HitList&) const override;
  void surface_point(const Ray&, const Hit&, SurfacePoint&) const override;
  void tangents(SurfacePoint&) const override {}  // every point comes with them
  float area(float time) const override;
  float area_error(float time) const override;
  SurfaceSample sample_area(Point2 u, float time) const override;
  float area_pdf(const SurfacePoint&) const override;
  SurfaceSample sample_visible(const Point3& from, Point2 u, float time) const override;
  float visible_pdf(const Point3& from, const Vector3& direction, const SurfacePoint&) const override;
  bool closed() const override { return true; }
  int attribute(int number, const SurfacePoint&, float* values) const override;
  std::vector<SceneObject*> placed_within() const override;

  /// The operand a point lies on. `there` becomes the point as one of the operand: with its primitive and its object
  /// coordinates; the rest stays as it is on the solid.
  const SceneObject& operand_at(const SurfacePoint& p, SurfacePoint& there) const;

 protected:
  /// A point is inside when the weights of the operands it is inside of add up to `least_weight` or, if that is 0, to the
  /// number of operands. The first one's weight is 1.
  Csg(int weight_of_others, int least_weight);

  template <class T>
  static void describe_operands(Description<T>& d, const std::string& text) {
    d.group("Shape").template member<&Csg::operands>("operands", "", text, required, Effect::rebuild);
  }

 private:
  /// Part of the operand, or of an operand of it in turn, as one number: the number of the innermost operand in the upper bits,
  /// the number of its part in the lower ones.
  std::uint32_t encode(size_t operand, std::uint32_t primitive) const;
  size_t decode(std::uint32_t primitive, std::uint32_t& of_operand) const;

  void check_operand(SceneObject&);
  void number_parts();
  void combine_bounds();
  bool something_left() const;
  void own_hit(const CsgCrossing&, Hit&) const;
  void own_point(const Ray&, const Hit&, SurfacePoint&) const;
  float error_of_coincident(size_t operand, const SurfacePoint&) const;

  bool first_seen(const Point3& from, const Vector3& direction, float time, SurfacePoint&) const;

  // Chords along the axes, for area and samples; see csg_sampling.cpp.
  struct Place;  // where a chord passes, on a side of the bounds
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
  std::vector<const Csg*> nested_;         // for each operand; null: it is none of these
  std::vector<std::uint32_t> first_leaf_;  // the number of the first innermost operand in each
  std::uint32_t leaves_ = 0;
  std::uint64_t most_parts_ = 1;  // of one among them
  int shift_ = 32;                // bits of a primitive that number an innermost operand's own
  std::vector<float> times_;      // of all keys among the operands
  Bounds3 own_bounds_, bounds_;

  // Made when first asked for: only luminaires need them.
  struct Areas {
    std::once_flag made;
    std::vector<float> times, values;  // so many between each two keys [s], [m^2]
    float error = 0;
  };
  const Areas& areas() const;
  std::unique_ptr<Areas> areas_;
};

}  // namespace etendue
