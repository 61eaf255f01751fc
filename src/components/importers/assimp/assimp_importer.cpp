// AssimpImporter: the formats that the library Assimp reads. Assimp runs in a process of its own (src/assimp), which converts
// the file to .glb; that output is read and checked like any other glTF file.

#include <fmt/format.h>

#include "components/importers/gltf/document.h"
#include "components/importers/gltf/import_document.h"
#include "components/objects/meshes/mesh_data.h"
#include "files/gzip.h"
#include "files/helper_process.h"
#include "head_of_3mf.h"

namespace etendue {
namespace {

const std::vector<std::string>& endings() {
  static const std::vector<std::string> all{"3ds", "3mf", "ac",  "ase",     "b3d",  "blend", "dae",
                                            "fbx", "lwo", "lws", "md5mesh", "ms3d", "x",     "x3d"};
  return all;
}

std::string convert(const std::string& path, const Importing& importing) {
  std::vector<std::string> arguments{path};
  HeadOf3mf head;
  if (ending_of_contents(path) == "3mf") {
    head = head_of_3mf(path);
    arguments.push_back(fmt::format("--unit={}", head.unit));
    if (head.face_colors) arguments.emplace_back("--note=colours and images of single triangles of 3MF are left out");
    if (head.parts_elsewhere) arguments.emplace_back("--note=parts in other files of the 3MF package are left out");
  }
  for (const std::string& folder : importing.options().allowed_folders) arguments.push_back(folder);
  try {
    return run_helper("etendue_assimp", arguments);
  } catch (const Error& error) {
    if (!head.parts_elsewhere) throw;
    throw Error(std::string(error.what()) +
                "; its parts lie in other files of the package (3MF's production extension), which "
                "is not read: save it without, or as STL or OBJ");
  }
}

const bool known_converter = gltf::register_converter(endings(), convert);

class AssimpImporter final : public Importer {
 public:
  static void describe(Description<AssimpImporter>& d) {
    d.summary(
        "Files of many other programs, such as FBX, 3DS, Collada, LightWave, ASE, DirectX and Blender, read by the library "
        "Assimp "
        "in a process of its own. -D camera= chooses by name or number.",
        "The Open Asset Import Library, github.com/assimp/assimp");
  }
  std::vector<std::string> extensions() const override { return endings(); }
  Ref<Component> import(Importing& importing) const override { return gltf::import_document(importing); }
};

const Register<AssimpImporter> registered;

}  // namespace
}  // namespace etendue
