#include "source_files.h"

#include <filesystem>
#include <fstream>
#include <sstream>

#include "etendue/core/error.h"
#include "preprocess.h"

namespace etendue::osl {

namespace fs = std::filesystem;

namespace {

std::string resolved(const fs::path& path) {
  std::error_code failed;
  const fs::path real = fs::canonical(path.empty() ? fs::path(".") : path, failed);
  return failed ? std::string() : real.string();
}

}  // namespace

SourceFiles::SourceFiles(const std::string& shader_file, const std::vector<std::string>& include_folders)
    : folders_(include_folders) {
  roots_.push_back(resolved(fs::path(shader_file).parent_path()));
  for (const std::string& folder : include_folders) roots_.push_back(resolved(folder));
}

bool SourceFiles::allowed(const std::string& path) const {
  for (const std::string& root : roots_) {
    if (root.empty()) continue;
    if (root == "/" || (path.starts_with(root) && path.size() > root.size() && path[root.size()] == '/')) return true;
  }
  return false;
}

SourceFiles::Found SourceFiles::find(const std::string& name, bool quoted, const std::string& including_file) const {
  std::vector<fs::path> places;
  if (quoted) places.push_back(fs::path(including_file).parent_path());
  for (const std::string& folder : folders_) places.emplace_back(folder);
  std::string reason = "there is no such file";
  for (const fs::path& folder : places) {
    const fs::path path = folder / name;
    std::error_code failed;
    const fs::file_status status = fs::status(path, failed);
    if (!fs::exists(status)) continue;
    if (!fs::is_regular_file(status)) {
      reason = "it is not a regular file";
    } else if (!allowed(resolved(path))) {
      reason = "it lies outside the shader's folder and the include folders";
    } else {
      return {path.lexically_normal().string(), {}};
    }
  }
  return {{}, reason};
}

std::string SourceFiles::read(const std::string& path) {
  std::error_code failed;
  const fs::file_status status = fs::status(path, failed);
  if (!fs::exists(status)) throw Error("there is no such file");
  if (!fs::is_regular_file(status)) throw Error("it is not a regular file");
  if (fs::file_size(path, failed) > most_source_bytes || failed) throw Error("it is too large");
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw Error("it cannot be read");
  return std::move(text).str();
}

std::optional<std::string> SourceFiles::standard_header(const std::string& name) {
  if (fs::path(name).filename() == "stdosl.h") return std::string();
  return std::nullopt;
}

}  // namespace etendue::osl
