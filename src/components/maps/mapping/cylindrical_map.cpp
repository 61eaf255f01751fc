// A projection onto a cylinder.

#include "mapping.h"

namespace etendue {
namespace {

class CylindricalMap final : public ProjectionMap {
 public:
  static void describe(Description<CylindricalMap>& d) {
    d.summary("Projects a map from the z axis: u is the angle around it from x over y, in turns, and v is z, in metres.");
    describe_projection(d);
  }

 private:
  Projected project(const Vector3& p) const override {
    Projected to;
    to.uv = {turn_around_z(p, to.gradient_u), p.z};
    to.gradient_v = {0, 0, 1};
    return to;
  }
};

const Register<CylindricalMap> registered;

}  // namespace
}  // namespace etendue
