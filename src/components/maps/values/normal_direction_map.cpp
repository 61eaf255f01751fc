// Normals as colours.

#include "components/maps/mapping/shown_geometry.h"

namespace etendue {
namespace {

enum class Which : std::uint8_t { shading, geometric, object };

class NormalDirectionMap final : public ShownGeometry {
 public:
  static void describe(Description<NormalDirectionMap>& d) {
    d.summary("The direction of the normal as a colour: from 0 for -1 to 1 for 1 along x, y and z.")
        .member<&NormalDirectionMap::which>(
            "which", "",
            "shading: the normal that shades, in the coordinates of the whole scene; geometric: that of the true surface; "
            "object: the latter in the object's own coordinates",
            choices("shading", "geometric", "object"));
  }

  Which which = Which::shading;

 private:
  Vector3 shown(const SurfacePoint& p) const override {
    const Normal3& n = which == Which::shading ? p.shading_normal : (which == Which::geometric ? p.normal : p.object_normal);
    return {fraction(0.5f + 0.5f * n.x), fraction(0.5f + 0.5f * n.y), fraction(0.5f + 0.5f * n.z)};
  }
};

const Register<NormalDirectionMap> registered;

}  // namespace
}  // namespace etendue
