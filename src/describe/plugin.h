#pragma once

#include <functional>
#include <string>

namespace etendue {

/// The file of a plugin: searched in the folders of ETENDUE_PLUGIN_PATH if the path has no folder, else relative to the working
/// directory. Throws Error if there is none, or it is not a regular file.
std::string find_plugin(const std::string& path);

/// Throws Error, with advice, if a library is not a plugin, was built for another program or machine, or crashes. The library
/// is opened in a child process, since opening a library runs code of it; `use` is called in this process to register its
/// classes.
void check_plugin(const std::string& file, const std::function<void()>& use);

/// Opens the library, whose static initializers enlist its classes.
void* open_plugin(const std::string& file);

}  // namespace etendue
