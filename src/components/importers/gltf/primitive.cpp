#include "primitive.h"

#include <cstring>

#include "accessor.h"
#include "skin.h"

namespace etendue::gltf {
namespace {

enum Mode { points, lines, line_loop, line_strip, triangles, triangle_strip, triangle_fan };

size_t mode_of(const Json& primitive) { return whole(primitive, "mode").value_or(triangles); }

std::vector<std::uint32_t> corner_list(const Document& document, const Json& primitive, size_t vertices) {
  std::vector<std::uint32_t> corners;
  if (const auto accessor = whole(primitive, "indices")) {
    corners = Accessor(document, *accessor).indices();
    for (size_t i = 0; i < corners.size(); ++i)
      if (corners[i] >= vertices) throw Error(fmt::format("its index {} refers to vertex {} of {}", i, corners[i], vertices));
  } else {
    corners.resize(vertices);
    for (size_t i = 0; i < vertices; ++i) corners[i] = std::uint32_t(i);
  }
  return corners;
}

void append_triangles(size_t mode, const std::vector<std::uint32_t>& c, std::vector<std::array<std::uint32_t, 3>>& to) {
  if (mode == triangles) {
    to.resize(c.size() / 3);
    std::memcpy(to.data(), c.data(), to.size() * sizeof to[0]);
    return;
  }
  for (size_t i = 2; i < c.size(); ++i)
    if (mode == triangle_fan)
      to.push_back({c[0], c[i - 1], c[i]});
    else
      to.push_back(i % 2 == 0 ? std::array{c[i - 2], c[i - 1], c[i]} : std::array{c[i - 1], c[i - 2], c[i]});
}

/// Removes unused vertices: primitives often share one vertex array.
void compact(MeshData& mesh) {
  constexpr std::uint32_t unused = 0xffffffffu;
  std::vector<std::uint32_t> now(mesh.positions.size(), unused), kept;
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t c : t)
      if (now[c] == unused) now[c] = 0;
  for (std::uint32_t i = 0; i < now.size(); ++i)
    if (now[i] != unused) {
      now[i] = std::uint32_t(kept.size());
      kept.push_back(i);
    }
  if (kept.size() == now.size()) return;
  const auto keep = [&](auto& list, size_t width) {
    if (list.empty()) return;
    std::remove_reference_t<decltype(list)> some;
    some.reserve((kept.size() + 1) * width);
    for (const std::uint32_t i : kept) some.insert(some.end(), list.begin() + i * width, list.begin() + (i + 1) * width);
    list = std::move(some);
  };
  keep(mesh.positions, 1);
  keep(mesh.normals, 1);
  keep(mesh.uvs, 1);
  for (VertexAttribute& a : mesh.attributes) keep(a.values, size_t(a.width));
  for (auto& t : mesh.triangles)
    for (std::uint32_t& c : t) c = now[c];
}

/// The accessor of a vertex attribute, checked for its number of components (one of `widths`) and of vertices.
Accessor attribute(const Document& document, const Json& attributes, const char* name, size_t vertices,
                   std::initializer_list<size_t> widths) {
  Accessor accessor(document, needed_whole(attributes, name));
  if (std::find(widths.begin(), widths.end(), accessor.width) == widths.end())
    throw Error(fmt::format("its {} has {} numbers for a vertex", name, accessor.width));
  if (accessor.count != vertices)
    throw Error(fmt::format("its {} is for {} vertices, there are {}", name, accessor.count, vertices));
  return accessor;
}

void read_colors(const Accessor& accessor, MeshData& mesh) {
  const std::vector<float> values = accessor.floats();
  VertexAttribute color{"color", 3, {}}, alpha{"alpha", 1, {}};
  for (size_t i = 0; i < values.size(); i += accessor.width) {
    color.values.insert(color.values.end(), {values[i], values[i + 1], values[i + 2]});
    if (accessor.width == 4) alpha.values.push_back(values[i + 3]);
  }
  replace_infinite_colors(color.values, mesh);
  mesh.attributes.push_back(std::move(color));
  if (accessor.width == 4) mesh.attributes.push_back(std::move(alpha));
}

static_assert(sizeof(Point3) == 3 * sizeof(float) && sizeof(Normal3) == sizeof(Point3) && sizeof(Point2) == 2 * sizeof(float));

MeshData read(const Document& document, const Json& primitive, const PartName& part) {
  if (!is_triangles(primitive)) throw Error("it is of points or lines");
  const Json& attributes = object_in(primitive, "attributes");
  MeshData mesh;
  const Accessor positions(document, needed_whole(attributes, "POSITION"));
  if (positions.width != 3) throw Error("its POSITION is not of three numbers");
  const size_t n = positions.count;
  mesh.positions.reserve(n + 1);
  mesh.positions.resize(n);
  positions.floats(&mesh.positions.data()->x);
  if (find(attributes, "NORMAL")) {
    mesh.normals.resize(n);
    attribute(document, attributes, "NORMAL", n, {3}).floats(&mesh.normals.data()->x);
  }
  const std::string uvs = fmt::format("TEXCOORD_{}", part.uv_set);
  if (find(attributes, uvs.c_str())) {
    mesh.uvs.resize(n);
    attribute(document, attributes, uvs.c_str(), n, {2}).floats(&mesh.uvs.data()->x);
    for (Point2& uv : mesh.uvs) uv.y = 1 - uv.y;
  }
  if (find(attributes, "COLOR_0")) read_colors(attribute(document, attributes, "COLOR_0", n, {3, 4}), mesh);
  append_triangles(mode_of(primitive), corner_list(document, primitive, n), mesh.triangles);
  if (part.of_node) bend(document, primitive, part.owner, Pose(document, part.moment), part.uv_set, mesh);
  compact(mesh);
  if (mesh.triangles.empty()) throw Error("it has no triangles");
  return mesh;
}

}  // namespace

