#pragma once
// Writes files atomically: a file is either complete or unchanged.

#include <cstddef>
#include <span>
#include <string>

namespace etendue {

/// Writes the bytes to a temporary file, flushes it to the disk and renames it; keeps the permissions of an existing file.
/// Devices and pipes are written directly. Throws Error with the path and the reason; then the old file is unchanged and no
/// temporary file is left.
void write_whole_file(const std::string& path, const void* data, size_t size);
/// The same for a text.
void write_whole_file(const std::string& path, const std::string& text);
/// Throws the same Error in advance, as far as possible: no such folder, no permission, a folder, a name too long, a full disk.
/// The file stays unchanged.
void require_writable(const std::string& path);
/// The same as write_whole_file for bytes in several pieces, which are concatenated.
void write_whole_file(const std::string& path, std::span<const std::span<const std::byte>> pieces);

}  // namespace etendue
