#pragma once
// etendue image merge: one picture of parts rendered apart.

#include "app/commands.h"

namespace etendue {

void add_image_merge(CLI::App& image, Run& run);

}  // namespace etendue
