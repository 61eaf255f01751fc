#pragma once
// Triangles that a ray could meet.

#include <array>
#include <cstdint>
#include <span>

#include "etendue/core/error.h"
#include "etendue/core/vector.h"

namespace etendue {

/// A mesh without any such triangle, and otherwise right.
class NoTriangles : public Error {
 public:
  using Error::Error;
};

/// Whether a corner's coordinates are finite, and so small that their squares are.
bool countable(const Point3&);
/// Whether twice the area is below 1e-7 of the longest side's square: the height is lost in the rounding of the corners.
bool without_height(const Point3&, const Point3&, const Point3&);
/// Whether any of them has an area, and corners that can be counted with.
bool any_usable(std::span<const Point3> positions, std::span<const std::array<std::uint32_t, 3>> triangles);

}  // namespace etendue
