#pragma once
// The command `etendue image glare`.

#include "app/command_line.h"

namespace etendue {

void add_image_glare(Command& image);

}  // namespace etendue
