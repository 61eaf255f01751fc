// Exporting, the services that all exporters share: files beside the exported one, names, and warnings.

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "etendue/exporter.h"
#include "files/contained_file.h"
#include "files/input_files.h"
#include "files/regular_file.h"
#include "files/whole_file.h"

namespace etendue {

namespace fs = std::filesystem;

Exporting::Exporting(std::string path) : path_(std::move(path)) {
  folder_ = fs::path(path_).parent_path().string();
  stem_ = fs::path(path_).stem().string();
}

void Exporting::inexact(const std::string& what, const Component* of, std::string_view member) {
  const auto [place, added] = note_of_.emplace(what, notes_.size());
  if (added) notes_.push_back({what, of ? of->location_of(member) : Location{}, 0});
  ++notes_[place->second].count;
}

std::vector<Error> Exporting::notes() const {
  std::vector<Error> all;
  for (const Note& note : notes_)
    all.emplace_back(note.count > 1 ? fmt::format("{} ({} times)", note.what, note.count) : note.what, note.first);
  return all;
}

bool Exporting::is_free(const std::string& path) const { return !taken_paths_.contains(path) && input_at(path).empty(); }

std::string Exporting::write_beside(const std::string& what, const std::string& ending, std::string bytes) {
  std::string name, path;
  do {
    name = fmt::format("{}-{}{}.{}", stem_, what, ++numbers_[what], ending);
    path = (fs::path(folder_) / name).string();
  } while (!is_free(path));
  taken_paths_.insert(path);
  beside_.push_back({path, std::move(bytes), {}});
  return name;
}

std::string Exporting::copy_beside(const std::string& path) {
  if (const auto inner = contained_file(path)) return unpack_beside(path, *inner);
  std::error_code error;
  const fs::path here = fs::weakly_canonical(fs::absolute(folder_.empty() ? fs::path(".") : fs::path(folder_)), error);
  const fs::path from = fs::weakly_canonical(fs::absolute(path), error);
  const fs::path relative = from.lexically_relative(here);
  if (!taken_paths_.contains((fs::path(folder_) / relative).string())) note_input(from.string());  // else written here
  if (!relative.empty() && *relative.begin() != "..") return relative.generic_string();
  std::string& name = copied_[from.string()];
  if (!name.empty()) return name;
  try {
    require_regular_file(from.string());
  } catch (const Error& reason) {
    throw Error(fmt::format("cannot read '{}': {}", path, reason.what()));
  }
  // Two files of the same name in two folders must stay separate.
  const std::string last = from.filename().string();
  std::string target;
  do {
    const int number = numbers_["copy of " + last]++;
    name = number == 0 ? fmt::format("{}-{}", stem_, last) : fmt::format("{}-{}-{}", stem_, number, last);
    target = (fs::path(folder_) / name).string();
  } while (!is_free(target));
  taken_paths_.insert(target);
  beside_.push_back({target, {}, from.string()});
  return name;
}

// An image inside a model file, which other programs cannot open there, is extracted to a file of its own.
std::string Exporting::unpack_beside(const std::string& path, const ContainedFile& inner) {
  std::error_code error;
  const fs::path container = fs::weakly_canonical(fs::absolute(inner.container), error);
  note_input(container.string());
  std::string& name = copied_[container.string() + "#" + inner.name];
  if (!name.empty()) return name;
  // "model.glb#images[3].png" becomes "model-images_3.png", prefixed with the stem.
  const fs::path last(inner.name);
  std::string plain;
  for (const char c : last.stem().string())
    if (std::isalnum(static_cast<unsigned char>(c)))
      plain += c;
    else if (c == '[' || c == '_' || c == '-')
      plain += '_';
  std::string bytes;
  try {
    bytes = read_regular_file(path);
  } catch (const Error& reason) {
    throw Error(fmt::format("cannot read '{}': {}", path, reason.what()));
  }
  std::string target;
  const std::string whole = fmt::format("{}-{}", container.stem().string(), plain), ending = last.extension().string();
  do {
    const int number = numbers_["copy of " + whole + ending]++;
    name = number == 0 ? fmt::format("{}-{}{}", stem_, whole, ending) : fmt::format("{}-{}-{}{}", stem_, number, whole, ending);
    target = (fs::path(folder_) / name).string();
  } while (!is_free(target));
  taken_paths_.insert(target);
  beside_.push_back({target, std::move(bytes), {}});
  return name;
}

std::vector<std::string> Exporting::files_beside() const {
  std::vector<std::string> all;
  for (const Beside& file : beside_) all.push_back(file.path);
  return all;
}

void Exporting::write_files() const {
  for (const Beside& file : beside_)
    write_whole_file(file.path, file.source.empty() ? file.bytes : read_regular_file(file.source));
}

std::string Exporting::name_for(const Component& part) {
  std::string& name = names_[&part];
  if (!name.empty()) return name;
  name = part.origin && !part.origin->name.empty() ? part.origin->name : part.class_info().name;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_') c = '_';
  if (const int number = taken_[name]++; number > 0) name += fmt::format("_{}", number + 1);
  while (std::ranges::count_if(names_, [&](const auto& other) { return other.second == name; }) > 1) name += "_";
  return name;
}

}  // namespace etendue
