// Triangle: a single triangle.

#include "geometry/inner_origin.h"
#include "triangle_object.h"

namespace etendue {
namespace {

class Triangle final : public TriangleObject {
 public:
  static void describe(Description<Triangle>& d) {
    d.summary(
         "A triangle; counter-clockwise seen from the front. Surface coordinates are (0, 0), (1, 0) and (0, 1) at its corners.",
         "solid-angle sampling: Arvo 1995, \"Stratified sampling of spherical triangles\"")
        .group("Shape")
        .member<&Triangle::a>("a", "m", "its first corner", Effect::rebuild)
        .member<&Triangle::b>("b", "m", "its second corner", Effect::rebuild)
        .member<&Triangle::c>("c", "m", "its third corner", Effect::rebuild);
  }

  void prepare() override {
    if (!is_finite(a)) fail("a", "must be finite");
    if (!is_finite(b)) fail("b", "must be finite");
    if (!is_finite(c)) fail("c", "must be finite");
    // Rounding would rotate a narrower triangle by about its own angles.
    const double longest = std::max({length_of(b, a), length_of(c, b), length_of(a, c)});
    const double area = twice_area();
    if (!(area > 1e-6 * longest * longest)) fail("c", "the corners lie on a line, or nearly so");
    if (!(float(area) > std::numeric_limits<float>::min() && float(area) < infinity))
      fail("c", "the triangle is too small or too large: its area is no float");
    MeshData mesh;
    const DoublePoint3 corners[3] = {a, b, c};
    mesh.centre = inner_origin_for(corners);
    mesh.positions = relative_to(mesh.centre, corners);
    mesh.triangles = {{0, 1, 2}};
    mesh.uvs = {{0, 0}, {1, 0}, {0, 1}};
    adopt(std::move(mesh));
  }

  DoublePoint3 a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0};

 private:
  static double length_of(const DoublePoint3& p, const DoublePoint3& q) { return length(p - q); }
  double twice_area() const { return length(cross(b - a, c - a)); }
};

const Register<Triangle> registered;

}  // namespace
}  // namespace etendue
