#include "folders.h"

#include <fmt/format.h>

#include <filesystem>

#include "merge.h"

namespace etendue::studio {

namespace fs = std::filesystem;
using language::Node;
using language::NodeType;

std::string canonical_path(const std::string& path) {
  std::error_code error;
  const fs::path found = fs::weakly_canonical(fs::absolute(path.empty() ? "." : path), error);
  if (error) throw Error(fmt::format("'{}': {}", path, error.message()));
  const fs::path normal = found.lexically_normal();
  return (normal.has_filename() ? normal : normal.parent_path()).string();
}

void Folders::allow(const std::string& folder) {
  const std::string path = canonical_path(folder);
  if (!fs::is_directory(path)) throw Error(fmt::format("'{}' is not a folder", folder));
  if (std::find(folders_.begin(), folders_.end(), path) == folders_.end()) folders_.push_back(path);
}

bool Folders::contains(const std::string& path) const {
  if (path.find('\0') != std::string::npos) return false;
  std::string real;
  try {
    real = canonical_path(path);
  } catch (const Error&) {
    return false;
  }
  // A symbolic link without a target is refused, since writing to it would create the target.
  std::error_code error;
  if (fs::is_symlink(fs::symlink_status(real, error))) return false;
  for (const std::string& folder : folders_)
    if (real == folder || real.starts_with(folder == "/" ? folder : folder + "/")) return true;
  return false;
}

std::string Folders::inside(const std::string& path) const {
  if (!contains(path))
    throw Error(fmt::format("'{}' is outside of the folders that this studio may use ({}): allow more with --allow-path", path,
                            fmt::join(folders_, ", ")));
  return canonical_path(path);
}

std::vector<NamedFile> files_loaded_by(const Outline& outline, const std::string& folder) {
  std::vector<NamedFile> files;
  const auto resolved = [&](const std::string& text) { return FilePath{text, folder}.resolved(); };
  for (const language::Inclusion& include : outline.syntax().includes)
    files.push_back({resolved(include.path.text), include.path.at});
  for (const language::Label& plugin : outline.syntax().plugins) files.push_back({resolved(plugin.text), plugin.at});
  std::vector<const Node*> rest;
  for (const language::Definition& d : outline.syntax().definitions) rest.push_back(&d.value);
  for (const Node& c : outline.syntax().components) rest.push_back(&c);
  while (!rest.empty()) {
    const Node& node = *rest.back();
    rest.pop_back();
    std::error_code error;
    if (node.type == NodeType::string && !node.text.empty() && node.text.find('\0') == std::string::npos &&
        fs::exists(resolved(node.text), error))
      files.push_back({resolved(node.text), node.at});
    for (const Node& child : node.children) rest.push_back(&child);
  }
  return files;
}

std::vector<NamedFile> files_named_by(const Job& job) {
  std::vector<NamedFile> files;
  const auto add = [&](const Component& part, const Member& member, const Value& value) {
    if (const auto* file = value.as<FilePath>(); file && !file->empty())
      files.push_back({file->resolved(), part.location_of(member.name)});
  };
  for (const Ref<Component>& part : components_of(job))
    for (const Member& member : part->class_info().members) {
      if (member.kind != Kind::file) continue;
      const Value value = member.get(*part, member);
      add(*part, member, value);
      if (const auto* list = value.as<Value::List>())
        for (const Value& item : *list) add(*part, member, item);
    }
  return files;
}

}  // namespace etendue::studio
