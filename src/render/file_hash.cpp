// The hash by which a picture's metadata names the files that it was made of.

#include "file_hash.h"

#include <fmt/format.h>

#include <filesystem>

#include "checkpoint.h"
#include "core/hash.h"
#include "files/file_content.h"

namespace etendue {

std::string file_hash(const Job& job, std::set<std::string> read, std::span<const std::string> texts) {
  Hash hash;
  for (const std::string& path : files_named_by(job)) read.insert(std::filesystem::absolute(path).string());
  for (const std::string& path : read) {
    const FileContent content = content_of(path);
    hash.add(std::as_bytes(std::span(&content, 1)));
  }
  for (const std::string& text : texts) {
    hash.add(std::as_bytes(std::span(text)));
    hash.add(std::as_bytes(std::span("\xff", 1)));  // no UTF-8 text has this byte: "ab" + "c" is not "a" + "bc"
  }
  return fmt::format("{:016x}", hash.value());
}

}  // namespace etendue
