// GltfImporter: glTF 2.0.

#include <algorithm>

#include "files/gzip.h"
#include "files/input_files.h"
#include "import_document.h"
#include "materials.h"
#include "scene_builder.h"

namespace etendue {
namespace gltf {
namespace {

/// Extensions that are supported, or that do not change the image, other than those of materials and textures.
constexpr const char* known_extensions[] = {"KHR_texture_transform", "KHR_lights_punctual", "KHR_mesh_quantization",
                                            "EXT_mesh_gpu_instancing", "KHR_materials_variants", "KHR_node_visibility",
                                            "KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression",
                                            // Metadata, interaction, and data that is neither visible nor emits light.
                                            "KHR_xmp", "KHR_xmp_json_ld", "KHR_node_selectability", "KHR_node_hoverability",
                                            "KHR_interactivity", "KHR_audio_emitter", "KHR_physics_rigid_bodies",
                                            "KHR_implicit_shapes", "EXT_mesh_features", "EXT_instance_features",
                                            "EXT_structural_metadata", "EXT_mesh_manifold"};

void check_extensions(Importing& importing, const Document& document) {
  const auto known = [](const std::string& name) {
    return std::ranges::find(known_extensions, name) != std::end(known_extensions) || is_known_material_extension(name) ||
           is_known_texture_extension(name);
  };
  std::vector<std::string> required;
  for (const Json& name : list_in(document.json(), "extensionsRequired")) {
    if (!name.is_string()) throw Error("'extensionsRequired' is not a list of names");
    required.push_back(name.get<std::string>());
    if (!known(required.back())) throw Error(fmt::format("it requires the extension {}, which is not read", required.back()));
  }
  for (const Json& name : list_in(document.json(), "extensionsUsed"))
    if (name.is_string() && !known(name.get<std::string>()))
      importing.inexact(fmt::format("it uses the extension {}, which is not read", name.get<std::string>()), importing.at());
}

/// Forwards the warnings of a converter from another format (see src/assimp), and the names of the files that it has opened.
void tell_notes(Importing& importing, const Document& document) {
  const Json& extras = object_in(document.json(), "asset");
  if (!find(extras, "extras") || !extras["extras"].is_object()) return;
  for (const Json& note : list_in(extras["extras"], "notes"))
    if (note.is_string()) importing.inexact(note.get<std::string>(), importing.at());
  const std::string ending = ending_of_contents(importing.path());
  if (ending == "gltf" || ending == "glb" || !find(extras["extras"], "files")) return;  // only of a converter
  for (const Json& file : list_in(extras["extras"], "files"))
    if (file.is_string()) note_input(file.get<std::string>());
}

Ref<Component> job_of(Importing& importing, const Ref<Scene>& scene, const MadeCamera& camera) {
  const Location at = importing.at();
  Ref<Component> job = importing.make("Job", at);
  set(*job, "camera", Value(camera.camera, at));
  set(*job, "scene", Value(Ref<Component>(scene), at));
  if (camera.aspect > 0.01 && camera.aspect < 100) {
    constexpr double area = 600 * 600;
    Ref<Component> image = importing.make("ImageBuffer", at);
    set_member(*image, "width", std::round(std::sqrt(area * camera.aspect)), at);
    set_member(*image, "height", std::round(std::sqrt(area / camera.aspect)), at);
    set(*job, "image", Value(image, at));
  }
  return job;
}

const bool registered_parts = register_parts({"gltf", "glb"});

}  // namespace

Ref<Component> import_document(Importing& importing) {
  try {
    const std::shared_ptr<const Document> document = Document::open(importing.path(), &importing);
    check_extensions(importing, *document);
    tell_notes(importing, *document);
    SceneBuilder builder(importing, *document);
    const Ref<Scene> scene = builder.build();
    importing.is_lit = builder.has_lights();
    if (const auto camera = builder.camera()) return job_of(importing, scene, *camera);
    return scene;
  } catch (const Error& error) {
    throw Error(error.what(), error.location.known() ? error.location : importing.at());
  } catch (const nlohmann::json::exception& error) {
    throw Error(std::string("it is no right glTF: ") + error.what(), importing.at());
  }
}

}  // namespace gltf

namespace {

class GltfImporter final : public Importer {
 public:
  static void describe(Description<GltfImporter>& d) {
    d.summary(
        "glTF 2.0 files (.gltf, .glb) with their materials, lights, cameras, skins, morph targets and animations. "
        "-D camera=, scene=, animation= and variant= choose by name or number, -D time= the second of the animation.",
        "The Khronos Group 2021, glTF 2.0 Specification");
  }
  std::vector<std::string> extensions() const override { return {"glb", "gltf"}; }
  Ref<Component> import(Importing& importing) const override { return gltf::import_document(importing); }
};

const Register<GltfImporter> registered;

}  // namespace
}  // namespace etendue
