// Importing, the services that all importers share: finding files, the folders that may be read, and collecting warnings.

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "etendue/importer.h"
#include "files/regular_file.h"
#include "images/linear_image.h"

namespace etendue {

namespace fs = std::filesystem;

namespace {

/// The path with all symbolic links resolved and without "..", as far as it exists.
fs::path real_path(const fs::path& path) {
  std::error_code error;
  fs::path found = fs::weakly_canonical(fs::absolute(path, error), error);
  return error ? path : found;
}

bool within(const fs::path& path, const fs::path& folder) {
  const auto [end, rest] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return end == folder.end() || (std::next(end) == folder.end() && end->empty());  // "folder/" ends with an empty name
}

bool same_letters(const std::string& a, const std::string& b) {
  return std::ranges::equal(a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error) && !fs::is_directory(path, error);
}

/// The file of this name in a folder, ignoring case.
std::optional<fs::path> in_folder(const fs::path& folder, const std::string& name) {
  std::error_code error;
  std::vector<fs::path> found;
  for (fs::directory_iterator i(folder, error), end; !error && i != end; i.increment(error))
    if (same_letters(i->path().filename().string(), name) && is_file(i->path())) found.push_back(i->path());
  if (found.empty()) return std::nullopt;
  return *std::ranges::min_element(found);
}

}  // namespace

Importing::Importing(std::string path, ImportOptions options, std::vector<std::pair<std::string, std::string>> parameters)
    : path_(std::move(path)),
      folder_(fs::path(path_).parent_path().string()),
      name_(intern(path_)),
      options_(std::move(options)),
      parameters_(std::move(parameters)),
      used_(parameters_.size()) {}

std::string Importing::contents(const std::string& path, Location at) const {
  try {
    return read_regular_file(path);
  } catch (const Error& error) {
    throw Error(fmt::format("cannot read '{}': {}", path, error.what()), at);
  }
}

std::optional<std::string> Importing::parameter(const std::string& name) {
  for (size_t i = 0; i < parameters_.size(); ++i)
    if (parameters_[i].first == name) {
      used_[i] = true;
      return parameters_[i].second;
    }
  return std::nullopt;
}

bool Importing::allowed(const std::string& path) const {
  const fs::path found = real_path(path);
  if (within(found, real_path(folder_.empty() ? "." : folder_))) return true;
  return std::ranges::any_of(options_.allowed_folders,
                             [&](const std::string& folder) { return within(found, real_path(folder)); });
}

void Importing::add_search_folder(const std::string& folder, Location at) {
  const std::string path = (fs::path(folder_) / folder).string();
  if (!allowed(path))
    throw Error(fmt::format("'{}' is outside of the folder of '{}'; --allow-path {} lets files be read there", folder, path_,
                            real_path(path).string()),
                at);
  search_folders_.push_back(path);
}

std::optional<std::string> Importing::find(const std::string& named, const std::string& beside, std::string& why_not) const {
  if (named.empty()) {
    why_not = "the file name is empty";
    return std::nullopt;
  }
  if (named.find('\0') != std::string::npos) {
    why_not = "the file name holds a zero byte";
    return std::nullopt;
  }
  std::string slashes = named;
  std::ranges::replace(slashes, '\\', '/');
  std::vector<std::string> folders{beside.empty() ? folder_ : beside};
  if (!beside.empty() && beside != folder_) folders.push_back(folder_);
  folders.insert(folders.end(), search_folders_.begin(), search_folders_.end());
  std::string refused;
  for (const std::string& spelling : {named, slashes})
    for (const std::string& folder : folders) {
      const fs::path path = fs::path(folder) / spelling;
      if (!is_file(path)) continue;
      if (allowed(path.string())) return path.string();
      refused = real_path(path).parent_path().string();
    }
  // Sources often name folders of the author's machine: a file of the same last name beside the source is taken instead.
  const std::string last = fs::path(slashes).filename().string();
  for (const std::string& folder : folders)
    if (const auto path = in_folder(folder.empty() ? "." : folder, last); path && allowed(path->string()))
      return folder.empty() ? path->filename().string() : path->string();
  why_not = refused.empty() ? fmt::format("there is no file '{}'", named)
                            : fmt::format("'{}' is outside of the folder of '{}'; --allow-path {} lets files be read there",
                                          named, path_, refused);
  return std::nullopt;
}

std::string Importing::file(const std::string& named, Location at, const std::string& beside) const {
  std::string why_not;
  if (auto found = find(named, beside, why_not)) return *found;
  throw Error(why_not, at);
}

std::optional<std::string> Importing::optional_file(const std::string& named, Location at, const std::string& beside) {
  std::string why_not;
  if (auto found = find(named, beside, why_not)) return found;
  inexact(why_not, at);
  return std::nullopt;
}

const std::vector<std::string>& Importing::image_channels(const std::string& path) {
  const auto known = channels_.find(path);
  return known != channels_.end() ? known->second : channels_[path] = etendue::image_channels(path);
}

void Importing::inexact(const std::string& what, Location at) {
  Note& note = notes_[what];
  if (note.count++ == 0) {
    note.first = at;
    note.order = notes_.size();
  }
}

std::vector<Error> Importing::notes() const {
  std::vector<std::pair<size_t, Error>> all;
  for (const auto& [text, note] : notes_) {
    std::string more =
        note.count > 1 ? fmt::format(" (and at {} more place{})", note.count - 1, note.count > 2 ? "s" : "") : "";
    all.emplace_back(note.order, Error(text + more, note.first));
  }
  for (size_t i = 0; i < parameters_.size(); ++i)
    if (!used_[i])
      all.emplace_back(notes_.size() + 1 + i, Error(fmt::format("the file has no parameter '{}'", parameters_[i].first),
                                                    {intern("-D " + parameters_[i].first), 0, 0}));
  std::ranges::sort(all, {}, [](const auto& entry) { return entry.first; });
  std::vector<Error> notes;
  for (auto& entry : all) notes.push_back(std::move(entry.second));
  return notes;
}

Ref<Component> Importing::make(const std::string& class_name, Location at, const std::string& name) const {
  Ref<Component> part = Registry::instance().create(class_name);
  part->origin = std::make_unique<Component::Origin>();
  part->origin->location = at;
  part->origin->name = name;
  return part;
}

}  // namespace etendue
