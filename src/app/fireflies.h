#pragma once
// Lists the samples with the largest contributions, which show where fireflies are.

#include <cstdio>
#include <string>

#include "etendue/render/render.h"

namespace etendue {

/// Lists the samples that a finished render kept (Film::keep_largest, called before it), largest first: each one's
/// contribution, its ratio to the pixel's final value, and the command that replays this sample alone.
std::string fireflies_text(const Render&, const std::string& picture_command);

/// Prints fireflies_text.
void report_fireflies(const Render&, const std::string& picture_command, std::FILE* to = stdout);

}  // namespace etendue
