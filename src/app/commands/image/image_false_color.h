#pragma once
// The command `etendue image false-colour`.

#include "app/command_line.h"

namespace etendue {

void add_image_false_color(Command& image);

}  // namespace etendue
