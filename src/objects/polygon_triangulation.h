#pragma once
// Triangles from polygons.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "etendue/vector.h"

namespace etendue {

/// Twice the area times the unit normal, by Newell's method (Sutherland et al. 1974): exact for planar polygons, the
/// best plane for others.
Vector3 newell_normal(std::span<const Point3> points);

/// Appends triangles (indices into the points) of a simple polygon, in its orientation, by cutting ears (Meisters 1975).
/// Returns false when the polygon crosses itself; then the triangles only cover it roughly.
bool triangulate(std::span<const Point3> points, std::vector<std::array<std::uint32_t, 3>>& out);

}  // namespace etendue
