#include "glow.h"

#include <cmath>
#include <utility>

#include "accessor.h"
#include "primitive.h"

namespace etendue::gltf {
namespace {

Bounds3 bounds_of(const Document& document, const Json& primitive) {
  Bounds3 box;
  const auto positions = whole(object_in(primitive, "attributes"), "POSITION");
  if (!positions) return box;
  const Json& accessor = document.element("accessors", *positions);
  const auto low = numbers<3>(accessor, "min"), high = numbers<3>(accessor, "max");
  const bool floats = whole(accessor, "componentType") == 5126;
  if (floats && low && high) {
    for (const auto& p : {*low, *high}) box.add(Point3{float(p[0]), float(p[1]), float(p[2])});
    return box;
  }
  const std::vector<float> all = Accessor(document, *positions).floats();
  for (size_t i = 0; i + 2 < all.size(); i += 3) box.add(Point3{all[i], all[i + 1], all[i + 2]});
  return box;
}

}  // namespace

void Glow::shine(size_t mesh, size_t primitive, double luminance) {
  if (!(luminance > 0)) return;
  const MeshData read = read_primitive(document_, PartName{false, mesh, primitive, {}, 0});
  for (const auto& t : read.triangles) {
    const Point3 a = read.positions[t[0]];
    const Vector3 area = cross(read.positions[t[1]] - a, read.positions[t[2]] - a) * 0.5f;
    if (is_finite(area)) shining_.push_back(area * float(luminance));
  }
}

Glow::Areas Glow::taken() { return std::exchange(shining_, {}); }

// A matrix M transforms an area vector a to C a, where C is its cofactor matrix.
void Glow::stand(size_t mesh, const Transform& place, const Areas& shining) {
  placed_.emplace_back(mesh, place);
  const auto& m = place.exact();
  const DoubleVector3 x{m[0], m[4], m[8]}, y{m[1], m[5], m[9]}, z{m[2], m[6], m[10]};
  const DoubleVector3 yz = cross(y, z), zx = cross(z, x), xy = cross(x, y);
  for (const Vector3& a : shining) sum_ += length(double(a.x) * yz + double(a.y) * zx + double(a.z) * xy);
}

// An area A of luminance L emits the flux pi L A, which on a sphere of radius R around the model gives the illuminance L A / (4
// R^2). On a display whose white is 1, a white surface lit by less than a hundredth appears black.
bool Glow::lights() const {
  if (!(sum_ > 0)) return false;
  Bounds3 all;
  for (const auto& [mesh, place] : placed_)
    for (const Json& primitive : list_in(document_.element("meshes", mesh), "primitives"))
      if (const Bounds3 box = bounds_of(document_, primitive); !box.empty()) all.add(place(box));
  if (all.empty()) return true;
  const double diameter = double(length(all.diagonal()));
  constexpr double least = 0.01;
  return !(sum_ < least * diameter * diameter);
}

}  // namespace etendue::gltf
