// Bricks and mortar.

#include "components/maps/combining/blend.h"
#include "components/maps/periodic.h"

namespace etendue {
namespace {

// In units of a brick with half of the joint around it, row j is where floor(y) = j, and a brick is where frac(x - j shift) and
// frac(y) are both at least half a joint away from 0 and 1. The mean over a box is a sum over the rows that the box overlaps:
// for each row the mean along x, times the part of the bricks' height that lies in the box.
class BricksMap final : public BlendMap {
 public:
  BricksMap() : BlendMap(0.6f, 0.3f) {}
  static void describe(Description<BricksMap>& d) {
    d.summary("A wall of bricks over surface coordinates.")
        .member<&BricksMap::second>("brick", "1", "the map of the bricks")
        .member<&BricksMap::first>("mortar", "1", "the map between them")
        .member<&BricksMap::repeat>("repeat", "1", "bricks per unit of u, and rows per unit of v")
        .member<&BricksMap::joint>("joint", "1", "thickness of the mortar over the height of a row", range(0, 1))
        .member<&BricksMap::shift>("shift", "1", "how far a row is moved against the one below, in bricks", soft(0, 1));
  }

  void prepare() override {
    BlendMap::prepare();
    if (!(repeat.x > 0 && repeat.y > 0 && repeat.x < infinity && repeat.y < infinity))
      fail("repeat", "must be positive, finite numbers");
    if (!std::isfinite(shift)) fail("shift", "must be a finite number");
    half_y_ = 0.5f * joint;
    half_x_ = std::min(half_y_ * repeat.x / repeat.y, 0.5f);  // equal thickness along u and v if their scales are equal
  }

  Vector2 repeat{8, 24};
  float joint = 0.12f, shift = 0.5f;

 private:
  const char* first_name() const override { return "mortar"; }
  const char* second_name() const override { return "brick"; }

  float fraction(const SurfacePoint& p) const override {
    const Vector2 box = uv_box(p);
    const float x = p.uv.x * repeat.x, y = p.uv.y * repeat.y, width = box.x * repeat.x, height = box.y * repeat.y;
    if (!(std::abs(x) < 1e6f && std::abs(y) < 1e6f)) return 0;  // beyond, floats do not resolve bricks
    const auto along = [&](float row) { return pulse_mean(x - row * shift, width, half_x_, 1 - half_x_); };
    if (!(height > 1e-4f)) {
      const float row = std::floor(y), t = y - row;
      return t >= half_y_ && t <= 1 - half_y_ ? along(row) : 0;
    }
    constexpr float most_rows = 16;
    if (height > most_rows) {  // the mean of sixteen rows is taken for all
      float sum = 0;
      for (float row = 0; row < most_rows; ++row) sum += along(std::floor(y) + row);
      return sum / most_rows * (1 - joint);
    }
    const float low = y - 0.5f * height, high = y + 0.5f * height;
    float sum = 0;
    for (float row = std::floor(low); row < high; ++row) {
      const float overlap = std::min(high, row + 1 - half_y_) - std::max(low, row + half_y_);
      if (overlap > 0) sum += overlap * along(row);
    }
    return clamp(sum / height, 0, 1);
  }

  float half_x_ = 0, half_y_ = 0;
};

const Register<BricksMap> registered;

}  // namespace
}  // namespace etendue
