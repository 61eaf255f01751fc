#pragma once
// Coordinate systems by name.

#include "call.h"
#include "services.h"

namespace etendue::osl {

/// The matrix from one named space to another. Returns false, and sets the identity, if one of the names is unknown; then the
/// error is reported unless Services::unknown_space_is_error is false.
bool matrix_between(const Call&, const String* from, const String* to, Matrix& out);

/// p as a point, vector or normal (`kind`) transformed by m.
Triple transform_as(Base kind, const Matrix& m, const Triple& p);
Dual<Triple> transform_as(Base kind, const Matrix& m, const Dual<Triple>& p);

}  // namespace etendue::osl
