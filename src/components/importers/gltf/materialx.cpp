// The material extension ETENDUE_materialx: shaders of MaterialX documents.

#include <algorithm>

#include "etendue/shader.h"
#include "materials.h"
#include "materialx/materialx_document.h"

namespace etendue::gltf {

std::optional<Material> Materials::materialx(const Json& source) {
  const std::string file = text(source, "file"), name = text(source, "name");
  try {
    const auto document = read_materialx(file, importing_.options().allowed_folders);
    for (const std::string& note : document->notes) importing_.inexact(note, at());
    document->told = true;
    Registry::instance().load_plugin(file);
    const auto found = std::ranges::find(document->materials, name, &MaterialXMaterial::name);
    if (found == document->materials.end()) throw Error("it is not among the materials that can be read");
    if (!found->problem.empty()) throw Error(found->problem);
    Material material;
    const Ref<Component> made = importing_.make(found->class_name, at(), name);
    if (ref_cast<Shader>(made))
      material.made.shader = made;
    else
      material.made.emission = made;
    if (found->emits && material.made.shader && Registry::instance().find(found->class_name + "Emission"))
      material.made.emission = importing_.make(found->class_name + "Emission", at(), name + "_emission");
    if (!found->displacement.empty()) importing_.inexact("the displacement of materials is left out", at());
    material.uv_set = whole(source, "uv_set").value_or(0);
    return material;
  } catch (const Error& error) {
    importing_.inexact(fmt::format("the material {} of MaterialX is grey: {}", name, error.what()), at());
    return std::nullopt;
  }
}

}  // namespace etendue::gltf