double differing_tangents(const Document& document, const Json& primitive, size_t uv_set) {
  const Json& attributes = object_in(primitive, "attributes");
  const size_t n = Accessor(document, needed_whole(attributes, "POSITION")).count;
  const std::string uv_name = fmt::format("TEXCOORD_{}", uv_set);
  if (!find(attributes, uv_name.c_str()) || !find(attributes, "NORMAL")) return 0;
  const std::vector<float> places = attribute(document, attributes, "POSITION", n, {3}).floats();
  const std::vector<float> normals = attribute(document, attributes, "NORMAL", n, {3}).floats();
  const std::vector<float> uvs = attribute(document, attributes, uv_name.c_str(), n, {2}).floats();
  const std::vector<float> tangents = attribute(document, attributes, "TANGENT", n, {4}).floats();
  std::vector<std::array<std::uint32_t, 3>> triangles;
  append_triangles(mode_of(primitive), corner_list(document, primitive, n), triangles);
  const auto vector = [](const std::vector<float>& list, size_t i) { return Vector3{list[i], list[i + 1], list[i + 2]}; };
  constexpr float within = 0.94f;  // the cosine of 20 degrees
  size_t all = 0, differing = 0;
  for (const auto& t : triangles) {
    const Vector3 a = vector(places, 3 * t[1]) - vector(places, 3 * t[0]),
                  b = vector(places, 3 * t[2]) - vector(places, 3 * t[0]);
    const auto grown = [&](size_t corner, size_t k) { return uvs[2 * t[corner] + k] - uvs[2 * t[0] + k]; };
    const float u1 = grown(1, 0), v1 = grown(1, 1), u2 = grown(2, 0), v2 = grown(2, 1), area = u1 * v2 - u2 * v1;
    if (!(area != 0)) continue;
    // dp/du and, since v points downwards in the file, the direction opposite to dp/dv.
    const Vector3 along = (v2 * a - v1 * b) * (area > 0 ? 1.0f : -1.0f), up = (u2 * a - u1 * b) * (area > 0 ? 1.0f : -1.0f);
    for (const std::uint32_t corner : t) {
      const Vector3 normal = vector(normals, 3 * corner), tangent = vector(tangents, 4 * corner);
      const Vector3 flat = along - dot(normal, along) * normal;
      const float lengths = length(flat) * length(tangent), side = dot(cross(normal, tangent), up) * tangents[4 * corner + 3];
      if (!(lengths > 0 && lengths < infinity)) continue;
      ++all;
      if (!(dot(flat, tangent) >= within * lengths) || side < 0) ++differing;
    }
  }
  return all > 0 ? double(differing) / double(all) : 0;
}

