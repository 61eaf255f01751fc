#pragma once
// Triangles from polygons.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "etendue/core/vector.h"

namespace etendue {

/// Twice the area times the unit normal, by Newell's method (Sutherland et al. 1974): exact for planar polygons, the
/// best plane for others.
Vector3 newell_normal(std::span<const Point3> points);

/// Appends triangles (indices into the points) of a simple polygon, in its orientation, by cutting ears (Meisters 1975).
/// Returns false when the polygon crosses itself; then the triangles only cover it roughly.
bool triangulate(std::span<const Point3> points, std::vector<std::array<std::uint32_t, 3>>& out);

/// What may be wrong with a polygon that has holes.
enum class PolygonFault : std::uint8_t {
  none,
  crossing,  ///< two outlines cross, or one crosses itself
  outside,   ///< a hole lies outside of the polygon
  nested,    ///< a hole lies within another one
};
struct PolygonCheck {
  PolygonFault fault = PolygonFault::none;
  size_t outline = 0;  ///< the one at fault: 0 the outer one, then the holes
};

/// The same with holes. `points` are those of all outlines, the outer one's first, and `ends` tells where each outline ends.
/// Holes may run either way round.
PolygonCheck triangulate(std::span<const Point3> points, std::span<const size_t> ends,
                         std::vector<std::array<std::uint32_t, 3>>& out);

}  // namespace etendue
