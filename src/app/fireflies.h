#pragma once
// The samples that brought most light: where to look for fireflies.

#include <cstdio>
#include <string>

#include "etendue/render/render.h"

namespace etendue {

/// Tells the samples a finished render kept (Film::keep_largest, before it), largest first: what each brought, how
/// that compares to its pixel, and the command that replays it alone.
std::string fireflies_text(const Render&, const std::string& picture_command);

/// The same, printed.
void report_fireflies(const Render&, const std::string& picture_command, std::FILE* to = stdout);

}  // namespace etendue