std::string PartName::text() const {
  std::string all = fmt::format("{}[{}].primitives[{}]", of_node ? "nodes" : "meshes", owner, primitive);
  if (of_node && moment.animation == every_animation)
    all += fmt::format(" at {} of all animations", moment.time);
  else if (of_node && moment.animation)
    all += fmt::format(" at {} of animation {}", moment.time, *moment.animation);
  if (uv_set != 0) all += fmt::format(" with TEXCOORD_{}", uv_set);
  if (converted_at != 0) all += fmt::format(" at second {}", converted_at);
  return all;
}

PartName PartName::parse(const std::string& text) {
  PartName part;
  size_t animation = 0;
  int end = 0;
  char owner[8] = {};
  if (std::sscanf(text.c_str(), "%6[a-z][%zu].primitives[%zu]%n", owner, &part.owner, &part.primitive, &end) == 3 && end > 0) {
    part.of_node = std::strcmp(owner, "nodes") == 0;
    int more = 0;
    if (std::sscanf(text.c_str() + end, " at %lf of animation %zu%n", &part.moment.time, &animation, &more) == 2 && more > 0) {
      part.moment.animation = animation;
      end += more;
    } else if (more = 0;
               std::sscanf(text.c_str() + end, " at %lf of all animations%n", &part.moment.time, &more) == 1 && more > 0) {
      part.moment.animation = every_animation;
      end += more;
    }
    more = 0;
    if (std::sscanf(text.c_str() + end, " with TEXCOORD_%zu%n", &part.uv_set, &more) == 1 && more > 0) end += more;
    more = 0;
    if (std::sscanf(text.c_str() + end, " at second %lf%n", &part.converted_at, &more) == 1 && more > 0) end += more;
    if (size_t(end) == text.size() && part.text() == text) return part;
  }
  throw Error("a part of a glTF file is written like \"meshes[0].primitives[0]\", and not '" + text.substr(0, 60) + "'");
}

bool is_triangles(const Json& primitive) {
  const size_t mode = mode_of(primitive);
  if (mode > triangle_fan) throw Error(fmt::format("'mode' {} is unknown", mode));
  return mode >= triangles;
}

size_t triangle_count(const Document& document, const Json& primitive) {
  const Json& attributes = object_in(primitive, "attributes");
  const Accessor positions(document, needed_whole(attributes, "POSITION"));
  const auto indices = whole(primitive, "indices");
  const size_t corners = indices ? Accessor(document, *indices).count : positions.count;
  return mode_of(primitive) == triangles ? corners / 3 : (corners < 3 ? 0 : corners - 2);
}

MeshData read_primitive(const Document& document, const PartName& part) {
  size_t mesh = part.owner;
  if (part.of_node) mesh = needed_whole(document.element("nodes", part.owner), "mesh");
  return within(fmt::format("meshes[{}].primitives[{}]", mesh, part.primitive), [&] {
    const Json& primitives = list_in(document.element("meshes", mesh), "primitives");
    if (part.primitive >= primitives.size()) throw Error(fmt::format("the mesh has {} primitives", primitives.size()));
    return read(document, primitives[part.primitive], part);
  });
}

}  // namespace etendue::gltf
