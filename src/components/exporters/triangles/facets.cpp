#include "components/exporters/triangles/facets.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "components/exporters/members.h"

namespace etendue {

namespace {

constexpr double pi_twice = 2 * std::numbers::pi;
// Segments around a circle: an inscribed polygon of 128 sides has a 0.04 % smaller area than its circle.
constexpr int around = 128;

struct Corner {
  DoubleVector3 position, normal;
  double u = 0, v = 0;
};

void add(ExportedMesh& mesh, const Corner& c) {
  mesh.positions.insert(mesh.positions.end(), {c.position.x, c.position.y, c.position.z});
  mesh.normals.insert(mesh.normals.end(), {float(c.normal.x), float(c.normal.y), float(c.normal.z)});
  mesh.uvs.insert(mesh.uvs.end(), {float(c.u), float(c.v)});
}

bool same(const ExportedMesh& mesh, std::uint32_t a, std::uint32_t b) {
  return std::equal(mesh.positions.begin() + 3 * long(a), mesh.positions.begin() + 3 * long(a) + 3,
                    mesh.positions.begin() + 3 * long(b));
}

/// A grid of (columns + 1) (rows + 1) vertices, placed by u and v from 0 to 1; its front is on the side of du x dv.
template <class Place>
void grid(ExportedMesh& mesh, int columns, int rows, Place&& place) {
  const auto first = std::uint32_t(mesh.positions.size() / 3), width = std::uint32_t(columns + 1);
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) add(mesh, place(double(i) / columns, double(j) / rows));
  for (std::uint32_t j = 0; j < std::uint32_t(rows); ++j)
    for (std::uint32_t i = 0; i < std::uint32_t(columns); ++i) {
      const std::uint32_t a = first + j * width + i, b = a + 1, c = b + width, d = a + width;
      // In a row that degenerates to a point, at a pole or centre, one of the two triangles is dropped.
      if (!same(mesh, a, b)) mesh.indices.insert(mesh.indices.end(), {a, b, c});
      if (!same(mesh, c, d)) mesh.indices.insert(mesh.indices.end(), {a, c, d});
    }
}

DoubleVector3 vector(const std::vector<double>& v) { return {v[0], v[1], v[2]}; }

ExportedMesh sphere(const SceneObject& o) {
  const DoubleVector3 centre = vector(numbers_of(o, "centre"));
  const double radius = number_of(o, "radius");
  ExportedMesh mesh;
  grid(mesh, around, around / 2, [&](double u, double v) {
    const double phi = u * pi_twice, theta = v * std::numbers::pi;  // theta from -z
    const double across = v == 0 || v == 1 ? 0 : std::sin(theta);
    const DoubleVector3 n{across * std::cos(phi), across * std::sin(phi), -std::cos(theta)};
    return Corner{{centre.x + radius * n.x, centre.y + radius * n.y, centre.z + radius * n.z}, n, u, v};
  });
  return mesh;
}

ExportedMesh rectangle(const SceneObject& o) {
  const DoubleVector3 corner = vector(numbers_of(o, "corner")), edge_u = vector(numbers_of(o, "edge_u")),
                      edge_v = vector(numbers_of(o, "edge_v"));
  const DoubleVector3 across = cross(edge_u, edge_v);
  const double size = length(across);
  ExportedMesh mesh;
  grid(mesh, 1, 1, [&](double u, double v) {
    return Corner{{corner.x + u * edge_u.x + v * edge_v.x, corner.y + u * edge_u.y + v * edge_v.y,
                   corner.z + u * edge_u.z + v * edge_v.z},
                  {across.x / size, across.y / size, across.z / size},
                  u,
                  v};
  });
  return mesh;
}

// Each face covers the unit square of texture coordinates; u runs so that du x dv points outwards (as in Box).
ExportedMesh box(const SceneObject& o) {
  const std::vector<double> centre = numbers_of(o, "centre"), size = numbers_of(o, "size");
  ExportedMesh mesh;
  for (int face = 0; face < 6; ++face) {
    const int k = face / 2, a = (k + 1) % 3, b = (k + 2) % 3;
    const double side = face % 2 ? 1 : -1;
    grid(mesh, 1, 1, [&](double u, double v) {
      double x[3]{}, n[3]{};
      x[k] = side / 2;
      x[a] = (face % 2 ? u : 1 - u) - 0.5;
      x[b] = v - 0.5;
      n[k] = side;
      return Corner{
          {centre[0] + x[0] * size[0], centre[1] + x[1] * size[1], centre[2] + x[2] * size[2]}, {n[0], n[1], n[2]}, u, v};
    });
  }
  return mesh;
}

/// A disc at a height, facing up or down, made of rings around its centre. Its texture coordinates are those of Disc.
void disc(ExportedMesh& mesh, double radius, double z, bool up, const std::string& coordinates) {
  grid(mesh, around, 1, [&](double u, double v) {
    const double turn = up ? u : 1 - u, r = 1 - v, x = r * std::cos(turn * pi_twice), y = r * std::sin(turn * pi_twice);
    const double s = coordinates == "polar" ? r : coordinates == "around" ? turn : (x + 1) / 2;
    const double t = coordinates == "polar" ? turn : coordinates == "around" ? v : (y + 1) / 2;
    return Corner{{radius * x, radius * y, z}, {0, 0, up ? 1.0 : -1.0}, s, t};
  });
}

ExportedMesh cylinder(const SceneObject& o) {
  const double radius = number_of(o, "radius"), height = number_of(o, "height");
  ExportedMesh mesh;
  grid(mesh, around, 1, [&](double u, double v) {
    const DoubleVector3 n{std::cos(u * pi_twice), std::sin(u * pi_twice), 0};
    return Corner{{radius * n.x, radius * n.y, (v - 0.5) * height}, n, u, v};
  });
  if (truth_of(o, "caps"))
    for (const bool up : {false, true}) disc(mesh, radius, (up ? 0.5 : -0.5) * height, up, "polar");
  return mesh;
}

}  // namespace

std::optional<ExportedMesh> facets_of(const SceneObject& o, bool& curved) {
  const std::string& type = class_of(o);
  curved = true;
  if (type == "Sphere") return sphere(o);
  if (type == "Cylinder" && number_of(o, "sweep") == 360) return cylinder(o);
  if (type == "Disc") {
    ExportedMesh mesh;
    disc(mesh, number_of(o, "radius"), 0, true, word_of(o, "coordinates"));
    return mesh;
  }
  curved = false;
  if (type == "Rectangle") return rectangle(o);
  if (type == "Box") return box(o);
  return std::nullopt;
}

}  // namespace etendue
