#pragma once
// Arrays whose shape counts: the pixels of an image, the cells of a grid.

#include <string>
#include <vector>

#include "binding.h"

namespace etendue::python {

/// A value for a member.
struct Given {
  const Member* member;
  Value value;
};

/// What a Python object gives to a member, in the order in which it has to be set. An array of two dimensions or more for the
/// list of a class that has a `resolution`, such as ImageMap.values or GridMap.values, gives this, too, and `number_type` where
/// the class has it; any other object gives one value. Throws Error, "Class.member …".
std::vector<Given> given_values(const Component&, const Member&, nb::handle object, Location);

/// The ImageMap of an array of pixels, for a member that is a map. Throws Error without the names of class and member.
Ref<Component> image_map_of(nb::handle array, Location);

}  // namespace etendue::python
