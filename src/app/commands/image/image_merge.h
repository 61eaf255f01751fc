#pragma once
// etendue image merge: merges checkpoints of different passes into one image.

#include "app/commands.h"

namespace etendue {

void add_image_merge(Command& image);

}  // namespace etendue
