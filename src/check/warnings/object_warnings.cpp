// Warns of members of a scene's objects that have no effect, and of surfaces that are not as their materials require.

#include <fmt/format.h>

#include <set>
#include <unordered_set>

#include "core/number_text.h"
#include "etendue/describe/registry.h"
#include "etendue/mesh_facts.h"
#include "etendue/object_map.h"
#include "etendue/transport/medium_stack.h"
#include "geometry/closed_surface.h"
#include "scene_warnings.h"

namespace etendue {
namespace {

constexpr Lobes refracting_lobes = specular_transmission | glossy_transmission;

/// The object's name in the file, or else its class.
std::string label(const SceneObject& object) {
  if (object.origin && !object.origin->name.empty()) return "'" + object.origin->name + "'";
  const std::string& name = object.class_info().name;
  return fmt::format("the {}", name);
}

bool written(const Component& c, std::string_view member) {
  if (!c.origin) return false;
  for (const auto& [name, place] : c.origin->members)
    if (name == member) return true;
  return false;
}

/// Calls `call` for a component and all components in its members, once each. Its result says whether to descend into this
/// component.
template <class Call>
void for_parts(const Component& c, std::unordered_set<const Component*>& seen, const Call& call) {
  if (!seen.insert(&c).second || !call(c)) return;
  for (const Member& m : c.class_info().members) {
    if (m.kind != Kind::component) continue;
    const Value value = m.get(c, m);
    if (const auto* part = value.as<Ref<Component>>(); part && *part) for_parts(**part, seen, call);
    if (const auto* list = value.as<Value::List>())
      for (const Value& item : *list)
        if (const auto* part = item.as<Ref<Component>>(); part && *part) for_parts(**part, seen, call);
  }
}

std::string names_text(const std::vector<std::string>& names) {
  std::string text;
  for (size_t i = 0; i < std::min<size_t>(names.size(), 3); ++i) text += (i == 0 ? "'" : ", '") + names[i] + "'";
  return names.size() > 3 ? text + fmt::format(" and {} more", names.size() - 3) : text;
}

class Objects {
 public:
  Objects(const Job& job, std::vector<SceneWarning>& list) : job_(job), list_(list) {}

  /// Checks the objects of a scene. `instead` is the shader that replaces those of all objects (an instance's); null: they keep
  /// their own.
  void in(const Scene& scene, const Shader* instead) {
    if (!seen_.insert({&scene, instead}).second) return;
    for (const Ref<SceneObject>& object : scene.objects) {
      if (const Scene* inner = scene_within(*object)) {
        const bool instance = inner != object.get();
        nested(*object, instance);
        if (instance)
          instanced_.push_back(inner);
        else
          nested_.insert(inner);
        in(*inner, instead ? instead : instance ? object->shader.get() : nullptr);
      } else {
        one(*object, instead ? instead : object->shader.get());
      }
    }
  }

  /// Checks the members of scenes that occur only in instances. To be called after all objects have been visited.
  void of_instanced() {
    for (const Scene* scene : instanced_)
      if (!nested_.contains(scene))
        of_whole(*scene, "only the objects of an instance's scene are used; set it on the instance or on the objects");
  }
  /// Checks the members of a scene of which only the objects are rendered.
  void of_whole(const Scene& scene, const std::string& why) {
    without_effect(scene,
                   {"transform", "shader", "emission", "interior", "sides", "priority", "shading_normals", "visible_to_camera"},
                   why);
  }

 private:
  void add(const char* kind, std::string text, Location at) {
    for (const SceneWarning& w : list_)
      if (w.at.known() && w.at == at && w.kind == kind) return;
    list_.push_back({kind, std::move(text), at});
  }

  void without_effect(const SceneObject& object, std::initializer_list<const char*> members, const std::string& why) {
    for (const char* member : members)
      if (written(object, member))
        add("without effect", fmt::format("{}: '{}' has no effect: {}", label(object), member, why),
            object.location_of(member));
  }

  void nested(const SceneObject& object, bool instance) {
    if (instance)
      without_effect(object, {"emission", "interior", "sides", "priority", "shading_normals"},
                     "an instance overrides only the shader; set it on the objects in its scene");
    else
      without_effect(
          object, {"shader", "emission", "interior", "sides", "priority", "shading_normals"},
          "only the objects of a nested scene are used; set it on them, or put the scene into an Instance with a shader");
  }

