#pragma once
// Files that are either whole or as they were before.

#include <cstddef>
#include <span>
#include <string>

namespace etendue {

/// Writes the bytes beside the path, has them reach the disk and renames; keeps the permissions of a file that was
/// there. Devices and pipes are written straight. Throws Error naming the path and the reason; the path then holds what
/// it held before and nothing is left beside it.
void write_whole_file(const std::string& path, const void* data, size_t size);
/// The same for bytes that lie in several places, one after the other.
void write_whole_file(const std::string& path, std::span<const std::span<const std::byte>> pieces);

}  // namespace etendue
