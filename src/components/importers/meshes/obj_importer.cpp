// ObjImporter: Wavefront OBJ files with their MTL materials.

#include <filesystem>

#include "components/objects/meshes/mesh_data.h"
#include "components/objects/meshes/obj_lines.h"
#include "etendue/scene.h"
#include "files/regular_file.h"
#include "files/text_encoding.h"
#include "mtl.h"

namespace etendue {
namespace {

/// Throws the mesh reader's message "line 7: what is wrong" as an Error located at that line.
[[noreturn]] void throw_located(const Importing& importing, const std::string& words) {
  int line = 0, end = 0;
  if (std::sscanf(words.c_str(), "line %d: %n", &line, &end) == 1 && end > 0)
    throw Error(words.substr(size_t(end)), importing.at(line));
  throw Error(words, importing.at());
}

class ObjImporter final : public Importer {
 public:
  static void describe(Description<ObjImporter>& d) {
    d.summary(
        "Wavefront OBJ files with their MTL materials, also in the PBR extension (Pr, Pm, …): a mesh for each material that "
        "faces use.");
  }
  std::vector<std::string> extensions() const override { return {"obj"}; }

  Ref<Component> import(Importing& importing) const override {
    try {
      return read(importing);
    } catch (const Error& error) {
      if (error.location.known()) throw;
      throw_located(importing, error.what());
    }
  }

 private:
  static Ref<Component> read(Importing& importing) {
    const std::vector<std::string> parts = obj_parts(importing.path());
    std::map<std::string, MtlMaterial> materials;
    const Used used = read_libraries(importing, materials);
    const Ref<Scene> scene = ref_cast<Scene>(importing.make(imported_structure, importing.at()));
    for (const std::string& name : parts) {
      const auto line = used.lines.find(name);
      const Location at = importing.at(line == used.lines.end() ? 0 : line->second);
      const auto material = materials.find(name);
      Surface plain;
      plain.base_color = used.colored ? 1 : 0.7;
      plain.base_color.by_vertex = used.colored;
      plain.roughness = 0.5;
      if (material == materials.end() && !name.empty())
        importing.inexact(fmt::format("no material file says what '{}' is like: it is grey", name), at);
      if (material != materials.end()) {
        plain = material->second.surface;
        plain.base_color.by_vertex = used.colored;
        if (used.colored) importing.inexact("colours of vertices multiply those of materials", importing.at());
      }
      const MadeSurface made = make_surface(importing, plain, material == materials.end() ? at : material->second.at);
      Ref<Component> mesh = importing.make("TriangleMesh", at);
      set_member(*mesh, "file", FilePath{importing.path(), {}}, at);
      if (parts.size() > 1) set_member(*mesh, "part", "usemtl " + name, at);
      set(*mesh, "shader", Value(made.shader, at));
      if (made.emission) set(*mesh, "emission", Value(made.emission, at));
      if (made.interior) set(*mesh, "interior", Value(made.interior, at));
      scene->objects.push_back(ref_cast<SceneObject>(mesh));
    }
    return scene;
  }

  struct Used {
    std::map<std::string, int> lines;  // line of the first use of each material
    bool colored = false;              // vertices have colours
  };
  /// The warning for an OBJ statement whose geometry is left out, or null.
  static const char* not_shown(std::string_view word) {
    if (word == "l" || word == "p") return "points and lines are not shown";
    if (word == "curv" || word == "curv2" || word == "surf" || word == "cstype")
      return "curves and curved surfaces are not shown";
    return nullptr;
  }
  /// Reads the material libraries that the OBJ file names.
  static Used read_libraries(Importing& importing, std::map<std::string, MtlMaterial>& materials) {
    const FileContents contents(importing.path());
    const bool marked = has_byte_order_mark(contents.text());
    const std::string plain = marked ? as_utf8(contents.text()) : std::string();
    Used used;
    bool looked = false;
    for (Lines lines(marked ? std::string_view(plain) : contents.text()); lines.next();) {
      const std::string_view word = lines.keyword();
      if (word == "v" && !looked) {
        looked = true;
        int count = 0;
        try {
          for (; count < 7 && !lines.at_end(); ++count) lines.number();
        } catch (const Error&) {  // the mesh reader reports it
        }
        used.colored = used.colored || count == 6;
      }
      used.colored = used.colored || word == "#MRGB";
      if (const char* what = not_shown(word)) importing.inexact(what, importing.at(int(lines.line())));
      if (word == "usemtl") used.lines.try_emplace(std::string(lines.rest()), int(lines.line()));
      if (word != "mtllib") continue;
      const Location at = importing.at(int(lines.line()));
      for (const std::string& path : library_files(importing, std::string(lines.rest()), at))
        read_mtl(importing, path, materials);
    }
    return used;
  }

  /// `names` is one file name, which may contain spaces, or several names separated by spaces.
  static std::vector<std::string> library_files(Importing& importing, const std::string& names, Location at) {
    try {
      return {importing.file(names, at)};
    } catch (const Error&) {
      if (names.find(' ') == std::string::npos) {
        if (auto path = importing.optional_file(names, at)) return {*path};
        return {};
      }
    }
    std::vector<std::string> all, lost;
    for (size_t begin = 0; begin < names.size();) {
      const size_t end = std::min(names.find(' ', begin), names.size());
      const std::string name = names.substr(begin, end - begin);
      try {
        if (!name.empty()) all.push_back(importing.file(name, at));
      } catch (const Error&) {
        lost.push_back(name);
      }
      begin = end + 1;
    }
    if (all.empty()) lost = {names};  // one name that contains spaces
    for (const std::string& name : lost) (void)importing.optional_file(name, at);
    return all;
  }
};

const Register<ObjImporter> registered;

}  // namespace
}  // namespace etendue
