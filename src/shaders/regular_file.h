#pragma once
// Opening a file of data.

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

#include "etendue/error.h"

namespace etendue {

/// Opens a file and tells its size in bytes. Throws Error with the system's reason, or for what is no plain file.
inline std::ifstream open_regular_file(const std::string& path, std::uint64_t& size) {
  std::error_code code;
  const std::filesystem::file_status status = std::filesystem::status(path, code);
  if (!std::filesystem::exists(status)) throw Error(std::generic_category().message(code ? code.value() : ENOENT));
  if (!std::filesystem::is_regular_file(status)) throw Error("it is not a plain file");
  size = std::filesystem::file_size(path, code);
  if (code) throw Error(code.message());
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw Error(std::generic_category().message(errno));
  return stream;
}

}  // namespace etendue
