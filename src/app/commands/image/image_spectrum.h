#pragma once
// The command `etendue image spectrum`.

#include "app/command_line.h"

namespace etendue {

void add_image_spectrum(Command& image);

}  // namespace etendue
