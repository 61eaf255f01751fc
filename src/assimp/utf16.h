#pragma once
// Files in UTF-16, of most of which the library reads nothing.

#include <optional>
#include <string>

namespace etendue::assimp_helper {

/// Whether a name is that of an ASE file.
bool is_ase(const std::string& path);
/// What a file in UTF-16 holds, as UTF-8; none: it is no such file, as its first bytes tell: a mark, or in XML '<' and a zero.
std::optional<std::string> utf16_text(const std::string& path);

}  // namespace etendue::assimp_helper
