#pragma once
// Triangulation of polygons, with or without holes.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "etendue/core/vector.h"

namespace etendue {

/// Twice the area times the unit normal, by Newell's method (Sutherland et al. 1974): exact for planar polygons, the best fit
/// for others.
Vector3 newell_normal(std::span<const Point3> points);

/// Appends triangles (indices into the points) of a simple polygon, with the same orientation, by ear clipping (Meisters 1975).
/// Returns false if the polygon intersects itself; then the triangles cover it only approximately.
bool triangulate(std::span<const Point3> points, std::vector<std::array<std::uint32_t, 3>>& out);

/// Errors of a polygon with holes.
enum class PolygonFault : std::uint8_t {
  none,
  crossing,  ///< two outlines intersect, or one intersects itself
  outside,   ///< a hole lies outside the polygon
  nested,    ///< a hole lies within another one
};
struct PolygonCheck {
  PolygonFault fault = PolygonFault::none;
  size_t outline = 0;  ///< the outline with the error: 0 for the outer one, then the holes
};

/// Triangulates a polygon with holes. `points` are the points of all outlines, the outer one first; `ends` are the end indices
/// of the outlines. Holes may have either orientation.
PolygonCheck triangulate(std::span<const Point3> points, std::span<const size_t> ends,
                         std::vector<std::array<std::uint32_t, 3>>& out);

}  // namespace etendue
