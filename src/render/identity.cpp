// Identity: what determines a job's samples, which is its description and the contents of the files that it names.

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

/// The folder of the file that contains the job.
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
    if (dynamic_cast<const Output*>(&c)) return;  // outputs name files that are written, not read
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
  /// Adds the path of each call `spectrum("path"` in the expression of a colour.
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
  /// Adds a file, or the images of all unit squares for a name with <UDIM>.
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
  std::map<std::string, std::string> paths_;  // by the name in the identity, the path to open
};

/// The first line of `text` that differs from `other`, quoted and shortened.
std::string different_line(const std::string& text, const std::string& other) {
  const auto at = size_t(std::ranges::mismatch(text, other).in1 - text.begin());
  const size_t before = at == 0 ? std::string::npos : text.rfind('\n', at - 1),
               end = std::min(text.find('\n', at), text.size());
  size_t begin = before == std::string::npos ? 0 : before + 1;
  begin = std::min(text.find_first_not_of(' ', begin), end);
  if (begin == end) return "nothing";
  constexpr size_t most = 60;
  if (end - begin <= most) return "'" + text.substr(begin, end - begin) + "'";
  // The part with the difference, cut between UTF-8 characters.
  size_t from = at > begin + most / 2 ? std::min(at - most / 2, end - most) : begin, to = from + most;
  const auto within_character = [&](size_t i) { return i < end && (static_cast<unsigned char>(text[i]) & 0xC0) == 0x80; };
  while (within_character(from)) ++from;
  while (within_character(to)) ++to;
  return "'" + std::string(from > begin ? "…" : "") + text.substr(from, to - from) + (to < end ? "…'" : "'");
}

}  // namespace

Identity identity_of(const Job& job) {
  // A job of the same components without those that do not affect samples: only the renderer is copied, and nothing is changed.
  const std::string folder = folder_of(job);
  const Ref<Job> bare = make<Job>();
  bare->renderer = ref_cast<Renderer>(copy(*job.renderer));
  bare->renderer->samples = ref_cast<Renderer>(create(job.renderer->class_info()))->samples;
  bare->camera = job.camera;
  bare->scene = job.scene;
  bare->image = job.image;
  bare->wavelengths = job.wavelengths;
  bare->groups = job.groups;
  Identity identity;
  // Written with the folder as "folder/.", no path keeps its original spelling: "./a.ply" and "a.ply" become the same.
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
    // The files are sorted by name: this is the first one that only one of the two has.
    const bool only_first = y == b.files.end() || (x != a.files.end() && x->name < y->name);
    return fmt::format("the description stands for other files: only {} has '{}'", only_first ? whose : other_whose,
                       only_first ? x->name : y->name);
  }
  return fmt::format("the contents of '{}' differ between {} and {}", x->name, whose, other_whose);
}

}  // namespace etendue
