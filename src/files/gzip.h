#pragma once
// Files compressed by gzip, such as the meshes `mesh.ply.gz` of pbrt's scenes. RegularFile opens their uncompressed contents.

#include <string>

namespace etendue {

/// Whether the name ends in ".gz".
bool named_gzip(const std::string& path);
/// The extension of a name without a ".gz": "ply" for "Mesh.PLY.gz"; in lower case, empty if there is none.
std::string ending_of_contents(const std::string& path);
/// Uncompresses one open file to another; uncompressed data are copied. Throws Error with the reason alone: the data are
/// damaged, or so much larger than the compressed file that it must be a decompression bomb.
void unpack_gzip(int from, int to);
/// Writes all bytes. Throws Error with the system's reason.
void write_to(int file, const char* bytes, size_t count);

}  // namespace etendue
