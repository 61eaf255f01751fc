#include "shading_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>
#include <mutex>
#include <string>

#include "etendue/core/error.h"

namespace etendue {

void load_shading_library() {
  static std::mutex guard;
  const std::lock_guard lock(guard);
  static bool loaded = false;
  if (loaded) return;
  constexpr const char* file_name = "libetendue_osl.so";
  Dl_info own{};
  std::string path = file_name;
  if (dladdr(reinterpret_cast<void*>(&load_shading_library), &own) && own.dli_fname) {
    const std::filesystem::path beside = std::filesystem::path(own.dli_fname).parent_path() / file_name;
    std::error_code ignored;
    if (std::filesystem::is_regular_file(beside, ignored)) path = beside.string();
  }
  // Never closed: objects of its classes may exist until the program ends.
  if (!dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL))
    throw Error(
        fmt::format("the library for the Open Shading Language cannot be loaded ('./etendue build' builds it): {}", dlerror()));
  loaded = true;
}

}  // namespace etendue
