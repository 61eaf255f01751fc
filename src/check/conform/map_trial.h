#pragma once
// Shared by the checks of maps.

#include "conformance.h"
#include "etendue/object_map.h"

namespace etendue::conform {

/// Checks in which space the map reads points.
void check_map_space(Trial&, const ObjectMap&);

}  // namespace etendue::conform
