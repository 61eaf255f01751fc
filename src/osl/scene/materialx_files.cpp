// MaterialX documents as plugins: `plugin "brass.mtlx"` declares a class for each of its materials, which is the shader that
// MaterialX's own generator writes. The same for the materials of a USD scene that are networks of MaterialX.

#include <fmt/format.h>

#include <map>
#include <mutex>

#include "files/input_files.h"
#include "materialx/materialx_document.h"
#include "osl/language/compile.h"
#include "osl/running/places.h"
#include "osl_class.h"

namespace etendue::osl {

namespace {

struct State {
  std::mutex mutex;
  std::map<std::string, std::shared_ptr<const MaterialXDocument>> declared;  // by file
};
State& state() {
  static auto* s = new State;  // never destroyed: used until the program ends
  return *s;
}

/// Whether the classes of a document are still those that the registry finds.
bool in_use(const MaterialXDocument& document, const std::string& file) {
  for (const MaterialXMaterial& m : document.materials) {
    if (!m.problem.empty()) continue;
    const ClassInfo* info = Registry::instance().find(m.class_name);
    if (!info || info->provider != file) return false;
  }
  return true;
}

std::shared_ptr<const Shader> compiled(const std::string& text, const MaterialXMaterial& m, const MaterialXDocument& document,
                                       const std::string& file) {
  CompileOptions options;
  options.include_folders = document.include_folders;
  const std::string name = file + "(" + m.name + ")";
  const osl::Compiled made = compile_text(text, name, options);
  if (!made.failed()) return made.shader;
  std::string faults;
  for (const Diagnostic& d : made.diagnostics)
    if (!d.warning) faults += "\n  " + place_text(d.place) + ": " + d.text;
  throw Error(fmt::format("the shader that the package 'materialx' has written of '{}' cannot be compiled:{}", m.name, faults));
}

/// The shaders of a document's texts, by the text's number and the parameters' types and names.
using Shaders = std::map<std::string, std::shared_ptr<const Shader>>;

/// Compiling a whole surface takes a hundred times as long as its parameters alone: so of materials that differ in values only
/// one is compiled, and the others have their own names, parameters and defaults.
void declare_shader(const MaterialXShader& written, const MaterialXMaterial& m, const MaterialXDocument& document,
                    const std::string& file, Shaders& known) {
  const auto& [before, body] = document.texts[written.text];
  const std::shared_ptr<const Shader> own = compiled(written.frame + "{ }\n", m, document, file);
  std::string key = std::to_string(written.text);
  for (const Symbol* s : own->parameters) key += fmt::format(" {} {}", s->type.name(), s->name);
  std::shared_ptr<const Shader>& shader = known[key];
  if (!shader) shader = compiled(before + written.frame + body, m, document, file);
  for (std::unique_ptr<ClassInfo>& info : make_classes(shader, file, own)) {
    const ClassInfo* taken = Registry::instance().find(info->name);
    if (taken && taken->declared && taken->provider != file)
      warn(fmt::format("{}: '{}' has a class of this name, too; from now on it is that of '{}'", info->name, taken->provider,
                       file));
    Registry::instance().declare(std::move(info));
  }
}

void declare_materialx(const std::string& file) {
  State& s = state();
  const std::lock_guard lock(s.mutex);
  const std::shared_ptr<const MaterialXDocument> document = read_materialx(file);
  for (const std::string& path : document->files) note_input(path);
  if (const auto known = s.declared.find(file);
      known != s.declared.end() && known->second == document && in_use(*document, file))
    return;
  const Location at{intern(file), 0, 0};
  const bool told = document->told.exchange(true);
  for (const std::string& note : document->notes)
    if (!told) warn(note, at);
  bool any = false;
  Shaders shaders;
  for (const MaterialXMaterial& m : document->materials) {
    try {
      if (!m.problem.empty()) throw Error(m.problem);
      declare_shader(m.surface, m, *document, file, shaders);
      if (!m.displacement.empty()) declare_shader(m.displacement, m, *document, file, shaders);
      any = true;
    } catch (const Error& e) {
      // A material that cannot be read does not take the others with it.
      const std::string reason = fmt::format("{}: {}", m.name, e.what());
      if (document->materials.size() == 1) throw Error(reason, e.location);
      if (!told || m.problem.empty()) warn(reason + ": it is left out", at);
    }
  }
  if (!any) throw Error("none of its materials can be read");
  s.declared[file] = document;
}

/// When the library is loaded, it becomes the registry's reader of such files.
const bool announced = [] {
  for (const char* ending : {".mtlx", ".usd", ".usda", ".usdc", ".usdz"})
    Registry::instance().read_plugins(ending, declare_materialx);
  return true;
}();

}  // namespace

}  // namespace etendue::osl
