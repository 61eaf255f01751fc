#pragma once
// What importers may read that are not called by what loads a scene.

#include "etendue/language/language.h"

namespace etendue {

/// What the person who runs the program allows and asks of importers that read when a part is prepared, such as those of
/// Import. A scene cannot change it. Set before anything is read.
const ImportOptions& import_permissions();
void set_import_permissions(ImportOptions);

}  // namespace etendue
