#pragma once

#include <string>

namespace etendue {

/// What the library does not tell of a 3MF file.
struct HeadOf3mf {
  double unit = 1e-3;            ///< of its lengths [m]
  bool face_colors = false;      ///< colours, images or mixtures of materials for single triangles
  bool parts_elsewhere = false;  ///< meshes in other files of the package (the production extension)
};

/// By the beginning of the model; what cannot be read has millimetres.
HeadOf3mf head_of_3mf(const std::string& path);

}  // namespace etendue
