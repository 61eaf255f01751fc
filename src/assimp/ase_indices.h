#pragma once
// ASE files whose faces name corners of textures or colours that there are not. The library reads those from behind its lists,
// where there may be anything, the same in each process.

#include <string>

namespace etendue::assimp_helper {

/// What is wrong with a file of that ending; empty: nothing was found, or it is no such file.
std::string wrong_ase_index(const std::string& path);

}  // namespace etendue::assimp_helper
