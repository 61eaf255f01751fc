#pragma once
// Reading of grids from NanoVDB files (.nvdb), to which `nanovdb_convert` converts OpenVDB files.

#include <string>

#include "volume_grid.h"

namespace etendue {

/// Whether a file's name ends in .nvdb.
bool named_nanovdb(const std::string& path);

/// The names of a file's grids, in their order. Throws Error whose message is the reason alone, without the file's name.
std::vector<std::string> nanovdb_grids(const std::string& path);

/// The grid of this name, or the first grid if the name is empty, as a dense grid over the box of its active values. Throws
/// Error whose message is the reason alone; files with any content are safe to read.
VolumeGrid read_nanovdb(const std::string& path, const std::string& name);

}  // namespace etendue
