#pragma once
// BezierObject: base class of shapes made of Bézier patches. Rays are intersected with the exact patches, not with a
// tessellation.

#include <memory>

#include "bezier_cells.h"
#include "bezier_region.h"
#include "bezier_table.h"
#include "etendue/placed_object.h"
#include "geometry/numbered_parts.h"

namespace etendue {

/// A hit's primitive is the number of a patch; its u and v are the patch parameters s and t.
class BezierObject : public PlacedObject, public NumberedParts {
 public:
  BezierObject();
  ~BezierObject() override;
  /// Only building the shape takes time, and changes of emission do not affect it.
  void prepare_again() override {}
  bool closed() const override { return closed_; }
  std::uint64_t part_count() const override { return patches_.size(); }

 protected:
  /// The grid resolution per patch for a number of patches.
  static int grid_for(std::size_t patches);
  /// Stores the patches and the region of them that trimming keeps, builds the hierarchy and places the object; to be called at
  /// the end of prepare. Returns false if they have no area.
  bool adopt(std::vector<bezier::Patch>, bezier::Region);

  Bounds3 local_bounds() const override { return own_bounds_; }
  bool local_intersect(const Ray&, Hit&) const override;
  bool local_occludes(const Ray&) const override;
  void local_point(const Ray&, const Hit&, LocalPoint&) const override;
  double local_area() const override { return table_.area(); }
  float local_area_error() const override { return float(table_.area_error()); }
  float local_sample(Point2 u, LocalPoint&) const override;
  float local_pdf(const SurfacePoint&) const override;

 private:
  struct Accelerator;
  /// Fills a point; returns |S_s x S_t|, the area per unit of s and t.
  double point_at(std::uint32_t patch, float s, float t, LocalPoint&) const;

  std::vector<bezier::Patch> patches_;
  std::vector<bezier::Cell> cells_;
  bezier::Region region_{0, 1};
  bezier::AreaTable table_;
  std::unique_ptr<Accelerator> accelerator_;
  Bounds3 own_bounds_;
  bool closed_ = false;
};

}  // namespace etendue
