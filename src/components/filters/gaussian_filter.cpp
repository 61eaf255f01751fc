#include "etendue/filter.h"

namespace etendue {
namespace {

class GaussianFilter final : public Filter {
  float radius_pixels = 1.5f;
  float deviation = 0.5f;

  // The value at the radius is subtracted, so that the filter ends without a step:
  //   w(x) = exp(-x^2 / (2 s^2)) - exp(-r^2 / (2 s^2)).
  float along(float x) const {
    const float k = -0.5f / square(deviation);
    const float here = k * square(x);  // with expm1 nothing cancels where the curve is nearly flat
    return std::max(0.0f, -std::exp(here) * std::expm1(k * square(radius_pixels) - here));
  }

 public:
  static void describe(Description<GaussianFilter>& d) {
    d.summary("A normal distribution cut off at the radius, lowered so that it ends at zero.",
              "Pharr, Jakob & Humphreys, Physically Based Rendering, 3rd ed., section 7.8.1")
        .member<&GaussianFilter::radius_pixels>("radius", "1", "where the weight reaches zero [pixels]", range(0.5, 16),
                                                soft(0.5, 4))
        .member<&GaussianFilter::deviation>("deviation", "1", "standard deviation [pixels]", range(0.05, 16), soft(0.1, 2));
  }
  float weight(float x, float y) const override { return along(x) * along(y); }
  float radius() const override { return radius_pixels; }
};

static const Register<GaussianFilter> registered;

}  // namespace
}  // namespace etendue
