#pragma once
// The command `etendue image cryptomatte`.

#include "app/command_line.h"

namespace etendue {

void add_image_cryptomatte(Command& image);

}  // namespace etendue
