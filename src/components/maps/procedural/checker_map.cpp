// A checkerboard of two maps.

#include "components/maps/combining/blend.h"
#include "components/maps/periodic.h"

namespace etendue {
namespace {

enum class Space : std::uint8_t { uv, object };

// The weight of `second` is (1 - s(x) s(y) s(z)) / 2 with square waves s of period 2. Its mean over a box results from the
// means of the waves over the box's sides. This is exact for a footprint along the squares; any other footprint is replaced by
// a box of the same second moments.
class CheckerMap final : public BlendMap {
 public:
  CheckerMap() : BlendMap(0.2f, 0.8f) {}
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
    BlendMap::prepare();
    if (!is_finite(repeat)) fail("repeat", "must be finite numbers");
  }

  Vector3 repeat{8, 8, 8};
  Space space = Space::uv;

 private:
  float fraction(const SurfacePoint& p) const override {
    float wave = 1;
    if (space == Space::uv) {
      const Vector2 box = uv_box(p);
      wave = square_wave_mean(p.uv.x * repeat.x, box.x * std::abs(repeat.x)) *
             square_wave_mean(p.uv.y * repeat.y, box.y * std::abs(repeat.y));
    } else {
      Footprint seen;
      if (p.footprint > 0) seen = object_footprint(p);
      // On a surface that lies exactly between two layers of cubes rounding would choose the layer at random: the point is
      // moved below the surface by a ten-thousandth of a cube.
      for (int i = 0; i < 3; ++i)
        wave *= square_wave_mean(p.object_position[i] * repeat[i] - 1e-4f * p.object_normal[i],
                                 std::hypot(seen.longer[i], seen.shorter[i]) * std::abs(repeat[i]));
    }
    return 0.5f - 0.5f * wave;
  }
};

const Register<CheckerMap> registered;

}  // namespace
}  // namespace etendue