  void one(const SceneObject& object, const Shader* shader) {
    if (object.surrounds()) {
      if (!object.interior && !object.shader)
        add("without effect", fmt::format("{} has neither an interior nor a shader: it does nothing", label(object)),
            object.location_of());
      without_effect(object, {"sides", "priority", "shading_normals"},
                     "it has no surface, and all other objects take precedence");
      return;
    }
    if (object.infinite() || object.delta()) {
      if (!object.luminaire())
        add("dark luminaire", fmt::format("{} has no emission: it does nothing", label(object)), object.location_of());
      without_effect(object, {"shader", "interior", "sides", "priority", "shading_normals"},
                     "no ray hits it; only its emission is used");
      if (object.delta()) without_effect(object, {"visible_to_camera"}, "it has no extent, so it is never visible");
      if (object.emission && object.delta() && written(*object.emission, "sides"))
        add("without effect", fmt::format("{}: 'sides' of its emission has no effect: it has no surface", label(object)),
            object.emission->location_of("sides"));
      if (object.infinite() && written(object, "transform") && std::ranges::any_of(object.transform.keys(), moves))
        add("without effect",
            fmt::format(
                "{}: the translation in 'transform' has no effect: it is infinitely far away, so only the rotation counts",
                label(object)),
            object.location_of("transform"));
      return;
    }
    lost_light_.look(object, list_);
    const bool enters = is_enterable(object, shader);
    blackness(object, shader);
    if (!shader) without_effect(object, {"sides"}, "it has no shader, so both sides are black");
    if (shader && shader->possible_lobes() == null_scattering)
      without_effect(object, {"sides"}, "null scattering is the same from both sides");
    if (!enters && (!shader || !shader->transmits()))
      without_effect(object, {"priority"}, "light does not enter it, so nothing can overlap inside");
    if (object.interior) interior(object, shader, enters);
    openness(object, shader);
    file(object, shader);
    coordinates(object, shader);
  }

  static bool moves(const AnimatedTransform::Key& key) { return distance(key.transform(Point3{}), Point3{}) > 0; }

  static bool is_enterable(const SceneObject& object, const Shader* shader) {
    if (!shader) return false;
    Lobes lobes = shader->possible_lobes();
    if (object.sides != Sides::both) lobes &= Lobes(reflection_lobes | null_scattering);
    if (!(lobes & transmission_lobes)) return false;
    // closed() comes last: it takes time for a large mesh.
    return (shader->transmits() || (object.interior && is_sheet(*shader))) && object.closed();
  }

  void blackness(const SceneObject& object, const Shader* shader) {
    if (shader || object.luminaire() || !shows_light(*job_.renderer)) return;
    std::string text = fmt::format("{} has no shader, so it is black", label(object));
    if (const std::vector<std::string> materials = notes_of(object).materials; !materials.empty())
      text += fmt::format("; the materials that its file names ({}) are not read", names_text(materials));
    add("no shader", text + "; give it one, such as Lambertian { color: 0.5 }", object.location_of());
  }

  void interior(const SceneObject& object, const Shader* shader, bool enters) {
    std::string why;
    if (enters && !faces_inwards(object)) return;
    if (enters)
      why = "its faces point inwards, so that light leaves it before it enters; reverse the order of each triangle's vertices";
    else if (!object.closed())
      why = fmt::format("the surface is not closed{}, so it has no inside; close it", ends_text(object));
    else if (!shader)
      why = "it has no shader, so no light enters; PassThrough {} is an invisible boundary of a medium";
    else if (object.sides != Sides::both && shader->transmits())
      why = "with one side black, no light is refracted into it; leave out 'sides'";
    else
      why = fmt::format(
          "its shader, {}, does not transmit light; PassThrough {{}} is an invisible boundary of a medium, Dielectric {{}} one "
          "of glass",
          shader->class_info().name);
    add("interior", fmt::format("{}: the medium in 'interior' is never entered: {}", label(object), why),
        object.location_of("interior"));
  }

  /// Whether the triangles of a closed mesh are clockwise as seen from outside.
  static bool faces_inwards(const SceneObject& object) {
    const std::optional<TriangleView> mesh = still_triangles(object);
    return mesh && enclosed_volume(*mesh) < 0;
  }

