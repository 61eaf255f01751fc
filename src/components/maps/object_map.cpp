// The description of ObjectMap, the base class of all maps; it has no members.

#include "etendue/object_map.h"

namespace etendue {

void ObjectMap::describe(Description<ObjectMap>& d) {
  d.summary(
      "A number or a colour at each point of a surface (a texture). Where a map is expected, a number, in a unit of what "
      "is asked for, or a colour may stand.");
}

static const Register<ObjectMap> registered;

}  // namespace etendue
