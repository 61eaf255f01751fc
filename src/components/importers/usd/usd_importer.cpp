// UsdImporter: Universal Scene Description, read by Pixar's own library in a process of its own (a Python program installed
// beside this library), which converts the file to .glb; that output is read and checked like any other glTF file.

#include <cstdlib>

#include "components/importers/gltf/document.h"
#include "components/importers/gltf/import_document.h"
#include "components/objects/meshes/mesh_data.h"
#include "files/helper_process.h"

namespace etendue {
namespace {

const std::vector<std::string>& endings() {
  static const std::vector<std::string> all{"usd", "usda", "usdc", "usdz"};
  return all;
}

std::string convert(const std::string& path, const Importing& importing) {
  const std::string script = helper_path("etendue_usd.py");
  if (script.empty()) throw Error("the program 'etendue_usd.py', which reads USD, is not there: install it too");
  const char* chosen = std::getenv("ETENDUE_PYTHON");
  std::vector<std::string> arguments{script, path, fmt::format("{}", importing.options().time)};
  for (const std::string& folder : importing.options().allowed_folders) arguments.push_back(folder);
  const std::string python = chosen && *chosen ? chosen : "python3";
  try {
    return run_program(python, arguments, "etendue_usd.py");
  } catch (const NotStarted& error) {
    throw Error(std::string("USD files are read by Python, but ") + error.what() +
                "; install it with its packages (pip install usd-core numpy), or name one that has them by ETENDUE_PYTHON");
  }
}

const bool known_converter = gltf::register_converter(endings(), convert);

class UsdImporter final : public Importer {
 public:
  static void describe(Description<UsdImporter>& d) {
    d.summary(
        "Universal Scene Description (.usd, .usda, .usdc, .usdz), read by the Python packages usd-core and numpy, which "
        "must be installed (pip install usd-core numpy; ETENDUE_PYTHON names the Python that has them).",
        "Pixar, Universal Scene Description");
  }
  std::vector<std::string> extensions() const override { return endings(); }
  Ref<Component> import(Importing& importing) const override { return gltf::import_document(importing); }
};

const Register<UsdImporter> registered;

}  // namespace
}  // namespace etendue
