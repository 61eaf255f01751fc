#pragma once
// import_by: calls an importer, with better errors for files of the wrong kind.

#include "etendue/importer.h"

namespace etendue {

/// The component that an importer reads from the file. If the import fails because the file's content is of another format than
/// its extension says, the Error names that format.
Ref<Component> import_by(const Importer&, Importing&);

}  // namespace etendue
