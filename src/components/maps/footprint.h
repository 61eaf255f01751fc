#pragma once
// What a ray's cone sees of a surface, for filtering maps, and where the surface lies in its object's own coordinates.

#include "etendue/core/ray.h"
#include "etendue/core/transform.h"

namespace etendue {

/// Where a map takes its coordinates from.
enum class MapSpace : std::uint8_t { object, world, uv };

// A footprint of zero, the default, asks a map for its own value at the point; any other (Renderer::map_filter) for the mean
// over it. All maps keep to that one rule, and none has a filter of its own (decision 013).

/// The ellipse a cone of a ray cuts out of the surface, by its two axes: vectors in the surface, in the coordinates of the
/// scene the renderer sees, as long as the ellipse is wide [m]. Zero without a footprint.
struct Footprint {
  Vector3 longer, shorter;
};
Footprint footprint_of(const SurfacePoint&);
/// Gives a point the ellipse of two conjugate diameters: vectors in its surface, such as a footprint's axes become when the
/// surface is deformed. The ray's direction is then that of a ray that sees such an ellipse.
void set_footprint(SurfacePoint&, const Footprint&);

/// Both axes in the object's own coordinates.
Footprint object_footprint(const SurfacePoint&);
/// Calls f(point, weight) at points of the object's coordinates, spread evenly over the parallelogram of the footprint's axes,
/// whose weights add up to 1; without a footprint at the point itself. A map that has no better filter takes its mean so.
template <class F>
void over_footprint(const SurfacePoint& p, const F& f) {
  if (!(p.footprint > 0)) {
    f(p.object_position, 1.0f);
    return;
  }
  constexpr int side = 4;
  const Footprint axes = object_footprint(p);
  for (int i = 0; i < side; ++i)
    for (int k = 0; k < side; ++k)
      f(p.object_position + ((float(i) + 0.5f) / side - 0.5f) * axes.longer + ((float(k) + 0.5f) / side - 0.5f) * axes.shorter,
        1.0f / (side * side));
}

/// The same axes as changes of the surface coordinates.
struct UvFootprint {
  Vector2 longer, shorter;
  /// Widths along u and v of the box of the same second moments as the parallelogram of both axes.
  Vector2 box() const;
};
UvFootprint uv_footprint(const SurfacePoint&);
/// Its box; 0 by 0 without a footprint.
inline Vector2 uv_box(const SurfacePoint& p) { return p.footprint > 0 ? uv_footprint(p).box() : Vector2{}; }

/// dpdu and dpdv of a point, found when they are not there yet.
void with_tangents(SurfacePoint&);

/// From the object's own coordinates to the renderer's, around a point. Beyond the object's transform a nested scene has
/// others, of which a point does not tell; there the answer is made from tangents, exact when those are similarities and no
/// other map has changed the tangents before. `scratch` may hold the answer.
const Transform& placement(const SurfacePoint&, Transform& scratch);

/// A point in the space of a solid texture, in units of its features, and the width there of the circle that has the area of
/// the footprint.
struct SolidPoint {
  Vector3 at;
  float width = 0;
};
SolidPoint solid_point(const SurfacePoint&, MapSpace, float size);

}  // namespace etendue
