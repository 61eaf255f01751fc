#include "plugin.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>

#include "etendue/describe/abi.h"
#include "etendue/describe/registry.h"
#include "files/regular_file.h"
#include "files/sent_files.h"
#include "plugin_probe.h"

namespace etendue {

const char* abi_string() { return detail::abi_text.text; }

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
  for (fs::path& candidate : candidates) candidate = where_sent(candidate.string());
  for (const fs::path& candidate : candidates) {
    std::error_code error;
    if (!fs::exists(candidate, error)) continue;
    try {
      require_regular_file(candidate.string());
    } catch (const Error& e) {
      throw Error("plugin '" + candidate.string() + "': " + e.what());
    }
    return fs::weakly_canonical(candidate).string();
  }
  throw Error("there is no plugin file '" + path + "'" +
              (candidates.size() > 1 ? ", neither here nor in the folders of ETENDUE_PLUGIN_PATH" : ""));
}

namespace {

/// Parts of a text that are separated by ", ".
std::vector<std::string> parts_of(const std::string& text) {
  std::vector<std::string> parts;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find(", ", begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 2;
  }
  return parts;
}

/// Advice for a difference in one part of the text of abi.h.
std::string remedy(const std::string& theirs, const std::string& ours) {
  const auto about = [&](const char* word) { return theirs.starts_with(word) && ours.starts_with(word); };
  if (about("interfaces") || ours.ends_with("wavelengths")) return "with the headers of this program";
  if (about("spectra in"))
    return ours == "spectra in memory"
               ? "without -march, as this program was, or with etendue_add_plugin() of its CMake package, which knows how"
               : "for the vector instructions that this program uses: with -march=native, or with etendue_add_plugin() of its "
                 "CMake package, which knows how";
  if (ours.starts_with("libstdc++") || ours.starts_with("libc++")) return "with the standard library of this program";
  if (ours.ends_with("containers")) return "with the same choice of _GLIBCXX_DEBUG";
  if (about("layout")) return "without options that change how objects lie in memory (-fpack-struct, -fshort-enums and such)";
  return "with the headers of this program";
}

void compare_abi(const std::string& theirs) {
  const std::string own = abi_string();
  if (theirs == own) return;
  const std::vector<std::string> their_parts = parts_of(theirs), own_parts = parts_of(own);
  for (size_t i = 0; i < own_parts.size(); ++i) {
    if (i < their_parts.size() && their_parts[i] == own_parts[i]) continue;
    const std::string other = i < their_parts.size() ? their_parts[i] : "nothing";
    throw Error(fmt::format("it was built for '{}', this program is '{}'; build it again {}", other, own_parts[i],
                            remedy(other, own_parts[i])));
  }
  throw Error(
      fmt::format("it was built for '{}', this program is '{}'; build it again with the headers of this program", theirs, own));
}

/// Throws Error if the machine lacks an instruction set extension in the list.
void require_instructions(const std::string& list) {
#if defined(__x86_64__)
  const auto known = [](const std::string& name) {
    if (name == "sse4.2") return __builtin_cpu_supports("sse4.2") != 0;
    if (name == "avx") return __builtin_cpu_supports("avx") != 0;
    if (name == "avx2") return __builtin_cpu_supports("avx2") != 0;
    if (name == "fma") return __builtin_cpu_supports("fma") != 0;
    if (name == "bmi2") return __builtin_cpu_supports("bmi2") != 0;
    if (name == "avx512f") return __builtin_cpu_supports("avx512f") != 0;
    if (name == "avx512vl") return __builtin_cpu_supports("avx512vl") != 0;
    if (name == "avx512bw") return __builtin_cpu_supports("avx512bw") != 0;
    if (name == "avx512dq") return __builtin_cpu_supports("avx512dq") != 0;
    return true;
  };
  std::istringstream words(list);
  for (std::string name; words >> name;)
    if (!known(name))
      throw Error(
          fmt::format("it was compiled for {} instructions, which this machine does not have; build it again on this "
                      "machine, or with an older -march",
                      name));
#else
  static_cast<void>(list);
#endif
}

}  // namespace

void check_plugin(const std::string& file, const std::function<void()>& use) {
  const auto accept = [](const PluginAnswer& answer) {
    compare_abi(answer.abi);
    require_instructions(answer.instructions);
  };
  try_plugin(file, accept, use);
}

void* open_plugin(const std::string& file) {
  // The library is never closed: objects of its classes may live until the program ends.
  void* handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!handle) throw Error(fmt::format("it cannot be opened: {}", dlerror()));
  return handle;
}

}  // namespace etendue
