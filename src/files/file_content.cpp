#include "file_content.h"

#include <vector>

#include "core/hash.h"
#include "etendue/core/error.h"
#include "regular_file.h"

namespace etendue {

FileContent content_of(const std::string& path) {
  FileContent content;
  try {
    RegularFile from(path);
    Hash hash;
    std::vector<std::byte> block(size_t(1) << 20);
    while (const std::uint64_t got = from.read_some(block.data(), block.size())) {
      hash.add({block.data(), size_t(got)});
      content.size += got;
      if (got < block.size()) break;
    }
    content.hash = hash.value();
  } catch (const Error&) {
    return {std::uint64_t(-1), 0};
  }
  return content;
}

}  // namespace etendue
