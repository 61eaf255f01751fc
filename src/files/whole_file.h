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
/// Of a text.
void write_whole_file(const std::string& path, const std::string& text);
/// Throws the same Error now, as far as it can be known before there is something to write: no such folder, no permission, a
/// folder, a name too long, a disk without room for anything. The path stays as it is.
void require_writable(const std::string& path);
/// The same as write_whole_file for bytes that lie in several places, one after the other.
void write_whole_file(const std::string& path, std::span<const std::span<const std::byte>> pieces);

}  // namespace etendue
