#include "open_image_denoise.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <mutex>
#include <vector>

#include "etendue/core/error.h"

namespace etendue {
namespace {

namespace fs = std::filesystem;

constexpr const char* setting = "ETENDUE_OIDN";
constexpr const char* file_name = "libOpenImageDenoise.so.2";
constexpr int oldest = 20000, first_unknown = 30000;  // the versions whose functions are declared here

std::string of_environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

/// The subfolders of `folder` whose names begin with `beginning`, sorted.
std::vector<fs::path> folders_like(const fs::path& folder, const std::string& beginning) {
  std::vector<fs::path> found;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    if (at->path().filename().string().starts_with(beginning)) found.push_back(at->path());
  std::sort(found.begin(), found.end());
  return found;
}

/// The folders in which pip installs packages: of the active virtual environment, of PYTHONPATH, of the user, of the system.
std::vector<fs::path> package_folders() {
  std::vector<fs::path> folders;
  const auto add_python = [&](const fs::path& prefix) {
    for (const fs::path& python : folders_like(prefix / "lib", "python3"))
      for (const char* name : {"site-packages", "dist-packages"}) folders.push_back(python / name);
  };
  for (const char* name : {"VIRTUAL_ENV", "CONDA_PREFIX"})
    if (const std::string prefix = of_environment(name); !prefix.empty()) add_python(prefix);
  const std::string list = of_environment("PYTHONPATH");
  for (size_t at = 0; at < list.size();) {
    const size_t end = std::min(list.find(':', at), list.size());
    if (end > at) folders.emplace_back(list.substr(at, end - at));
    at = end + 1;
  }
  // ETENDUE_PYTHON, set for other packages, may be the Python of a virtual environment: PREFIX/bin/python.
  if (const fs::path python = of_environment("ETENDUE_PYTHON"); python.has_parent_path())
    add_python(python.parent_path().parent_path());
  if (const std::string home = of_environment("HOME"); !home.empty()) add_python(fs::path(home) / ".local");
  add_python("/usr/local");
  add_python("/usr");
  return folders;
}

std::vector<std::string> candidates() {
  if (const std::string set = of_environment(setting); !set.empty()) return {set};
  std::vector<std::string> paths{file_name};
  for (const fs::path& folder : package_folders()) {
    const fs::path path = folder / "pyoidn" / "oidn" / "lib" / file_name;
    std::error_code ignored;
    if (fs::exists(path, ignored)) paths.push_back(path.string());
  }
  return paths;
}

std::string version_text(int version) { return fmt::format("{}.{}.{}", version / 10000, version / 100 % 100, version % 100); }

template <class Function>
void find(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(dlsym(library, name));
  if (!function) throw Error(fmt::format("it has no function {}: it is no Open Image Denoise of version 2", name));
}

}  // namespace

OpenImageDenoise::OpenImageDenoise(void* library) {
  find(library, "oidnNewDevice", new_device);
  find(library, "oidnCommitDevice", commit_device);
  find(library, "oidnReleaseDevice", release_device);
  find(library, "oidnGetDeviceInt", device_number);
  find(library, "oidnSetDeviceInt", set_device_number);
  find(library, "oidnSetDeviceBool", set_device_switch);
  find(library, "oidnGetDeviceError", device_error);
  find(library, "oidnNewFilter", new_filter);
  find(library, "oidnReleaseFilter", release_filter);
  find(library, "oidnSetSharedFilterImage", set_image);
  find(library, "oidnSetFilterBool", set_switch);
  find(library, "oidnSetFilterInt", set_number);
  find(library, "oidnCommitFilter", commit_filter);
  find(library, "oidnExecuteFilter", execute);
  const Device device = new_device(cpu_device);
  if (!device) {
    const char* message = nullptr;
    device_error(nullptr, &message);
    throw Error(fmt::format("it makes no device of this processor: {}", message ? message : "no reason is given"));
  }
  version_ = device_number(device, "version");
  release_device(device);
  if (version_ < oldest || version_ >= first_unknown)
    throw Error(fmt::format("it is of version {}, not of 2", version_text(version_)));
}

const OpenImageDenoise& OpenImageDenoise::load() {
  static std::mutex mutex;
  static std::unique_ptr<const OpenImageDenoise> loaded;
  const std::lock_guard lock(mutex);
  if (loaded) return *loaded;
  std::vector<std::string> tried;
  for (const std::string& path : candidates()) {
    try {
      // Never closed, as threads of the library may run until the program ends.
      void* const library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
      if (!library) throw Error(dlerror());
      loaded.reset(new OpenImageDenoise(library));
      return *loaded;
    } catch (const Error& error) {
      tried.push_back(fmt::format("'{}': {}", path, error.what()));
    }
  }
  throw Error(
      fmt::format("Open Image Denoise cannot be loaded ({}). To get it: pip install pyoidn, in a virtual environment that is "
                  "active or for the user; or the library of www.openimagedenoise.org, with the environment variable {} saying "
                  "where its {} is",
                  fmt::join(tried, "; "), setting, file_name));
}

std::string OpenImageDenoise::version() const { return version_text(version_); }

}  // namespace etendue
