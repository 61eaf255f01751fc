#pragma once
// The area of an ellipsoid, and so of every affine image of a sphere.

#include "etendue/core/transform.h"

namespace etendue {

/// Of an ellipsoid with these half axes [m] along x, y and z, after a transform [m^2]; exact to double precision.
double ellipsoid_area(const Transform&, const Vector3& radii);

}  // namespace etendue
