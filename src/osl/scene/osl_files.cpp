// Files of the language as plugins: `plugin "marble.osl"` declares the classes of the shader.

#include <fmt/format.h>

#include <fstream>
#include <map>
#include <mutex>
#include <sstream>

#include "files/input_files.h"
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

/// What a file was when its classes were declared: the contents of all files that it is made of.
struct Declared {
  std::map<std::string, std::string> contents;
  std::vector<std::string> classes;
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

void declare_file(const std::string& file) {
  State& s = state();
  const std::lock_guard lock(s.mutex);
  if (const auto known = s.files.find(file); known != s.files.end() && known->second.current()) return;
  const Compiled compiled = compile_file(file);
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
  Declared declared;
  for (const std::string& path : compiled.files) {
    note_input(path);
    declared.contents[path] = content_of(path);
  }
  declared.contents.try_emplace(file, content_of(file));
  for (std::unique_ptr<ClassInfo>& info : make_classes(compiled.shader, file)) {
    const ClassInfo* taken = Registry::instance().find(info->name);
    if (taken && taken->declared && taken->provider != file)
      throw Error(fmt::format("{}: '{}' has a class of this name, too", info->name, taken->provider), compiled.shader->place);
    declared.classes.push_back(info->name);
    Registry::instance().declare(std::move(info));
  }
  s.files[file] = std::move(declared);
}

namespace {

/// When the library is loaded, it becomes the registry's reader of such files.
const bool announced = [] {
  Registry::instance().read_plugins(".osl", declare_file);
  return true;
}();

}  // namespace

}  // namespace etendue::osl
