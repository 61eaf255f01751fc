#pragma once
// Options that several commands have in common.

#include <string>
#include <vector>

#include "command_line.h"

namespace etendue {

/// --plugin, which may be repeated.
void add_plugin_option(Command&, std::vector<std::string>& plugins);
/// Loads the shared libraries that --plugin names. Throws Error.
void load_plugins(const std::vector<std::string>& plugins);

/// --threads; `note` is added to its description.
void add_threads_option(Command&, int& threads, const std::string& note = "");

}  // namespace etendue
