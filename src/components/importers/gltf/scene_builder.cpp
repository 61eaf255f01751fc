#include "scene_builder.h"

#include <algorithm>

#include "accessor.h"
#include "described.h"
#include "thickness.h"
#include "variants.h"

namespace etendue::gltf {
namespace {

constexpr const char* scaled_to_nothing = "what is scaled to nothing, or to a line, is left out";

}  // namespace

SceneBuilder::SceneBuilder(Importing& importing, const Document& document)
    : importing_(importing),
      document_(document),
      moment_(moment()),
      pose_(document, moment_),
      variant_(chosen_variant(importing, document)),
      materials_(importing, document),
      scene_(ref_cast<Scene>(importing.make(imported_structure, importing.at()))),
      glow_(document),
      own_file_(text(object_in(document.json(), "asset"), "generator") == "Etendue") {}

/// The index that `-D camera=name` selects from a list, by name or number.
size_t SceneBuilder::chosen(const char* parameter, const char* list, size_t otherwise) {
  const auto said = importing_.parameter(parameter);
  if (!said) return otherwise;
  std::vector<std::string> names;
  for (size_t i = 0; i < document_.count(list); ++i) {
    names.push_back(text(document_.element(list, i), "name"));
    if (names.back() == *said || std::to_string(i) == *said) return i;
  }
  throw Error(fmt::format("there is no {} '{}'{}", parameter, *said, suggestion(*said, names)), at());
}

Moment SceneBuilder::moment() {
  Moment moment{importing_.options().time, std::nullopt};
  if (!has_animation(document_)) return moment;
  const auto said = importing_.parameter("animation");
  moment.animation = said == "all" ? every_animation : chosen("animation", "animations", 0);
  if (const auto time = importing_.parameter("time")) {
    char* end = nullptr;
    moment.time = std::strtod(time->c_str(), &end);
    if (end == time->c_str() || *end != 0 || !std::isfinite(moment.time))
      throw Error("'" + *time + "' is no time in seconds", at());
  }
  if (document_.count("animations") > 1 && !said)
    importing_.inexact(
        fmt::format("of its {} animations the first is shown; -D animation=NAME chooses another, and all of them "
                    "with NAME all",
                    document_.count("animations")),
        at());
  return moment;
}

std::vector<size_t> SceneBuilder::roots() {
  const size_t scenes = document_.count("scenes"), nodes = document_.count("nodes");
  if (scenes == 0) {
    // A library of parts: all root nodes.
    std::vector<bool> child(nodes);
    for (size_t i = 0; i < nodes; ++i)
      for (const size_t c : places(document_.element("nodes", i), "children", nodes)) child[c] = true;
    std::vector<size_t> all;
    for (size_t i = 0; i < nodes; ++i)
      if (!child[i]) all.push_back(i);
    return all;
  }
  const size_t scene = chosen("scene", "scenes", whole(document_.json(), "scene").value_or(0));
  if (scenes > 1 && !importing_.parameter("scene"))
    importing_.inexact(fmt::format("of its {} scenes one is shown; -D scene=NAME chooses another", scenes), at());
  return within(fmt::format("scenes[{}]", scene), [&] { return places(document_.element("scenes", scene), "nodes", nodes); });
}

Ref<Scene> SceneBuilder::build() {
  std::vector<size_t> order = roots();
  std::set<size_t> seen(order.begin(), order.end());
  if (seen.size() != order.size()) throw Error("a node is twice a root of the scene");
  for (size_t k = 0; k < order.size(); ++k) {
    const Json& n = document_.element("nodes", order[k]);
    if (!truth(extension(n, "KHR_node_visibility"), "visible", true)) hidden_.insert(order[k]);
    for (const size_t child : places(n, "children", document_.count("nodes"))) {
      if (!seen.insert(child).second) throw Error(fmt::format("nodes[{}] is a root of the scene and a child", child));
      if (hidden_.contains(order[k])) hidden_.insert(child);
      order.push_back(child);
    }
  }
  count_uses(order);
  std::ranges::sort(order);
  for (const size_t node : order) within(fmt::format("nodes[{}]", node), [&] { add_node(node); });
  return scene_;
}

void SceneBuilder::count_uses(const std::vector<size_t>& order) {
  for (const size_t node : order)
    if (const auto mesh = whole(document_.element("nodes", node), "mesh")) ++uses_[*mesh];
}

void SceneBuilder::add(const Ref<SceneObject>& object) {
  if (object) scene_->objects.push_back(object);
}

void SceneBuilder::add_node(size_t node) {
  const Json& n = document_.element("nodes", node);
  const Transform& place = pose_.global(node);
  if (const auto camera = whole(n, "camera")) cameras_.emplace_back(*camera, place);
  if (hidden_.contains(node)) return;
  const Json& light = extension(n, "KHR_lights_punctual");
  if (!light.empty()) {
    add(ref_cast<SceneObject>(make_light(importing_, document_, needed_whole(light, "light"), place)));
    has_lights_ = true;
  }
  if (const Json& described = extension(n, "ETENDUE_part"); document_.converted() && !described.empty())
    add_described(described, plain_name(text(n, "name")), place);
  if (const auto mesh = whole(n, "mesh")) add_mesh(node, *mesh);
}

/// Adds an object that one of our own converters describes.
void SceneBuilder::add_described(const Json& json, const std::string& name, const Transform& place) {
  const Ref<Component> object = described_part(importing_, document_, materials_, json, name);
  const std::optional<Transform> thick = with_thickness(place);
  if (!thick) {
    importing_.inexact(scaled_to_nothing, at());
    return;
  }
  const Transform stands = truth(json, "rigid", false) ? without_stretch(*thick) : *thick;
  if (!stands.identity()) set(*object, "transform", Value(stands, at()));
  if (truth(json, "lamp", false)) has_lights_ = true;
  if (const Json* material = find(json, "material")) {
    const Material& made = materials_.get(material->get<size_t>(), false, false);
    set(*object, "shader", Value(made.made.shader, at()));
    if (made.made.emission) set(*object, "emission", Value(made.made.emission, at()));
    if (made.made.interior) set(*object, "interior", Value(made.made.interior, at()));
    if (made.glow > 0) has_lights_ = true;
  }
  add(ref_cast<SceneObject>(object));
}

// A mesh with one instance becomes an object with a transform; a mesh with several is stored once, as a scene.
void SceneBuilder::add_mesh(size_t node, size_t mesh) {
  const Json& n = document_.element("nodes", node);
  const bool skinned = find(n, "skin") != nullptr, bent = skinned || !pose_.weights(node).empty();
  const std::string name = plain_name(text(n, "name"));
  std::vector<Transform> placed;
  for (const Transform& t : places_of(node))
    if (const std::optional<Transform> thick = with_thickness(t); thick && !skinned)
      placed.push_back(*thick);
    else if (!skinned)
      importing_.inexact(scaled_to_nothing, at());
  if (skinned) placed = {Transform()};
  if (placed.empty()) return;
  if (placed.size() == 1 && (bent || uses_[mesh] == 1)) {
    PartName whose{bent, bent ? node : mesh, 0, bent ? moment_ : Moment{}, 0};
    const std::vector<Ref<SceneObject>> objects = primitives(mesh, whose);
    glow_.stand(mesh, placed[0], glow_.taken());
    for (const Ref<SceneObject>& object : objects) {
      if (!placed[0].identity()) set(*object, "transform", Value(placed[0], at()));
      if (!name.empty()) object->origin->name = name;
      add(object);
    }
    return;
  }
  if (std::ranges::any_of(pose_.weights(node), [](double w) { return w != 0; }))
    importing_.inexact("a mesh that EXT_mesh_gpu_instancing repeats is without what its morph targets add", at());
  const auto& [scene, shining] = shared(mesh);
  if (!scene) return;
  for (const Transform& t : placed) {
    glow_.stand(mesh, t, shining);
    Ref<Component> instance = importing_.make("Instance", at(), name);
    set(*instance, "scene", Value(Ref<Component>(scene), at()));
    set(*instance, "transform", Value(t, at()));
    add(ref_cast<SceneObject>(instance));
  }
}

/// The transforms of a node's mesh: one, or those of EXT_mesh_gpu_instancing.
std::vector<Transform> SceneBuilder::places_of(size_t node) {
  const Json& instancing = extension(document_.element("nodes", node), "EXT_mesh_gpu_instancing");
  const Transform& place = pose_.global(node);
  if (instancing.empty()) return {place};
  return within("EXT_mesh_gpu_instancing", [&] {
    const Json& attributes = object_in(instancing, "attributes");
    size_t count = 0;
    const auto read = [&](const char* name, size_t width, std::vector<double> otherwise) {
      std::vector<float> values;
      if (find(attributes, name)) {
        const Accessor accessor(document_, needed_whole(attributes, name));
        if (accessor.width != width || (count != 0 && accessor.count != count))
          throw Error(fmt::format("its {} does not fit the others", name));
        count = accessor.count;
        values = accessor.floats();
      }
      return [values, width, otherwise](size_t i, size_t k) {
        return values.empty() ? otherwise[k] : double(values[i * width + k]);
      };
    };
    const auto t = read("TRANSLATION", 3, {0, 0, 0});
    const auto r = read("ROTATION", 4, {0, 0, 0, 1});
    const auto s = read("SCALE", 3, {1, 1, 1});
    std::vector<Transform> all;
    for (size_t i = 0; i < count; ++i)
      all.push_back(place *
                    composed({t(i, 0), t(i, 1), t(i, 2)}, {r(i, 0), r(i, 1), r(i, 2), r(i, 3)}, {s(i, 0), s(i, 1), s(i, 2)}));
    return all;
  });
}

const SceneBuilder::Shared& SceneBuilder::shared(size_t mesh) {
  if (const auto known = shared_.find(mesh); known != shared_.end()) return known->second;
  Shared& made = shared_[mesh];
  const std::vector<Ref<SceneObject>> objects = primitives(mesh, PartName{false, mesh, 0, {}, 0});
  made.shining = glow_.taken();
  if (objects.empty()) return made;
  made.scene =
      ref_cast<Scene>(importing_.make(imported_structure, at(), plain_name(text(document_.element("meshes", mesh), "name"))));
  made.scene->objects = objects;
  return made;
}

std::vector<Ref<SceneObject>> SceneBuilder::primitives(size_t mesh, const PartName& whose) {
  std::vector<Ref<SceneObject>> all;
  const Json& m = document_.element("meshes", mesh);
  const Json& list = list_in(m, "primitives");
  const std::string name = plain_name(text(m, "name"));
  for (size_t i = 0; i < list.size(); ++i) {
    PartName part = whose;
    part.primitive = i;
    within(fmt::format("meshes[{}].primitives[{}]", mesh, i), [&] {
      if (Ref<SceneObject> object = primitive(mesh, list[i], part, name)) all.push_back(object);
    });
  }
  return all;
}

Ref<SceneObject> SceneBuilder::primitive(size_t mesh, const Json& p, PartName part, const std::string& name) {
  if (!find(object_in(p, "attributes"), "POSITION")) {  // glTF 2.0, 3.7.2.1: an extension provides positions, or nothing
    importing_.inexact("a primitive without POSITION is left out", at());
    return nullptr;
  }
  if (!is_triangles(p)) {
    importing_.inexact("points and lines are not shown", at());
    return nullptr;
  }
  const size_t triangles = triangle_count(document_, p);
  if (triangles == 0) return nullptr;
  // A few bytes of a malicious file could refer to the same vertices again and again; in real files most triangles have data of
  // their own.
  triangles_ += double(triangles);
  constexpr double always = 1e6, most_for_a_byte = 4;
  if (triangles_ > always + most_for_a_byte * double(document_.buffer_bytes()))
    throw Error(fmt::format("its meshes have {:.0f} triangles or more, far more than its {} bytes can tell apart", triangles_,
                            document_.buffer_bytes()));
  const Json& attributes = object_in(p, "attributes");
  bool faded = false;
  const bool colored = find(attributes, "COLOR_0") != nullptr;
  if (colored) faded = Accessor(document_, needed_whole(attributes, "COLOR_0")).width == 4;
  const Material& material = materials_.get(material_of(p, variant_), colored, faded);
  part.uv_set = material.uv_set;
  if (material.by_tangents && find(attributes, "TANGENT") && differing_tangents(document_, p, part.uv_set) > 0.05)
    importing_.inexact(
        "TANGENT vectors lie otherwise than the surface coordinates run, which images of normals and stretched "
        "highlights follow here",
        at());
  part.converted_at = document_.time();
  Ref<Component> object = importing_.make("TriangleMesh", at(), name);
  set_member(*object, "file", FilePath{importing_.path(), {}}, at());
  set_member(*object, "part", part.text(), at());
  set(*object, "shader", Value(material.made.shader, at()));
  if (own_file_)
    has_lights_ = has_lights_ || material.glow > 0;
  else if (!has_lights_)
    glow_.shine(mesh, part.primitive, material.glow);
  if (material.made.emission) set(*object, "emission", Value(material.made.emission, at()));
  if (material.made.interior) set(*object, "interior", Value(material.made.interior, at()));
  return ref_cast<SceneObject>(object);
}

std::optional<MadeCamera> SceneBuilder::camera() {
  if (cameras_.empty()) return std::nullopt;
  size_t which = 0;
  if (const auto said = importing_.parameter("camera")) {
    if (*said == "none") return std::nullopt;
    which = cameras_.size();
    std::vector<std::string> names;
    for (size_t i = 0; i < cameras_.size(); ++i) {
      names.push_back(text(document_.element("cameras", cameras_[i].first), "name"));
      if (names.back() == *said || std::to_string(i) == *said) which = std::min(which, i);
    }
    if (which == cameras_.size()) throw Error(fmt::format("there is no camera '{}'{}", *said, suggestion(*said, names)), at());
  } else if (cameras_.size() > 1) {
    importing_.inexact(fmt::format("of its {} cameras the first is used; -D camera=NAME chooses another", cameras_.size()),
                       at());
  }
  MadeCamera made = make_camera(importing_, document_, cameras_[which].first, cameras_[which].second);
  const Json& camera = document_.element("cameras", cameras_[which].first);
  if (document_.converted())
    set_described_members(importing_, document_, materials_, extension(camera, "ETENDUE_part"), *made.camera);
  return made;
}

}  // namespace etendue::gltf
