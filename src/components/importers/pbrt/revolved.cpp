// Partial spheres, paraboloids and hyperboloids, as triangle meshes.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "meshes.h"

namespace etendue::pbrt {

namespace {

/// A point of a profile curve that is revolved around the z axis, with the surface normal.
struct Profile {
  double radius, z, normal_radius, normal_z;  ///< the normal points outwards
};

Profile sphere_at(double radius, double low, double high, double v) {
  const double theta = (1 - v) * std::acos(low / radius) + v * std::acos(high / radius);
  return {radius * std::sin(theta), radius * std::cos(theta), std::sin(theta), std::cos(theta)};
}

}  // namespace

Shape make_revolved(Reader& reader, const std::string& type, const Parameters& p) {
  const double turn = std::clamp(p.number("phimax", 360), 1e-3, 360.0) * 3.14159265358979323846 / 180;
  constexpr size_t steps_u = 128, steps_v = 64;
  double radius = p.number("radius", 1), low = 0, high = 1;
  if (!(radius > 0)) throw Error("'radius' must be more than 0", p.place("radius"));
  std::array<double, 3> p1{}, p2{};
  if (type == "sphere") {
    low = std::clamp(p.number("zmin", -radius), -radius, radius);
    high = std::clamp(p.number("zmax", radius), -radius, radius);
    if (low > high) std::swap(low, high);
  } else if (type == "paraboloid") {
    low = p.number("zmin", 0), high = p.number("zmax", 1);
    if (!(low >= 0 && high > low)) throw Error("a paraboloid needs 0 <= zmin < zmax", p.place("zmin"));
  } else {
    const DoublePoint3 a = p.point("p1", {0, 0, 0}), b = p.point("p2", {1, 1, 1});
    p1 = {a.x, a.y, a.z}, p2 = {b.x, b.y, b.z};
  }
  reader.importing.inexact(fmt::format("a {} that is not whole is made of small triangles", type), p.at);
  Mesh mesh;
  for (size_t j = 0; j <= steps_v; ++j)
    for (size_t i = 0; i <= steps_u; ++i) {
      const double u = double(i) / steps_u, v = double(j) / steps_v, phi = u * turn, c = std::cos(phi), s = std::sin(phi);
      double x = 0, y = 0, z = 0, nx = 0, ny = 0, nz = 0;
      if (type == "hyperboloid") {
        const double qx = (1 - v) * p1[0] + v * p2[0], qy = (1 - v) * p1[1] + v * p2[1];
        x = qx * c - qy * s, y = qx * s + qy * c, z = (1 - v) * p1[2] + v * p2[2];
        // n = dp/du x dp/dv, with dp/du = (-y, x, 0).
        const double dx = p2[0] - p1[0], dy = p2[1] - p1[1], tx = dx * c - dy * s, ty = dx * s + dy * c, tz = p2[2] - p1[2];
        nx = x * tz, ny = y * tz, nz = -y * ty - x * tx;
      } else {
        Profile at{};
        if (type == "sphere") {
          at = sphere_at(radius, low, high, v);
        } else {
          const double height = low + v * (high - low), r = radius * std::sqrt(height / high);
          at = {r, height, 2 * r * high / (radius * radius), -1};
        }
        x = at.radius * c, y = at.radius * s, z = at.z;
        nx = at.normal_radius * c, ny = at.normal_radius * s, nz = at.normal_z;
      }
      const double length = std::sqrt(nx * nx + ny * ny + nz * nz);
      mesh.positions.insert(mesh.positions.end(), {x, y, z});
      for (const double n : {nx, ny, nz}) mesh.normals.push_back(length > 0 ? n / length : 0);
      mesh.uvs.insert(mesh.uvs.end(), {u, v});
    }
  for (size_t j = 0; j < steps_v; ++j)
    for (size_t i = 0; i < steps_u; ++i) {
      const double a = double(j * (steps_u + 1) + i), b = a + 1, c = a + double(steps_u) + 1, d = c + 1;
      mesh.indices.insert(mesh.indices.end(), {a, b, d, a, d, c});
    }
  Shape shape = object_of(reader, std::move(mesh), p.at);
  shape.turned = false;
  shape.pieces = 1;
  return shape;
}

}  // namespace etendue::pbrt
