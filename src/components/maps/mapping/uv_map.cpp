// Surface coordinates as colours.

#include "shown_geometry.h"

namespace etendue {
namespace {

class UvMap final : public ShownGeometry {
 public:
  static void describe(Description<UvMap>& d) {
    d.summary("The surface coordinates as a colour: the fractions of u as red and of v as green.");
  }

 private:
  Vector3 shown(const SurfacePoint& p) const override {
    return {fraction(p.uv.x - std::floor(p.uv.x)), fraction(p.uv.y - std::floor(p.uv.y)), 0};
  }
};

const Register<UvMap> registered;

}  // namespace
}  // namespace etendue
