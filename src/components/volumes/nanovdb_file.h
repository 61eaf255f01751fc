#pragma once
// Grids in files of NanoVDB (.nvdb), which OpenVDB's files are converted to by `nanovdb_convert`.

#include <string>

#include "volume_grid.h"

namespace etendue {

/// Whether a file is named as one.
bool named_nanovdb(const std::string& path);

/// The names of its grids, in their order. Throws Error with the reason alone.
std::vector<std::string> nanovdb_grids(const std::string& path);

/// The grid of this name, or the first when it is empty: dense, over the box of its active values. Throws Error with the reason
/// alone, whatever the file holds.
VolumeGrid read_nanovdb(const std::string& path, const std::string& name);

}  // namespace etendue
