#pragma once
// Read permissions for importers that run while a scene is prepared, after the loader.

#include "etendue/language/language.h"

namespace etendue {

/// The options from the command line for importers that read while a component is prepared, such as those of Import. A scene
/// cannot change them. Set before anything is read.
const ImportOptions& import_permissions();
void set_import_permissions(ImportOptions);

/// Whether paths will carry three bands (`--rgb`): then importers read what a program's RGB and spectral modes read differently
/// as its RGB mode does.
bool imports_for_rgb();
void set_imports_for_rgb(bool);

}  // namespace etendue
