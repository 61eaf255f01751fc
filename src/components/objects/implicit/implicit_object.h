#pragma once
// ImplicitObject: base class of implicit surfaces f = 0 in a box, and of the solids f < 0 that they bound: quadrics, metaballs,
// signed distance grids and formulas.

#include <array>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "etendue/placed_object.h"
#include "geometry/double_ray.h"
#include "geometry/geometry.h"

namespace etendue {

/// A point or a vector in object space [m]. Fields are computed in double.
using Place = std::array<double, 3>;

/// A derived class implements the field and finds its sign changes along a line; this class clips the surface to a box,
/// optionally caps the cuts with faces, and computes and samples the area.
class ImplicitObject : public PlacedObject {
 public:
  ~ImplicitObject() override;
  /// Only building the shape takes time, and changes of emission do not affect it.
  void prepare_again() override {}
  bool closed() const override { return closed_; }
  float area(float time) const override;
  float area_error(float time) const override;

 protected:
  ImplicitObject();

  /// The field f: negative in the solid, defined in the box.
  virtual double field(const Place&) const = 0;
  virtual Place gradient(const Place&) const = 0;
  /// Finds the first t in [from, to] at which the ray crosses the surface. `inside` is the side at `from`, and is inverted if a
  /// crossing is found.
  virtual bool next_crossing(const DoubleRay&, double from, double to, bool& inside, double& t) const = 0;
  /// A conservative test: false only if the field has the same sign everywhere in a box.
  virtual bool may_cross(const Place& low, const Place& high) const = 0;
  /// Shading normal; zero stands for the geometric one.
  virtual Normal3 shading_normal(const Place&, const Normal3& /*geometric*/) const { return {}; }

  /// To be called at the end of prepare. With `capped`, the solid has faces where the box cuts it. Throws Error, located at
  /// `member`, if the box is invalid or contains no surface.
  void settle(const Point3& low, const Point3& high, bool capped, const char* member);

  Bounds3 local_bounds() const override { return own_bounds_; }
  bool local_intersect(const Ray&, Hit&) const override;
  void local_point(const Ray&, const Hit&, LocalPoint&) const override;
  double local_area() const override;
  float local_sample(Point2 u, LocalPoint&) const override;
  float local_pdf(const SurfacePoint&) const override;

 private:
  static constexpr int cells = 32;  // along the longest edge of the box
  using Cell = std::array<std::uint8_t, 3>;
  struct Patch;
  struct Table;
  struct Lazy;

  template <class F>
  void visit_crossings(const DoubleRay&, double from, const F& visit) const;
  /// Points on face 2 k + s of the box, which is perpendicular to axis k at its low (s = 0) or high (s = 1) end, are on part
  /// first_face + 2 k + s; the parts below it are the surface.
  static constexpr int first_face = 6;
  void point_at(Place, int part, LocalPoint&, double off = 0) const;

  double edge(int k, int i) const;
  void cell_box(const Cell&, Place& low, Place& high) const;
  void find_cells(const std::array<int, 3>& from, const std::array<int, 3>& to);
  bool any_surface() const;
  void visit_borders(const std::function<void(const Cell&, int face, bool inside)>& visit) const;
  template <class F>
  void visit_line(const Cell&, int axis, double a, double b, const F& visit) const;

  const Table& table() const;
  void tabulate(Table&) const;
  double face_area(const Cell&, int face, double& off) const;
  bool try_patch(const Patch&, double a, double b, double v, LocalPoint&) const;

  Place low_{}, high_{};
  bool capped_ = false, closed_ = false;
  int count_[3]{1, 1, 1};       // number of cells along each axis
  std::vector<Cell> crossed_;   // cells that the surface may cross
  std::unique_ptr<Lazy> lazy_;  // data for area and samples, computed at the first use
  Bounds3 own_bounds_;
};

}  // namespace etendue
