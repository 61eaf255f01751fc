// What determines a job's samples: its description and the contents of the files that names.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "checkpoint.h"
#include "describe/guard.h"
#include "etendue/describe/registry.h"
#include "etendue/language/language.h"
#include "files/file_content.h"
#include "files/input_files.h"
#include "images/udim_files.h"

namespace etendue {

namespace {

namespace fs = std::filesystem;

/// The folder of the file a job was written in.
std::string folder_of(const Job& job) {
  const fs::path file = job.origin ? job.origin->location.file : "";
  std::error_code error;
  const fs::path folder = fs::absolute(file.has_parent_path() ? file.parent_path() : fs::path("."), error);
  return error ? std::string() : folder.lexically_normal().string();
}

/// Finds the files that a component and all its parts name, by reflection.
class FileCollector {
 public:
  explicit FileCollector(const std::string& folder) : folder_(folder) {}

  void visit(const Component& c) {
    if (!visited_.insert(&c).second) return;
    if (dynamic_cast<const Output*>(&c)) return;  // what that names is written
    const ClassInfo& info = c.class_info();
    // The code of a plugin determines samples as well.
    if (!info.provider.empty()) add(info.provider);
    for (const Member& member : info.members) {
      if (member.kind != Kind::component && member.kind != Kind::file && member.kind != Kind::color) continue;
      visit(member.get(c, member));
    }
  }
  std::vector<std::string> paths() const {
    std::vector<std::string> list;
    for (const auto& [name, path] : paths_) list.push_back(path);
    return list;
  }
  std::vector<Identity::File> files() const {
    std::vector<Identity::File> list;
    for (const auto& [name, path] : paths_) {
      const FileContent content = content_of(path);
      list.push_back({name, content.size, content.hash});
    }
    return list;
  }

 private:
  void visit(const Value& value) {
    if (const auto* c = value.as<Ref<Component>>()) {
      if (*c) visit(**c);
    } else if (const auto* file = value.as<FilePath>()) {
      if (!file->empty()) add(file->resolved());
    } else if (const auto* color = value.as<Color>()) {
      if (*color) visit_expression((*color)->expression());
    } else if (const auto* list = value.as<Value::List>()) {
      for (const Value& item : *list) visit(item);
    }
  }
  /// `spectrum("path"`, anywhere in a colour's expression.
  void visit_expression(const std::string& expression) {
    static constexpr std::string_view call = "spectrum(\"";
    for (size_t at = expression.find(call); at != std::string::npos; at = expression.find(call, at + 1)) {
      std::string path;
      for (size_t i = at + call.size(); i < expression.size() && expression[i] != '"'; ++i) {
        if (expression[i] == '\\' && i + 1 < expression.size()) {
          const char escaped = expression[++i];
          path += escaped == 'n' ? '\n' : (escaped == 't' ? '\t' : escaped);
        } else {
          path += expression[i];
        }
      }
      add(path);
    }
  }
  /// A file, or the images of all unit squares that a name with <UDIM> stands for.
  void add(const std::string& path) {
    for (const UdimFile& image : udim_files(path)) add_one(image.path);
    add_one(path);
  }
  void add_one(const std::string& path) {
    std::error_code error;
    const fs::path full = fs::absolute(path, error).lexically_normal();
    paths_[error || folder_.empty() ? path : full.lexically_relative(folder_).string()] = path;
  }

  std::string folder_;
  std::set<const Component*> visited_;
  std::map<std::string, std::string> paths_;  // as told, and as opened
};

/// The line of `text` in which it begins to differ from `other`, quoted and short enough to be shown.
std::string different_line(const std::string& text, const std::string& other) {
  const auto at = size_t(std::ranges::mismatch(text, other).in1 - text.begin());
  const size_t before = at == 0 ? std::string::npos : text.rfind('\n', at - 1),
               end = std::min(text.find('\n', at), text.size());
  size_t begin = before == std::string::npos ? 0 : before + 1;
  begin = std::min(text.find_first_not_of(' ', begin), end);
  if (begin == end) return "nothing";
  constexpr size_t most = 60;
  if (end - begin <= most) return "'" + text.substr(begin, end - begin) + "'";
  // The part with the difference, cut between characters.
  size_t from = at > begin + most / 2 ? std::min(at - most / 2, end - most) : begin, to = from + most;
  const auto within_character = [&](size_t i) { return i < end && (static_cast<unsigned char>(text[i]) & 0xC0) == 0x80; };
  while (within_character(from)) ++from;
  while (within_character(to)) ++to;
  return "'" + std::string(from > begin ? "…" : "") + text.substr(from, to - from) + (to < end ? "…'" : "'");
}

}  // namespace

Identity identity_of(const Job& job) {
  // A job of the same parts without those that do not matter, so that nothing is changed or copied but the renderer.
  const std::string folder = folder_of(job);
  const Ref<Job> bare = make<Job>();
  bare->renderer = ref_cast<Renderer>(copy(*job.renderer));
  bare->renderer->samples = ref_cast<Renderer>(create(job.renderer->class_info()))->samples;
  bare->camera = job.camera;
  bare->scene = job.scene;
  bare->image = job.image;
  bare->wavelengths = job.wavelengths;
  Identity identity;
  // With this spelling of the folder no path in it keeps the spelling it was given with: "./a.ply" and "a.ply" are the same.
  identity.text = write_description(*bare, false, folder.empty() ? folder : folder + "/.");
  FileCollector files(folder);
  files.visit(*bare);
  identity.files = files.files();
  return identity;
}

std::vector<std::string> files_named_by(const Component& component) {
  FileCollector files({});
  files.visit(component);
  return files.paths();
}

void note_inputs_of(const Component& component) {
  for (const std::string& path : files_named_by(component)) note_input(path);
}

std::string difference(const Identity& a, const std::string& whose, const Identity& b, const std::string& other_whose) {
  if (a.text != b.text)
    return fmt::format("the description differs: {} in {}, {} in {}", different_line(a.text, b.text), whose,
                       different_line(b.text, a.text), other_whose);
  const auto same = [](const Identity::File& x, const Identity::File& y) { return x == y; };
  const auto [x, y] = std::ranges::mismatch(a.files, b.files, same);
  if (x == a.files.end() && y == b.files.end()) return {};
  if (x == a.files.end() || y == b.files.end() || x->name != y->name) {
    // In order of names: the first that only one of them has.
    const bool only_first = y == b.files.end() || (x != a.files.end() && x->name < y->name);
    return fmt::format("the description stands for other files: only {} has '{}'", only_first ? whose : other_whose,
                       only_first ? x->name : y->name);
  }
  return fmt::format("the contents of '{}' differ between {} and {}", x->name, whose, other_whose);
}

}  // namespace etendue
