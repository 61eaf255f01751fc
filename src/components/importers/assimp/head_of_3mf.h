#pragma once

#include <string>

namespace etendue {

/// Properties of a 3MF file that Assimp does not report.
struct HeadOf3mf {
  double unit = 1e-3;            ///< of lengths [m]
  bool face_colors = false;      ///< single triangles have colours, images or mixtures of materials
  bool parts_elsewhere = false;  ///< meshes in other files of the package (the production extension)
};

/// Reads the beginning of the model only. A file that cannot be read gets the defaults, thus millimetres.
HeadOf3mf head_of_3mf(const std::string& path);

}  // namespace etendue
