#pragma once
// Tests whether triangles are non-degenerate, so that a ray could hit them.

#include <array>
#include <cstdint>
#include <span>

#include "etendue/core/error.h"
#include "etendue/core/vector.h"

namespace etendue {

/// Thrown for a mesh that is valid but has no such triangle.
class NoTriangles : public Error {
 public:
  using Error::Error;
};

/// Whether a vertex' coordinates, and their squares, are finite.
bool countable(const Point3&);
/// Whether twice the area is below 1e-7 of the longest side's square: the triangle's height is then below the rounding error of
/// its vertices.
bool without_height(const Point3&, const Point3&, const Point3&);
/// Whether any triangle has an area and countable vertices.
bool any_usable(std::span<const Point3> positions, std::span<const std::array<std::uint32_t, 3>> triangles);

}  // namespace etendue
