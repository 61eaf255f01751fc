// Positions as colours.

#include "components/maps/mapping/shown_geometry.h"

namespace etendue {
namespace {

enum class Space : std::uint8_t { object, world };

class PositionMap final : public ShownGeometry {
 public:
  static void describe(Description<PositionMap>& d) {
    d.summary("The position as a colour: from 0 at one corner of a box to 1 at the other along x, y and z.")
        .member<&PositionMap::low>("low", "m", "the corner of the box where all are 0")
        .member<&PositionMap::high>("high", "m", "the corner where all are 1")
        .member<&PositionMap::space>("space", "", "whose coordinates: the object's own or those of the whole scene",
                                     choices("object", "world"));
  }

  void prepare() override {
    ShownGeometry::prepare();
    for (int i = 0; i < 3; ++i)
      if (!(std::isfinite(low[i]) && std::isfinite(high[i]) && low[i] != high[i]))
        fail("high", "must be finite and differ from `low` along each axis");
  }

  DoublePoint3 low{0, 0, 0}, high{1, 1, 1};
  Space space = Space::object;

 private:
  Vector3 shown(const SurfacePoint& p) const override {
    const DoublePoint3 at = space == Space::object ? DoublePoint3(p.object_position) : world_position(p);
    Vector3 c;
    for (int i = 0; i < 3; ++i) c[i] = fraction(float((at[i] - low[i]) / (high[i] - low[i])));
    return c;
  }
};

const Register<PositionMap> registered;

}  // namespace
}  // namespace etendue
