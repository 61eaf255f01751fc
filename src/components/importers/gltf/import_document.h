#pragma once
// What a glTF file holds, or one of another format that was converted to glTF.

#include "etendue/importer.h"

namespace etendue::gltf {

/// See Importer::import.
Ref<Component> import_document(Importing&);

}  // namespace etendue::gltf
