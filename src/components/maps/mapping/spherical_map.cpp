// A projection onto a sphere.

#include "mapping.h"

namespace etendue {
namespace {

// v = 1/2 + asin(z / r) / pi = 1/2 + atan2(z, R) / pi with R^2 = x^2 + y^2; its gradient is (-z x / R, -z y / R, R) / (pi r^2).
class SphericalMap final : public ProjectionMap {
 public:
  static void describe(Description<SphericalMap>& d) {
    d.summary(
        "Projects a map from the origin: u is the angle around the z axis from x over y, in turns, and v is 0 below and 1 "
        "above, as on a sphere.");
    describe_projection(d);
  }

 private:
  Projected project(const Vector3& p) const override {
    Projected to;
    const float around = std::hypot(p.x, p.y), r2 = dot(p, p);
    to.uv = {turn_around_z(p, to.gradient_u), 0.5f + std::atan2(p.z, around) / pi};
    if (around > 0) to.gradient_v = (1 / (pi * r2)) * Vector3{-p.z * p.x / around, -p.z * p.y / around, around};
    return to;
  }
};

const Register<SphericalMap> registered;

}  // namespace
}  // namespace etendue
