#pragma once
// The command `etendue image balance`.

#include "app/command_line.h"

namespace etendue {

void add_image_balance(Command& image);

}  // namespace etendue
