#pragma once
// The unit of lengths that a 3MF file states, which Assimp does not tell.

#include <string>

namespace etendue {

/// [m]; millimetres where the file states none or cannot be read so far: whoever reads all of it tells what is wrong.
double unit_of_3mf(const std::string& path);

}  // namespace etendue
