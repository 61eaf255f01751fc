#pragma once

#include <functional>
#include <string>

namespace etendue {

/// The plugin's file: in the folders of ETENDUE_PLUGIN_PATH when the path has no folder, else relative to the working folder.
/// Throws Error when there is none, or it is no regular file.
std::string find_plugin(const std::string& path);

/// Throws Error, with the remedy, when a library is no plugin, was built for another program or machine, or crashes. It is
/// opened in a process of its own, for opening a library runs code of it; `use` takes in, there, what it has enlisted.
void check_plugin(const std::string& file, const std::function<void()>& use);

/// Opens the library; its classes enlist themselves.
void* open_plugin(const std::string& file);

}  // namespace etendue
