#include "format_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>
#include <string>

#include "etendue/core/error.h"

namespace etendue {

std::recursive_mutex& libraries_guard() {
  static auto* guard = new std::recursive_mutex;  // never destroyed: used until the program ends
  return *guard;
}

bool load_format_library() {
  const std::lock_guard lock(libraries_guard());
  static bool loaded = false;
  if (loaded) return false;
  constexpr const char* file_name = "libetendue_formats.so";
  Dl_info own{};
  std::string path = file_name;
  if (dladdr(reinterpret_cast<void*>(&load_format_library), &own) && own.dli_fname) {
    const std::filesystem::path beside = std::filesystem::path(own.dli_fname).parent_path() / file_name;
    std::error_code ignored;
    if (std::filesystem::is_regular_file(beside, ignored)) path = beside.string();
  }
  // Never closed: components of its classes may exist until the program ends.
  if (!dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL))
    throw Error(
        fmt::format("the library for files of other programs cannot be loaded ('./etendue build' builds it): {}", dlerror()));
  return loaded = true;
}

}  // namespace etendue
