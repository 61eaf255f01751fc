#pragma once
// Files that another machine has sent (render/team/scene_transfer.h): below a folder, each at the path that it has there.

#include <string>

namespace etendue {

/// From now on absolute paths lead below this folder, which is absolute, where there is something at them; empty: nowhere else.
/// Relative paths need a working folder below it.
void set_sent_folder(const std::string& folder);

/// Where the file or folder with this path is here: the path itself, or its counterpart below the folder.
std::string where_sent(const std::string& path);
/// The path on the machine that has sent it.
std::string where_sent_from(const std::string& path);

}  // namespace etendue
