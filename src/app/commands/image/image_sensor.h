#pragma once
// The command `etendue image sensor`.

#include "app/command_line.h"

namespace etendue {

void add_image_sensor(Command& image);

}  // namespace etendue
