// The front of Mitsuba's meshes: the side to which the normals of their files point.

#include "components/objects/meshes/mesh_fronts.h"

#include "converter.h"

namespace etendue::mitsuba {

namespace {

/// Replaces a mesh's file by the triangles themselves. Returns whether all attributes of the file are kept.
bool write_out(Component& object, const MeshData& mesh, Location at) {
  set_member(object, "file", FilePath{}, at);
  set_member(object, "part", "", at);
  if (mesh.faceted) {
    set_member(object, "smooth", false, at);
    set_member(object, "flat", true, at);
  }
  Numbers positions{{}, 3, Dimension::none}, triangles{{}, 1, Dimension::none}, normals{{}, 3, Dimension::none},
      uvs{{}, 2, Dimension::none};
  for (const Point3& p : mesh.positions)
    positions.values.insert(positions.values.end(),
                            {double(p.x) + mesh.centre.x, double(p.y) + mesh.centre.y, double(p.z) + mesh.centre.z});
  for (const auto& t : mesh.triangles) triangles.values.insert(triangles.values.end(), t.begin(), t.end());
  for (const Normal3& n : mesh.normals) normals.values.insert(normals.values.end(), {double(n.x), double(n.y), double(n.z)});
  for (const Point2& uv : mesh.uvs) uvs.values.insert(uvs.values.end(), {double(uv.x), double(uv.y)});
  const auto give = [&](const char* member, Numbers&& list) {
    if (!list.values.empty()) set_member(object, member, std::move(list), at);
  };
  give("positions", std::move(positions));
  give("triangles", std::move(triangles));
  give("normals", std::move(normals));
  give("uvs", std::move(uvs));
  bool all = true;
  const auto give_color = [&](const char* member, const char* name, const std::vector<VertexAttribute>& attributes) {
    for (const VertexAttribute& a : attributes)
      if (a.name == name && a.width == 3)
        give(member, {{a.values.begin(), a.values.end()}, 3, Dimension::none});
      else
        all = false;
  };
  give_color("colors", "color", mesh.attributes);
  give_color("face_colors", "face_color", mesh.face_attributes);
  return all;
}

}  // namespace

// Mitsuba tests the side of a direction against the shading normal, here the order of a triangle's vertices determines the
// front.
bool Converter::settle_fronts(Component& object, const Element& e, bool flipped, bool holds_medium) {
  const Value part = get(object, "part");
  const auto* part_name = part.as<std::string>();
  MeshData mesh;
  try {
    mesh = read_mesh(file(e).resolved(), part_name ? *part_name : std::string());
  } catch (const Error&) {  // reported when the mesh is prepared
    return flipped;
  }
  bool changed = !e.boolean("face_normals", false) && turn_to_normals(mesh);
  if (holds_medium && inside_out(mesh)) {
    turn_round(mesh);
    changed = true;
    // With flipped normals Mitsuba's front was outside already.
    if (!flipped) importing_.inexact(medium_outside, e.location_of("interior"));
    flipped = false;
  }
  if (changed && !write_out(object, mesh, e.at))
    inexact(e, "attributes of vertices and faces other than colours are left out of meshes whose triangles are turned round");
  return flipped;
}

}  // namespace etendue::mitsuba
