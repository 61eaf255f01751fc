#pragma once
// Paths of single samples as arrays.

#include "binding.h"
#include "etendue/core/vector.h"
#include "etendue/transport/path_record.h"

namespace etendue::python {

/// A dict of the vertices, the contributions and the rest of a record; `film` is the sample's film point.
nb::dict path_dict(const PathRecord&, Point2 film);

}  // namespace etendue::python
