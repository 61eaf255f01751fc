#pragma once
// Read permissions for importers that run while a scene is prepared, after the loader.

#include "etendue/language/language.h"

namespace etendue {

/// The options from the command line for importers that read while a component is prepared, such as those of Import. A scene
/// cannot change them. Set before anything is read.
const ImportOptions& import_permissions();
void set_import_permissions(ImportOptions);

}  // namespace etendue
