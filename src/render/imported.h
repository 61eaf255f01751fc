#pragma once
// Imports a file and checks it as a whole.

#include "etendue/importer.h"

namespace etendue {

/// The Job or Scene that an importer makes of a file. Warns if nothing in it is visible because all surfaces are fully
/// transparent: then the importer has probably misread the opacity.
Ref<Component> imported(const Importer&, Importing&);

}  // namespace etendue
