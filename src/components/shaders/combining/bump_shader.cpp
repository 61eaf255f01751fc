// BumpShader: bump mapping, which perturbs the shading normal by a height map.

#include "components/maps/footprint.h"
#include "etendue/object_map.h"
#include "perturbed_normal.h"

namespace etendue {
namespace {

// A surface p(u, v) with unit normal n, raised by h(u, v) along n, has the tangents
//     p'_u = p_u + h_u n + h n_u   and likewise for v                                     (Blinn 1978, eqs. 1 to 3).
// The last term is neglected, as by Blinn: h is small against the radius of curvature. The normal p'_u x p'_v is then along
//     n - grad h,   grad h = (h_u (p_v x n) + h_v (n x p_u)) / (p_u x p_v . n),
// the gradient in the surface [m/m], which does not depend on the parametrization by u and v or on its orientation. n is the
// shading normal, so bumps add to interpolated normals; tangents are projected to the plane perpendicular to it.
//
// h_u and h_v are central differences of the map. The point is moved in all coordinates that maps use: u and v, and the
// position in world space and in object space. The step is as short as floats allow: 1e-5 of the largest coordinate, 80 to 170
// units in its last place, so that rounding of coordinates changes a slope by less than 1 %; and 1e-5 of the parameter's range
// where the coordinates are small. Discontinuities of the height thus have no visible width. Where maps are averaged over a
// footprint, the step is half of that.
class BumpShader final : public PerturbedNormalShader {
 public:
  static void describe(Description<BumpShader>& d) {
    d.summary("Bumps: tilts the normal that shading uses as if the surface were raised by a map. Its outline stays as it is.",
              "Blinn 1978, Simulation of wrinkled surfaces")
        .member<&BumpShader::shader>("shader", "", "the surface that gets the bumps", required)
        .member<&BumpShader::height>("height", "m",
                                     "how high the surface is raised; only slopes show: one that rises in steps is flat",
                                     Meaning::number, soft(0.0001, 0.1), logarithmic)
        .member<&BumpShader::scale>("scale", "1", "multiplies the height", soft(-10, 10));
    describe_slopes(d);
  }

  void prepare() override {
    if (!shader) fail("shader", "a shader is needed");
    if (!height) fail("height", "a map is needed");
    if (!std::isfinite(scale)) fail("scale", "must be a finite number");
    flat_ = bool(height->constant()) || scale == 0;
  }

  Ref<ObjectMap> height = constant(0.0f);
  float scale = 1;

 protected:
  Vector3 tilted(const SurfacePoint& p) const override {
    const Vector3 n(p.shading_normal);
    if (flat_) return n;
    const Vector3 s = p.dpdu - dot(n, p.dpdu) * n, t = p.dpdv - dot(n, p.dpdv) * n;
    const float determinant = dot(cross(s, t), n), s2 = length_squared(s), t2 = length_squared(t);
    if (!(determinant * determinant > 1e-12f * s2 * t2)) return n;  // no tangents, or they are parallel
    Transform scratch;
    const Transform& placed_by = placement(p, scratch);
    const float along_u = slope(p, p.dpdu, {1, 0}, placed_by), along_v = slope(p, p.dpdv, {0, 1}, placed_by);
    return n - (scale / determinant) * (along_u * cross(t, n) + along_v * cross(n, s));
  }

 private:
  /// Change of height [m] per unit of the parameter whose tangent and direction in (u, v) are given.
  float slope(const SurfacePoint& p, const Vector3& tangent, const Vector2& direction, const Transform& placed_by) const {
    const Vector3 inner = placed_by.back(tangent);
    const float length_of = length(tangent);
    const float coordinate = std::max({1.0f, std::abs(p.uv.x), std::abs(p.uv.y), largest(p.position - Point3{}) / length_of,
                                       largest(p.object_position - Point3{}) / length(inner)});
    const float step = std::max(1e-5f * coordinate, 0.5f * p.footprint / length_of);
    const auto at = [&](float by) {
      SurfacePoint q = p;
      q.uv = q.uv + by * direction;
      q.position = q.position + by * tangent;
      q.object_position = q.object_position + by * inner;
      return height->scalar(q);
    };
    return (at(step) - at(-step)) / (2 * step);
  }

  static float largest(const Vector3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

  bool flat_ = true;
};

const Register<BumpShader> registered;

}  // namespace
}  // namespace etendue
