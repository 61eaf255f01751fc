#pragma once
// MTL files: the materials of OBJ files.

#include <map>
#include <string>

#include "components/importers/models/surface.h"

namespace etendue {

struct MtlMaterial {
  Surface surface;
  Location at;
};

/// Adds the materials of a file to the map, by their names. Source: Wavefront, "MTL material format" (Advanced Visualizer
/// manual, appendix B2), and the PBR extension of Exocortex (Pr, Pm, Ps, Pc, Pcr, aniso, norm).
void read_mtl(Importing&, const std::string& path, std::map<std::string, MtlMaterial>&);

}  // namespace etendue
