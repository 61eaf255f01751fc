// MeshImporter: file formats that hold triangles but no materials.

#include <algorithm>

#include "components/importers/models/surface.h"
#include "components/objects/meshes/mesh_data.h"
#include "etendue/scene.h"
#include "files/regular_file.h"

namespace etendue {
namespace {

class MeshImporter final : public Importer {
 public:
  static void describe(Description<MeshImporter>& d) {
    d.summary("STL, OFF and PLY files: triangles, in the colours of their vertices or else of their faces if they have any.");
  }
  std::vector<std::string> extensions() const override { return {"off", "ply", "stl"}; }

  Ref<Component> import(Importing& importing) const override {
    const Location at = importing.at();
    bool of_faces = false;  // whether colours belong to faces rather than to vertices
    std::optional<SurfaceTexture> texture;
    try {
      const MeshData read = read_mesh(importing.path());  // errors are reported at import, not when rendering begins
      const auto has = [](const std::vector<VertexAttribute>& list, const char* name) {
        return std::ranges::any_of(list, [&](const VertexAttribute& a) { return a.name == name; });
      };
      if (!read.texture.empty() && read.uvs.empty())
        importing.inexact("the image that it names is left out: its vertices have no surface coordinates", at);
      else if (!read.texture.empty())
        if (const auto file = importing.optional_file(read.texture, at)) texture = readable_texture(importing, *file, at);
      of_faces = has(read.face_attributes, "face_color") && !has(read.attributes, "color");
    } catch (const Error& error) {
      throw Error(error.what(), at);
    }
    Surface surface;
    surface.base_color = texture ? 1 : 0.7;
    surface.base_color.texture = texture;
    surface.roughness = 0.5;
    const MadeSurface made = make_surface(importing, surface, at);
    if (!texture) {
      Ref<Component> colors = importing.make("AttributeMap", at);
      if (of_faces) set_member(*colors, "name", "face_color", at);
      set_member(*colors, "otherwise", 0.7, at);
      set(*made.shader, "base_color", Value(colors, at));
    }
    Ref<Component> mesh = importing.make("TriangleMesh", at);
    set_member(*mesh, "file", FilePath{importing.path(), {}}, at);
    set(*mesh, "shader", Value(made.shader, at));
    const Ref<Scene> scene = ref_cast<Scene>(importing.make(imported_structure, at));
    scene->objects.push_back(ref_cast<SceneObject>(mesh));
    // Models for printing or machining (.stl) stand on the xy plane.
    if (importing.path().size() > 4 && std::tolower(importing.path()[importing.path().size() - 3]) == 's')
      importing.up = {0, 0, 1};
    return scene;
  }
};

const Register<MeshImporter> registered;

}  // namespace
}  // namespace etendue
