// OBJ files of Mitsuba 0.x whose faces refer to materials.

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "components/importers/meshes/mtl.h"
#include "components/objects/meshes/mesh_data.h"
#include "components/objects/meshes/obj_lines.h"
#include "converter.h"
#include "files/regular_file.h"
#include "scene_reader.h"

namespace etendue::mitsuba {

namespace {

/// The materials of the MTL libraries that an OBJ file names.
std::map<std::string, MtlMaterial> materials_of(Importing& importing, const std::string& path, Location at) {
  std::map<std::string, MtlMaterial> all;
  const FileContents contents(path);
  const std::string folder = path.substr(0, path.find_last_of('/') + 1);
  for (Lines lines(contents.text()); lines.next();) {
    if (lines.keyword() != "mtllib") continue;
    if (const auto library = importing.optional_file(std::string(lines.rest()), at, folder)) read_mtl(importing, *library, all);
  }
  return all;
}

}  // namespace

// Bsdfs without a name apply to all faces; bsdfs with a name, and the materials of the MTL file, to the faces of that material.
// The last one counts.
Ref<Component> Converter::parts_of_obj(const Element& e) {
  if (!e.old || e.type != "obj") return nullptr;
  e.ignore({"load_materials"});
  const bool any = !e.all("bsdf").empty();
  const bool named = std::ranges::any_of(e.properties, [](const Property& p) {
    const auto* nested = std::get_if<Nested>(&p.value);
    return nested && nested->element->tag == "bsdf" && !p.name.empty();
  });
  if ((any && !named) || !e.has("filename")) return nullptr;
  const Location at = e.location_of("filename");
  const std::string path = file(e).resolved();
  std::vector<std::string> parts;
  std::map<std::string, MtlMaterial> materials;
  try {
    parts = obj_parts(path);
    if (e.boolean("load_materials", true)) materials = materials_of(importing_, path, at);
  } catch (const Error& error) {
    throw Error(error.what(), error.location.known() ? error.location : at);
  }
  if (!named && (materials.empty() || !e.all("emitter").empty())) return nullptr;  // a shape with an emitter stays one mesh
  std::map<std::string, const Element*> chosen;                                    // by material name
  for (const Property& p : e.properties) {
    const auto* nested = std::get_if<Nested>(&p.value);
    if (!nested || nested->element->tag != "bsdf") continue;
    bool met = false;
    for (const std::string& part : parts)
      if (p.name.empty() || modern_name(part) == p.name) {
        chosen[part] = nested->element;
        met = true;
      }
    if (!met) importing_.inexact(fmt::format("no face of this file has the material '{}'", p.name), p.at);
  }
  Ref<Component> group = make(imported_structure, e);
  Value::List list;
  for (const std::string& part : parts) {
    Uv uv = Uv::as_is;
    const Ref<Component> one = mesh(e, uv);
    if (parts.size() > 1) set_member(*one, "part", "usemtl " + part, at);
    const auto bsdf = chosen.find(part);
    const auto material = materials.find(part);
    Ref<Component> shader;
    if (bsdf == chosen.end() && material != materials.end()) {
      importing_.inexact("materials of OBJ files are read as OBJ files of other programs are, not as Mitsuba 0.x does", at);
      shader = etendue::make_surface(importing_, material->second.surface, material->second.at).shader;
    }
    set_surface(*one, e, uv, bsdf == chosen.end() ? nullptr : bsdf->second, shader);
    list.emplace_back(one, e.at);
  }
  if (parts.size() > 1 && e.has("interior"))
    importing_.inexact("a medium in a shape of several materials is in each of its parts, which may not be closed",
                       e.location_of("interior"));
  set(*group, "objects", Value(std::move(list)));
  return group;
}

}  // namespace etendue::mitsuba
