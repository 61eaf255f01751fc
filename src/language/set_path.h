#pragma once
// Setting a member for an option of the command line, which errors name instead of a path that nobody wrote.

#include <string>

#include "etendue/describe/component.h"

namespace etendue::language {

/// As etendue::set_path. The place of the path; without a line it is the place of all that is wrong with the value, too.
void set_path_from(Component& root, const std::string& path, const std::string& expression, Location);

}  // namespace etendue::language
