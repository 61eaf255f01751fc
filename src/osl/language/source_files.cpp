#include "source_files.h"

#include <filesystem>
#include <fstream>
#include <sstream>

#include "etendue/core/error.h"
#include "headers/headers.h"
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
  const char* const none = "there is no such file";
  std::string reason = none;
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
  const bool missing = reason == none;
  return {{}, std::move(reason), missing};
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

namespace {

constexpr std::string_view built_in_folder = "(built in)/";

using HeaderText = std::string (*)();
constexpr std::pair<std::string_view, HeaderText> headers[] = {
    {"color2.h", color2_header},   {"color4.h", color4_header},     {"vector2.h", vector2_header},
    {"vector4.h", vector4_header}, {"matrix33.h", matrix33_header}, {"oslutil.h", oslutil_header},
};

}  // namespace

std::string SourceFiles::built_in_path(const std::string& name) {
  const std::string last = fs::path(name).filename().string();
  for (const auto& [header, text] : headers)
    if (last == header) return std::string(built_in_folder) + last;
  return {};
}

std::optional<std::string> SourceFiles::built_in(const std::string& path) {
  if (path.starts_with(built_in_folder))
    for (const auto& [header, text] : headers)
      if (path.substr(built_in_folder.size()) == header) return text();
  return std::nullopt;
}

}  // namespace etendue::osl
