#pragma once
// set_path for options of the command line: errors name the option instead of a path that the user did not write.

#include <string>

#include "etendue/describe/component.h"

namespace etendue::language {

/// Like etendue::set_path. `Location` is that of the path; if it has no line, errors in the value are reported there, too.
void set_path_from(Component& root, const std::string& path, const std::string& expression, Location);

}  // namespace etendue::language
