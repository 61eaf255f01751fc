#pragma once
// PieceHierarchy: a bounding volume hierarchy over the many small pieces of one shape.

#include "etendue/placed_object.h"
#include "geometry/double_ray.h"
#include "geometry/embree_device.h"

namespace etendue {

/// Interface of the pieces that a PieceHierarchy is built over.
class Pieces {
 public:
  virtual ~Pieces() = default;
  virtual Bounds3 piece_bounds(std::uint32_t piece) const = 0;
  /// The nearest intersection with t in (0, maximum), t a float: fills distance, primitive, u and v.
  virtual bool intersect_piece(std::uint32_t piece, const DoubleRay&, float maximum, Hit&) const = 0;
};

/// A bounding volume hierarchy over pieces, by Embree; not copyable, because Embree stores the address of the pieces.
class PieceHierarchy {
 public:
  PieceHierarchy(const Pieces&, std::uint32_t count);
  PieceHierarchy(const PieceHierarchy&) = delete;
  PieceHierarchy& operator=(const PieceHierarchy&) = delete;
  bool nearest(const Ray&, Hit&) const;
  bool any(const Ray&) const;

 private:
  EmbreeSceneHandle scene_;
};

}  // namespace etendue
