#include "ase_indices.h"

#include <fstream>
#include <sstream>

#include "utf16.h"

namespace etendue::assimp_helper {

std::string wrong_ase_index(const std::string& path) {
  if (!is_ase(path)) return {};
  std::ifstream plain(path);
  std::istringstream decoded;
  const std::optional<std::string> wide = utf16_text(path);
  if (wide) decoded.str(*wide);
  std::istream& file = wide ? static_cast<std::istream&>(decoded) : plain;
  unsigned long corners[2] = {0, 0};  // lengths of the lists of texture and colour vertices that precede the faces
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    for (int kind = 0; kind < 2; ++kind) {
      if (word == (kind == 0 ? "*MESH_NUMTVERTEX" : "*MESH_NUMCVERTEX")) words >> corners[kind];
      if (word != (kind == 0 ? "*MESH_TFACE" : "*MESH_CFACE")) continue;
      std::string face;
      words >> face;
      for (unsigned long index = 0; words >> index;)
        if (index >= corners[kind])
          return "face " + face + " names corner " + std::to_string(index) + " of " + std::to_string(corners[kind]);
    }
  }
  return {};
}

}  // namespace etendue::assimp_helper
