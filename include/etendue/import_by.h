#pragma once
// Files of other programs being read: what all who import one do.

#include "etendue/importer.h"

namespace etendue {

/// What an importer reads from the file. When that fails because the file holds something else than its name says, the Error
/// says what.
Ref<Component> import_by(const Importer&, Importing&);

}  // namespace etendue
