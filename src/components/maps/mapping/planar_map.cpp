// A projection along an axis.

#include "mapping.h"

namespace etendue {
namespace {

class PlanarMap final : public ProjectionMap {
 public:
  static void describe(Description<PlanarMap>& d) {
    d.summary("Projects a map along the z axis: u and v are x and y, in metres.");
    describe_projection(d);
  }

 private:
  Projected project(const Vector3& p) const override { return {{p.x, p.y}, {1, 0, 0}, {0, 1, 0}}; }
};

const Register<PlanarMap> registered;

}  // namespace
}  // namespace etendue
