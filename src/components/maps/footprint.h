#pragma once
// The footprint of a ray's cone on a surface, for the filtering of maps, and the transform from object space at a point.

#include "etendue/core/surface_point.h"
#include "etendue/core/transform.h"

namespace etendue {

/// Where a map takes its coordinates from.
enum class MapSpace : std::uint8_t { object, world, uv };

// With a footprint of zero, the default, a map returns its value at the point; with any other (Renderer::map_filter) its mean
// over the footprint. All maps follow this rule, and none has a filter width of its own (decision 013).

/// The ellipse in which a ray's cone intersects the surface, by its two diameters: vectors in the surface, in rendering
/// space [m]. Zero without a footprint.
struct Footprint {
  Vector3 longer, shorter;
};
Footprint footprint_of(const SurfacePoint&);
/// Sets a point's footprint to the ellipse with two conjugate diameters: vectors in the surface, which a footprint's axes
/// become when the surface is deformed. The point's ray direction becomes that of a ray whose cone has this footprint.
void set_footprint(SurfacePoint&, const Footprint&);

/// Both axes in object space.
Footprint object_footprint(const SurfacePoint&);
/// Calls f(point, weight) at object-space points spread evenly over the parallelogram of the footprint's axes, with weights
/// that add up to 1; without a footprint only at the point itself. For maps that have no analytic filter.
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

/// The axes of a footprint as changes of (u, v).
struct UvFootprint {
  Vector2 longer, shorter;
  /// Widths along u and v of the box that has the same second moments as the parallelogram of both axes.
  Vector2 box() const;
};
UvFootprint uv_footprint(const SurfacePoint&);
/// The box of a point's UvFootprint; 0 by 0 without a footprint.
inline Vector2 uv_box(const SurfacePoint& p) { return p.footprint > 0 ? uv_footprint(p).box() : Vector2{}; }

/// Computes dpdu and dpdv of a point if they are not set yet.
void with_tangents(SurfacePoint&);

/// The transform from object space to rendering space at a point. An object of a nested scene (an instance) is placed by
/// further transforms, which the point does not store. Then the transform is reconstructed from the tangents, which is exact if
/// the further transforms are similarities and no other map has changed the tangents before. The result may refer to `scratch`.
const Transform& placement(const SurfacePoint&, Transform& scratch);

/// A point in the space of a solid texture, in units of the texture's features, and the diameter of the circle that has the
/// area of the footprint, in the same units.
struct SolidPoint {
  Vector3 at;
  float width = 0;
};
SolidPoint solid_point(const SurfacePoint&, MapSpace, float size);

}  // namespace etendue
