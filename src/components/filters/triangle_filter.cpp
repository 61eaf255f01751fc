#include "etendue/filter.h"

namespace etendue {
namespace {

class TriangleFilter final : public Filter {
  float radius_pixels = 1;

 public:
  static void describe(Description<TriangleFilter>& d) {
    d.summary("Falls linearly from the centre to the radius along each axis (bilinear reconstruction at radius 1).")
        .member<&TriangleFilter::radius_pixels>("radius", "1", "where the weight reaches zero [pixels]", range(0.5, 16),
                                                soft(0.5, 4));
  }
  float weight(float x, float y) const override {
    return std::max(0.0f, radius_pixels - std::abs(x)) * std::max(0.0f, radius_pixels - std::abs(y));
  }
  float radius() const override { return radius_pixels; }
};

static const Register<TriangleFilter> registered;

}  // namespace
}  // namespace etendue
