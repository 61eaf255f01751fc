#pragma once
// The area of an ellipsoid, and so of every affine image of a sphere.

#include "etendue/core/transform.h"

namespace etendue {

/// The area [m^2], after a transform, of an ellipsoid with the half axes `radii` [m] along x, y and z; exact to double
/// precision.
double ellipsoid_area(const Transform&, const Vector3& radii);

}  // namespace etendue
