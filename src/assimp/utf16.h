#pragma once
// Decodes files in UTF-16, most of which Assimp cannot read.

#include <optional>
#include <string>

namespace etendue::assimp_helper {

/// Whether the file name has the ending of ASE.
bool is_ase(const std::string& path);
/// The content of a UTF-16 file as UTF-8; nothing: its first bytes, a byte order mark or in XML '<' and a zero, do not show
/// that encoding.
std::optional<std::string> utf16_text(const std::string& path);

}  // namespace etendue::assimp_helper
