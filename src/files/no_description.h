#pragma once
// Recognizes files that are not render descriptions before they are parsed as such.

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

/// The reason, from its contents or name, why a file is not a render description: "'model.dxf': files ending in .dxf are not
/// read; these are: …". Empty: it may be one. `main`: the file is rendered itself, not included. `others`: extensions of other
/// programs' files that can be read.
std::string why_no_description(const std::string& path, std::string_view text, bool main,
                               const std::function<std::vector<std::string>()>& others);

}  // namespace etendue
