#include "output_files.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <filesystem>

#include "input_files.h"
#include "whole_file.h"

namespace etendue {
namespace {

/// Equal for all names of one file. A file that does not exist yet is identified by its folder and its name in it. Empty:
/// unknown, or a file that several outputs may write to, such as a terminal.
std::string identity_of_file(const std::string& path) {
  struct stat status{};
  if (::stat(path.c_str(), &status) == 0)
    return S_ISREG(status.st_mode) ? fmt::format("{}:{}", status.st_dev, status.st_ino) : std::string();
  const std::filesystem::path file(path);
  const std::string folder = file.has_parent_path() ? file.parent_path().string() : ".";
  if (::stat(folder.c_str(), &status) != 0) return {};
  return fmt::format("{}:{}/{}", status.st_dev, status.st_ino, file.filename().string());
}

}  // namespace

void OutputFiles::add(const std::string& path, Location at, const std::string& continued) {
  const File file{path, identity_of_file(path)};
  try {
    const std::string input = input_at(path);
    if (!input.empty() && (continued.empty() || identity_of_file(continued) != file.identity))
      throw Error(fmt::format("'{}' would be overwritten, and it is read{}", path,
                              std::filesystem::path(input).filename() == std::filesystem::path(path).filename()
                                  ? std::string()
                                  : fmt::format(" as '{}'", input)));
    for (const File& other : files_)
      if (!file.identity.empty() && other.identity == file.identity)
        throw Error(other.path == path
                        ? fmt::format("'{}' would be written twice", path)
                        : fmt::format("'{}' is the same file as '{}', which is written as well", path, other.path));
    require_writable(path);
  } catch (const Error& error) {
    errors_.emplace_back(error.what(), at);
  }
  files_.push_back(file);
}

void OutputFiles::raise() const {
  if (!errors_.empty()) throw Errors(errors_);
}

}  // namespace etendue
