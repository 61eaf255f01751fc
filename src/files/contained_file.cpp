#include "contained_file.h"

#include <sys/stat.h>

#include <map>

#include "format_library.h"

namespace etendue {
namespace {

std::map<std::string, Unpack>& containers() {
  static auto* all = new std::map<std::string, Unpack>;
  return *all;
}

}  // namespace

bool register_container(const std::vector<std::string>& endings, Unpack unpack) {
  const std::lock_guard lock(libraries_guard());
  for (const std::string& ending : endings) containers()[ending] = unpack;
  return true;
}

namespace {

/// Null: no container.
Unpack unpacking_of(const std::string& ending) {
  const std::lock_guard lock(libraries_guard());
  auto known = containers().find(ending);
  if (known == containers().end() && ending != "etd" && load_format_library()) known = containers().find(ending);
  return known == containers().end() ? nullptr : known->second;
}

}  // namespace

std::optional<ContainedFile> contained_file(const std::string& path) {
  struct stat status{};
  for (size_t at = path.find('#'); at != std::string::npos; at = path.find('#', at + 1)) {
    const std::string container = path.substr(0, at);
    const size_t dot = container.find_last_of("./");
    if (dot == std::string::npos || container[dot] != '.') continue;
    std::string ending = container.substr(dot + 1);
    for (char& c : ending) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
    if (::stat(container.c_str(), &status) != 0 || ::stat(path.c_str(), &status) == 0) continue;
    if (const Unpack unpack = unpacking_of(ending)) return ContainedFile{container, path.substr(at + 1), unpack};
  }
  return std::nullopt;
}

std::string file_on_disk(const std::string& path) {
  const auto contained = contained_file(path);
  return contained ? contained->container : path;
}

}  // namespace etendue
