#include "own_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>

#include "etendue/core/error.h"

namespace etendue {

std::string own_library_path(const char* file_name) {
  Dl_info own{};
  if (!dladdr(reinterpret_cast<void*>(&own_library_path), &own) || !own.dli_fname) return {};
  const std::filesystem::path path = std::filesystem::path(own.dli_fname).parent_path() / file_name;
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored) ? path.string() : std::string();
}

void* open_own_library(const char* file_name, const std::string& what, LibraryNames names) {
  const std::string path = own_library_path(file_name);
  // Functions are bound when they are first called: binding all of them at once would take a sixth longer where a library needs
  // many others, as OpenImageIO does.
  const int mode = names == LibraryNames::shared ? RTLD_NOW | RTLD_GLOBAL : RTLD_LAZY | RTLD_LOCAL;
  void* const library = dlopen(path.empty() ? file_name : path.c_str(), mode);
  if (!library) throw Error(fmt::format("{} cannot be loaded: {}", what, dlerror()));
  return library;
}

}  // namespace etendue