  /// For example " (12 of its edges belong to one triangle alone)".
  static std::string ends_text(const SceneObject& object) {
    const MeshFacts* facts = object.mesh_facts();
    const std::uint64_t open = facts ? facts->open_edges() : 0;
    if (open > 0) return fmt::format(" ({} edge{} to one triangle alone)", grouped(open), open == 1 ? " belongs" : "s belong");
    const auto mesh = still_triangles(object);
    constexpr size_t fewest = 4;  // triangles that can enclose a volume
    return mesh && mesh->triangles.size() >= fewest ? " (its triangles are not consistently oriented)" : "";
  }

  void openness(const SceneObject& object, const Shader* shader) {
    if (!shader || object.interior || object.closed() || object.unbounded()) return;
    if (!shader->transmits() || !(shader->possible_lobes() & refracting_lobes)) return;
    // Patches are not reported: those of well-known models, such as the teapot, intersect without sharing edges.
    const std::string& name = object.class_info().name;
    if (name == "BezierPatches" || name == "NurbsSurface") return;
    add("open body",
        fmt::format("{}: it refracts light, but the surface is not closed{}, so it has no inside, and bodies in it are treated "
                    "as surrounded by air; close it, or use a shader for thin panes, such as ThinDielectric",
                    label(object), ends_text(object)),
        object.location_of("shader"));
  }

  /// Warns of data in the object's file that are not used: materials and vertex colours.
  void file(const SceneObject& object, const Shader* shader) {
    if (!shader) return;
    const MeshNotes notes = notes_of(object);
    const Location at = object.location_of("file");
    if (notes.materials.size() > 1)
      add("materials",
          fmt::format("{}: its file names {} materials ({}), which are not read: the whole mesh has the shader given here; for "
                      "several, split it into one file and object per material",
                      label(object), notes.materials.size(), names_text(notes.materials)),
          at);
    for (const std::string& name : notes.attributes)
      if (name == "color" && !uses(*shader, "AttributeMap") && !(object.emission && uses(*object.emission, "AttributeMap")))
        add("vertex colours",
            fmt::format("{}: the colours of its vertices are not used; Lambertian {{ color: AttributeMap {{}} }} shows them",
                        label(object)),
            written(object, "colors") ? object.location_of("colors") : at);
  }

  static bool uses(const Component& root, const char* class_name) {
    bool found = false;
    std::unordered_set<const Component*> seen;
    for_parts(root, seen, [&](const Component& c) {
      found |= c.class_info().name == class_name;
      return !found;
    });
    return found;
  }

  /// Warns of image textures on a mesh without uv coordinates.
  void coordinates(const SceneObject& object, const Shader* shader) {
    const Component* roots[] = {shader, object.emission.get()};
    for (const Component* root : roots) {
      if (!root) continue;
      const Component* image = nullptr;
      std::unordered_set<const Component*> seen;
      for_parts(*root, seen, [&](const Component& c) {
        const std::string& name = c.class_info().name;
        if (name == "ImageMap" && !image) image = &c;
        // These maps replace the coordinates of the textures in them.
        return name != "PlanarMap" && name != "CylindricalMap" && name != "SphericalMap" && name != "TriplanarMap";
      });
      if (!image || !notes_of(object).without_uv) continue;
      add("no uv",
          fmt::format(
              "{}: the mesh has no surface coordinates (uv), so every triangle shows the image's lower left half; put the "
              "image into a PlanarMap, CylindricalMap, SphericalMap or TriplanarMap, or give the mesh uvs",
              label(object)),
          image->location_of());
    }
  }

  const Job& job_;
  std::vector<SceneWarning>& list_;
  LostLight lost_light_;
  std::set<std::pair<const Scene*, const Shader*>> seen_;
  std::set<const Scene*> nested_;        // scenes that are objects themselves
  std::vector<const Scene*> instanced_;  // scenes in instances
};

}  // namespace

void warn_of_objects(const Job& job, std::vector<SceneWarning>& list) {
  Objects objects(job, list);
  objects.of_whole(
      *job.scene,
      "only the objects of the job's scene are used; put it into an Instance, which can have a transform and a shader");
  objects.in(*job.scene, nullptr);
  objects.of_instanced();
}

}  // namespace etendue
