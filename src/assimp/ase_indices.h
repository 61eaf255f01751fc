#pragma once
// Checks ASE files for faces with invalid indices of texture or colour vertices. Assimp does not check them and reads beyond
// its lists, where the memory can hold anything, but the same in each process.

#include <string>

namespace etendue::assimp_helper {

/// The message for an invalid index in a file with the ending of ASE; empty: none was found, or it is another format.
std::string wrong_ase_index(const std::string& path);

}  // namespace etendue::assimp_helper
