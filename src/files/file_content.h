#pragma once
// By what two versions of a file are told apart.

#include <cstdint>
#include <string>

namespace etendue {

struct FileContent {
  std::uint64_t size = 0;  ///< [bytes]
  std::uint64_t hash = 0;
};

/// Reads a whole file; one that cannot be read has a size that none has.
FileContent content_of(const std::string& path);

}  // namespace etendue
