#pragma once
// Shared libraries that bring classes.

#include <string>

namespace etendue {

/// The file to open: a path as it is when it has a folder; else looked up in the folders of ETENDUE_PLUGIN_PATH
/// (separated by ':'), then the working folder. Throws Error when there is none. Made canonical.
std::string find_plugin(const std::string& path);
void* open_plugin(const std::string& file);
/// Throws Error when the library was built against other interfaces than this program.
void check_plugin_abi(void* handle, const std::string& file);

}  // namespace etendue
