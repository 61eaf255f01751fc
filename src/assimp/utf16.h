#pragma once
// ASE files in UTF-16, of which the library reads nothing.

#include <optional>
#include <string>

namespace etendue::assimp_helper {

/// Whether a name is that of an ASE file.
bool is_ase(const std::string& path);
/// What a file in UTF-16 holds, as UTF-8; none: it is no such file, as its first two bytes tell.
std::optional<std::string> utf16_text(const std::string& path);

}  // namespace etendue::assimp_helper
