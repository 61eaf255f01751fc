#pragma once
// Surfaces f = 0 in a box, and the solids f < 0 they bound: what quadrics, metaballs, grids of distances and formulas share.

#include <array>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "geometry/placed_object.h"

namespace etendue {

/// A point or a vector in an object's own coordinates [m]. Fields are computed in double.
using Place = std::array<double, 3>;

/// An object gives its field and says where along a line it changes sign; this class clips it by a box, closes the cuts
/// with faces when asked, finds the surface's area and chooses points on it.
class ImplicitObject : public PlacedObject {
 public:
  ~ImplicitObject() override;
  /// Its shape alone takes time, and light changes nothing of it.
  void prepare_again() override {}
  bool closed() const override { return closed_; }
  float area(float time) const override;
  float area_error(float time) const override;

 protected:
  ImplicitObject();

  /// Negative in the solid. Defined in the box.
  virtual double field(const Place&) const = 0;
  virtual Place gradient(const Place&) const = 0;
  /// The first t in [from, to] at which the ray, which at `from` is inside the solid or not, gets to the other side; then
  /// `inside` is changed.
  virtual bool next_crossing(const DoubleRay&, double from, double to, bool& inside, double& t) const = 0;
  /// False when the field surely has one sign in a box.
  virtual bool may_cross(const Place& low, const Place& high) const = 0;
  /// Interpolated for shading; zero: the geometric one.
  virtual Normal3 shading_normal(const Place&, const Normal3& /*geometric*/) const { return {}; }

  /// To be called at the end of prepare. `capped`: where the box cuts the solid, it has faces. Fails at the member when the
  /// box is wrong or there is nothing in it.
  void settle(const Point3& low, const Point3& high, bool capped, const char* member);

  Bounds3 own_bounds() const override { return own_bounds_; }
  bool own_intersect(const Ray&, Hit&) const override;
  void own_point(const Ray&, const Hit&, OwnPoint&) const override;
  double own_area() const override;
  float own_sample(Point2 u, OwnPoint&) const override;
  float own_pdf(const SurfacePoint&) const override;

 private:
  static constexpr int cells = 32;  // along the longest edge of the box
  using Cell = std::array<std::uint8_t, 3>;
  struct Patch;
  struct Table;
  struct Lazy;

  template <class F>
  void visit_crossings(const DoubleRay&, double from, const F& visit) const;
  void point_at(Place, int part, OwnPoint&, double off = 0) const;

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
  bool try_patch(const Patch&, double a, double b, double v, OwnPoint&) const;

  Place low_{}, high_{};
  bool capped_ = false, closed_ = false;
  int count_[3]{1, 1, 1};       // of cells along each axis
  std::vector<Cell> crossed_;   // cells the surface may pass through
  std::unique_ptr<Lazy> lazy_;  // what only area and samples need, found when they are first asked for
  Bounds3 own_bounds_;
};

}  // namespace etendue
