#pragma once
// Files that are no render descriptions, told before they are taken for one.

#include <string>
#include <string_view>
#include <vector>

namespace etendue {

/// Why a file that was to be read as a description is none, as its contents or its name say: "'model.dxf': files ending in .dxf
/// are not read; these are: …". Empty: it may be one. `main`: it is rendered itself, and not included. `others`: endings of the
/// files of other programs that are read.
std::string why_no_description(const std::string& path, std::string_view text, bool main,
                               const std::vector<std::string>& others);

}  // namespace etendue
