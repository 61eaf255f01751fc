#pragma once
// The size and hash of a file, by which versions of it are distinguished.

#include <cstdint>
#include <string>

namespace etendue {

struct FileContent {
  std::uint64_t size = 0;  ///< [bytes]
  std::uint64_t hash = 0;
};

/// Reads a whole file. For a file that cannot be read, the size is 2^64 - 1.
FileContent content_of(const std::string& path);

}  // namespace etendue
