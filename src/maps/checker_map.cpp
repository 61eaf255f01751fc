// A checkerboard of two maps.

#include "etendue/object_map.h"

namespace etendue {
namespace {

enum class Space : std::uint8_t { uv, object };

class CheckerMap final : public ObjectMap {
 public:
  static void describe(Description<CheckerMap>& d) {
    d.summary("A checkerboard of two maps, over surface coordinates or through the object's space.")
        .member<&CheckerMap::first>("first", "1", "the map of the square at the origin and every other one")
        .member<&CheckerMap::second>("second", "1", "the map of the squares between")
        .member<&CheckerMap::repeat>(
            "repeat", "1",
            "squares per unit of u and v (the third number is not used), or cubes per metre along the object's x, y and z")
        .member<&CheckerMap::space>("space", "", "uv: squares in surface coordinates; object: cubes in the object's own space",
                                    choices("uv", "object"));
  }

  void prepare() override {
    if (!first) fail("first", "a map is needed");
    if (!second) fail("second", "a map is needed");
    if (!is_finite(repeat)) fail("repeat", "must be finite numbers");
  }

  Spectrum color(const SurfacePoint& p, const Wavelengths& w, ColorUse use) const override { return at(p).color(p, w, use); }
  float scalar(const SurfacePoint& p) const override { return at(p).scalar(p); }

  Ref<ObjectMap> first = etendue::constant(0.2f), second = etendue::constant(0.8f);
  Vector3 repeat{8, 8, 8};
  Space space = Space::uv;

 private:
  const ObjectMap& at(const SurfacePoint& p) const {
    float cells = 0;
    if (space == Space::uv) {
      cells = std::floor(p.uv.x * repeat.x) + std::floor(p.uv.y * repeat.y);
    } else {
      // A surface that lies exactly between two layers of cubes would flicker by rounding: look a ten-thousandth of a
      // cube below the surface.
      for (int i = 0; i < 3; ++i) cells += std::floor(p.object_position[i] * repeat[i] - 1e-4f * p.object_normal[i]);
    }
    return std::fmod(cells, 2.0f) == 0 ? *first : *second;
  }
};

const Register<CheckerMap> registered;

}  // namespace
}  // namespace etendue
