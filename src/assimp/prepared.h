#pragma once
// Rewrites files that Assimp cannot read, or that crash it, as equivalent files that it can read.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace etendue::assimp_helper {

/// The bytes to give to Assimp for a file, by its ending and first bytes; nothing: the file is used unchanged.
///
/// Texts in UTF-16, and XML in Latin-1, become UTF-8. In Collada, whitespace around numbers is removed. LightWave's old format
/// (LWOB) becomes its new one. 3MF: images are removed.
std::optional<std::string> prepared(const std::string& path);

/// What `prepared` left out, for warnings.
const std::vector<std::string>& left_out();

/// XML without whitespace around texts and without line ends in them: Assimp reads numbers from the first character.
std::string trimmed_xml(std::string_view);

/// A LightWave object of the format LWOB converted to LWO2; nothing: it is no such file, or damaged. Sets `textures` if it has
/// textures, which are left out.
std::optional<std::string> lwob_as_lwo2(std::string_view, bool& textures);

/// A ZIP archive with only those entries that describe the content of a 3MF package. Assimp frees the images of such a package,
/// mostly its thumbnail, before it uses them.
std::optional<std::string> package_without_images(std::string_view);

}  // namespace etendue::assimp_helper
