#pragma once
// Files of which the library reads nothing, or dies, as files that it reads: what they say stays the same.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace etendue::assimp_helper {

/// What is to be given to the library for a file, by its ending and its first bytes; none: the file as it is.
///
/// Texts in UTF-16, and XML in Latin-1, become UTF-8. Collada: blanks around numbers are taken away. LightWave's old format
/// (LWOB): as its new one. 3MF: without images.
std::optional<std::string> prepared(const std::string& path);

/// What `prepared` left out, to be told.
const std::vector<std::string>& left_out();

/// XML whose texts have no blanks around them and no ends of lines within: the library reads numbers from the first character.
std::string trimmed_xml(std::string_view);

/// A LightWave object of the format LWOB as one of LWO2; none: it is no such file, or damaged. `textures` says whether it has
/// some, which are left out.
std::optional<std::string> lwob_as_lwo2(std::string_view, bool& textures);

/// An archive of ZIP with those entries alone that say what is in a 3MF package and where. The library frees images of such a
/// package, mostly its thumbnail, before it looks at them.
std::optional<std::string> package_without_images(std::string_view);

}  // namespace etendue::assimp_helper
