#pragma once
// MapInputs: maps of the description whose values shaders ask for, as attributes of the point with names of our own.

#include <string>
#include <utility>
#include <vector>

#include "etendue/object_map.h"
#include "osl/values/dual.h"
#include "osl/values/interned_string.h"
#include "osl/values/triple.h"

namespace etendue::osl {

class MapInputs {
 public:
  /// The name by which shaders ask for the map.
  const String* add(Ref<ObjectMap> map);
  /// The map of a name; null if it is none of them.
  const ObjectMap* find(const String* name) const {
    for (const auto& [known, map] : maps_)
      if (known == name) return map.get();
    return nullptr;
  }

 private:
  std::vector<std::pair<const String*, Ref<ObjectMap>>> maps_;
};

/// The number of a map, or its colour as RGB of the shaders' space, at a point. With `derivatives` also its changes along the
/// axes of the point's footprint, by differences.
Dual<float> number_of(const ObjectMap&, const SurfacePoint&, bool derivatives);
Dual<Triple> color_of(const ObjectMap&, const SurfacePoint&, bool derivatives);

}  // namespace etendue::osl
