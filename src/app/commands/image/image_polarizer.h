#pragma once
// The command `etendue image polarizer`.

#include "app/command_line.h"

namespace etendue {

void add_image_polarizer(Command& image);

}  // namespace etendue
