#pragma once
// What an importer reads, with what only the whole of it tells.

#include "etendue/importer.h"

namespace etendue {

/// The Job or Scene that an importer makes of a file. That nothing of it can be seen, since all its surfaces are fully
/// transparent, is told: mostly a file means something else by its numbers.
Ref<Component> imported(const Importer&, Importing&);

}  // namespace etendue
