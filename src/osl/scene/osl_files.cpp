// Files of the language as plugins: `plugin "marble.osl"` declares the classes of the shader.

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <sstream>

#include "files/input_files.h"
#include "osl/language/advice.h"
#include "osl/language/compile.h"
#include "osl_class.h"

namespace etendue::osl {

namespace {

std::string content_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// What a file was when it was compiled: the contents of all files that it is made of.
struct Declared {
  std::map<std::string, std::string> contents;
  std::shared_ptr<const Shader> shader;
  bool has_classes = false;
  bool current() const {
    for (const auto& [path, content] : contents)
      if (content_of(path) != content) return false;
    return true;
  }
};

struct State {
  std::mutex mutex;
  std::map<std::string, Declared> files;
};
State& state() {
  static auto* s = new State;  // never destroyed: used until the program ends
  return *s;
}

}  // namespace

namespace {

/// Compiles a file, unless it is what it was when it was compiled last. The state is locked.
struct Read {
  Declared& declared;
  bool is_new;
};
Read read(State& s, const std::string& file) {
  if (const auto known = s.files.find(file); known != s.files.end() && known->second.current()) return {known->second, false};
  const Compiled compiled = compile_file(file);
  for (const std::string& path : compiled.files) note_input(path);
  if (compiled.failed()) {
    Location at;
    std::vector<Diagnostic> errors;
    for (const Diagnostic& d : compiled.diagnostics)
      if (!d.warning) errors.push_back(d);
    if (!errors.empty()) at = errors.front().place;
    std::string text = to_text(errors);
    while (text.ends_with('\n')) text.pop_back();
    throw Error(text.empty() ? "cannot be compiled" : "\n" + text, at);
  }
  for (const Diagnostic& d : compiled.diagnostics)
    if (d.warning) warn(d.text, d.place);
  for (const Diagnostic& d : advice(*compiled.shader)) warn(d.text, d.place);
  Declared declared;
  declared.shader = compiled.shader;
  for (const std::string& path : compiled.files) declared.contents[path] = content_of(path);
  declared.contents.try_emplace(file, content_of(file));
  return {s.files[file] = std::move(declared), true};
}

}  // namespace

void declare_file(const std::string& file) {
  State& s = state();
  const std::lock_guard lock(s.mutex);
  Declared& declared = read(s, file).declared;
  for (const auto& [path, content] : declared.contents) note_input(path);
  if (declared.has_classes) return;
  for (std::unique_ptr<ClassInfo>& info : make_classes(declared.shader, file)) {
    const ClassInfo* taken = Registry::instance().find(info->name);
    if (taken && taken->declared && taken->provider != file)
      throw Error(fmt::format("{}: '{}' has a class of this name, too", info->name, taken->provider), declared.shader->place);
    Registry::instance().declare(std::move(info));
  }
  declared.has_classes = true;
}

std::shared_ptr<const Shader> declared_shader(const std::string& name, const std::vector<std::string>& folders, Location at) {
  State& s = state();
  const std::lock_guard lock(s.mutex);
  const std::string file = name.ends_with(".osl") ? name : name + ".osl";
  for (const std::string& folder : folders) {
    const std::string path = (std::filesystem::path(folder) / file).string();
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) continue;
    const Declared& declared = read(s, path).declared;
    for (const auto& [input, content] : declared.contents) note_input(input);
    return declared.shader;
  }
  std::vector<std::string> known;
  for (const auto& [other, declared] : s.files) {
    if (!declared.has_classes) continue;
    if (declared.shader->name == name) return declared.shader;
    known.push_back(declared.shader->name);
  }
  throw Error(
      fmt::format("there is no shader '{}': neither a class of a plugin{} nor a file '{}'{}", name, suggestion(name, known),
                  file, folders.empty() ? "" : fmt::format(" in '{}'", fmt::join(folders, "' or '"))),
      at);
}

namespace {

/// When the library is loaded, it becomes the registry's reader of such files.
const bool announced = [] {
  Registry::instance().read_plugins(".osl", declare_file);
  return true;
}();

}  // namespace

}  // namespace etendue::osl
