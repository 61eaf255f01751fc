#include "component/plugin.h"

#include <dlfcn.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>

#include "etendue/abi.h"
#include "etendue/registry.h"

namespace etendue {

const char* abi_string() { return detail::abi_text; }

std::string find_plugin(const std::string& path) {
  namespace fs = std::filesystem;
  std::vector<fs::path> candidates;
  if (path.find('/') == std::string::npos) {
    const char* folders = std::getenv("ETENDUE_PLUGIN_PATH");
    std::istringstream list(folders ? folders : "");
    for (std::string folder; std::getline(list, folder, ':');)
      if (!folder.empty()) candidates.push_back(fs::path(folder) / path);
  }
  candidates.emplace_back(path);
  for (const fs::path& candidate : candidates) {
    std::error_code error;
    if (fs::is_regular_file(candidate, error)) return fs::weakly_canonical(candidate).string();
  }
  throw Error("there is no plugin file '" + path + "'" +
              (candidates.size() > 1 ? ", neither here nor in the folders of ETENDUE_PLUGIN_PATH" : ""));
}

void* open_plugin(const std::string& file) {
  // Never closed: objects of its classes, and their code, may live until the end.
  void* handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!handle) throw Error("plugin '" + file + "' cannot be opened: " + dlerror());
  return handle;
}

void check_plugin_abi(void* handle, const std::string& file) {
  using AbiFunction = const char* (*)();
  // Defined inline in a header every plugin includes; a lookup by handle finds the library's own copy.
  const auto function = reinterpret_cast<AbiFunction>(dlsym(handle, "etendue_plugin_abi"));
  Dl_info where{};
  const bool own = function && dladdr(reinterpret_cast<void*>(function), &where) && where.dli_fname &&
                   std::filesystem::exists(where.dli_fname) && std::filesystem::equivalent(where.dli_fname, file);
  if (!own) throw Error("it is no Étendue plugin: it was not built with etendue/description.h");
  const char* theirs = function();
  if (std::strcmp(theirs, abi_string()) != 0) {
    throw Error(std::string("it was built for '") + theirs + "', this program is '" + abi_string() + "'; build it again");
  }
}

}  // namespace etendue
