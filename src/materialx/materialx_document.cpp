#include "materialx_document.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <sstream>

#include "etendue/describe/registry.h"
#include "files/helper_process.h"

namespace etendue {

namespace {

std::string content_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return std::move(text).str();
}

/// A document as it was read: for whom, and the contents of its files.
struct Read {
  std::vector<std::string> allowed_folders;
  std::map<std::string, std::string> contents;
  std::shared_ptr<const MaterialXDocument> document;

  bool current() const {
    for (const auto& [path, content] : contents)
      if (content_of(path) != content) return false;
    return true;
  }
};

/// Runs one of our programs in Python; `words` names the package that it needs.
std::string run_python(const std::string& name, std::vector<std::string> arguments, const char* package,
                       std::string_view input) {
  const std::string script = helper_path(name);
  if (script.empty()) throw Error("the program '" + name + "', which reads MaterialX, is not there: install it too");
  const char* chosen = std::getenv("ETENDUE_PYTHON");
  arguments.insert(arguments.begin(), script);
  try {
    return run_program(chosen && *chosen ? chosen : "python3", arguments, name, input);
  } catch (const NotStarted& error) {
    throw Error(
        fmt::format("MaterialX documents are read by Python, but {}; install it with its package (pip install {}), or name "
                    "one that has it by ETENDUE_PYTHON",
                    error.what(), package));
  }
}

bool is_document(const std::string& path) { return path.ends_with(".mtlx"); }

std::string run_reader(const std::string& path, const std::vector<std::string>& allowed_folders) {
  std::vector<std::string> arguments{path};
  std::string text;
  if (!is_document(path)) {  // the networks of a USD scene
    std::vector<std::string> of_usd{"--materialx", path, "0"};
    of_usd.insert(of_usd.end(), allowed_folders.begin(), allowed_folders.end());
    text = run_python("etendue_usd.py", of_usd, "usd-core numpy materialx", {});
    arguments.insert(arguments.begin(), "--text");
  }
  arguments.insert(arguments.end(), allowed_folders.begin(), allowed_folders.end());
  return run_python("etendue_materialx.py", arguments, "materialx", text);
}

/// No class of a document may have the name of one of the program's own.
std::string free_class_name(const std::string& name) {
  const ClassInfo* taken = Registry::instance().find(name);
  return taken && !taken->declared ? name + "Material" : name;
}

}  // namespace

std::shared_ptr<MaterialXDocument> parse_materialx(const std::string& text) {
  const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  const auto made = std::make_shared<MaterialXDocument>();
  MaterialXDocument& document = *made;
  try {
    json.at("files").get_to(document.files);
    json.at("include").get_to(document.include_folders);
    json.at("notes").get_to(document.notes);
    json.at("texts").get_to(document.texts);
    for (const nlohmann::json& given : json.at("materials")) {
      MaterialXMaterial& m = document.materials.emplace_back();
      given.at("name").get_to(m.name);
      m.class_name = given.at("class").get<std::string>();
      m.problem = given.value("problem", "");
      const auto read_shader = [&](const char* name, MaterialXShader& shader) {
        if (!given.contains(name) || given.at(name).is_null()) return;
        given.at(name).at("frame").get_to(shader.frame);
        given.at(name).at("text").get_to(shader.text);
        if (shader.text >= document.texts.size()) throw Error("the number of a text is out of range");
      };
      read_shader("surface", m.surface);
      read_shader("displacement", m.displacement);
      m.vector = given.value("vector", false);
      m.emits = given.value("emits", false);
    }
  } catch (const nlohmann::json::exception&) {
    throw Error("etendue_materialx.py, which reads MaterialX, wrote something else than its materials");
  }
  return made;
}

std::shared_ptr<const MaterialXDocument> read_materialx(const std::string& named,
                                                        const std::vector<std::string>& allowed_folders) {
  std::error_code ignored;
  const std::string path = std::filesystem::weakly_canonical(named, ignored).string();  // one document by whatever name
  static std::mutex guard;
  static auto* const known = new std::map<std::string, Read>;  // never destroyed: used until the program ends
  const std::lock_guard lock(guard);
  if (const auto found = known->find(path); found != known->end()) {
    const Read& read = found->second;
    // What may name all files reads nothing else in a document that names only some.
    if ((read.allowed_folders == allowed_folders || allowed_folders == std::vector<std::string>{"/"}) && read.current())
      return read.document;
    known->erase(found);
  }
  const std::shared_ptr<MaterialXDocument> document = parse_materialx(run_reader(path, allowed_folders));
  for (MaterialXMaterial& m : document->materials) {
    const std::string free = free_class_name(m.class_name);
    if (free == m.class_name) continue;
    // The name stands in the text of the shader, which is its own but for the word that precedes it.
    for (auto [text, before, after] :
         {std::tuple(&m.surface.frame, "\nsurface " + m.class_name + "\n", "\nsurface " + free + "\n"),
          std::tuple(&m.displacement.frame, "\nshader " + m.class_name + "Displacement\n",
                     "\nshader " + free + "Displacement\n")})
      if (const size_t at = text->find(before); at != text->npos) text->replace(at, before.size(), after);
    m.class_name = free;
  }
  Read read{allowed_folders, {}, document};
  for (const std::string& file : document->files) read.contents[file] = content_of(file);
  (*known)[path] = read;
  return document;
}

std::shared_ptr<const MaterialXDocument> read_materialx(const std::string& path) { return read_materialx(path, {"/"}); }

}  // namespace etendue
