#pragma once
// Imports a glTF file, or a file of another format converted to glTF.

#include "etendue/importer.h"

namespace etendue::gltf {

/// See Importer::import.
Ref<Component> import_document(Importing&);

}  // namespace etendue::gltf
