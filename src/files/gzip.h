#pragma once
// Files compressed by gzip, such as the meshes `mesh.ply.gz` of pbrt's scenes. RegularFile opens them as what they hold.

#include <string>

namespace etendue {

/// Whether the name ends in ".gz".
bool named_gzip(const std::string& path);
/// What a name ends in without a ".gz": "ply" of "Mesh.PLY.gz"; small letters, empty when there is none.
std::string ending_of_contents(const std::string& path);
/// Writes what an open compressed file holds to another open file; what is not compressed is copied. Throws Error with the
/// reason alone: when it is damaged, or holds so many times its own size that it was made to fill the memory.
void unpack_gzip(int from, int to);
/// Writes all of it. Throws Error with the system's reason.
void write_to(int file, const char* bytes, size_t count);

}  // namespace etendue
