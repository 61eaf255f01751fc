#include "etendue/filter.h"

namespace etendue {
namespace {

class BoxFilter final : public Filter {
  float radius_pixels = 0.5f;

 public:
  static void describe(Description<BoxFilter>& d) {
    d.summary("All samples closer than the radius count alike; at the default radius each counts for its own pixel alone.")
        .member<&BoxFilter::radius_pixels>("radius", "1", "half the width of the square [pixels]", range(0.5, 16),
                                           soft(0.5, 4));
  }
  float weight(float x, float y) const override {
    return std::abs(x) <= radius_pixels && std::abs(y) <= radius_pixels ? 1.0f : 0.0f;
  }
  float radius() const override { return radius_pixels; }
};

static const Register<BoxFilter> registered;

}  // namespace
}  // namespace etendue
