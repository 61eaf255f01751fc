#include "etendue/filter.h"

namespace etendue {
namespace {

class MitchellFilter final : public Filter {
  float radius_pixels = 2;
  float b = 1.0f / 3;
  float c = 1.0f / 3;

  // Mitchell & Netravali 1988, equation 8: a family of piecewise cubics with support |x| < 2. At radius 2 the weights
  // of all pixels a sample reaches add up to one wherever the sample lies.
  float along(float offset) const {
    const float x = std::abs(offset) * (2 / radius_pixels);
    if (x >= 2) return 0;
    if (x < 1) return ((12 - 9 * b - 6 * c) * x * x * x + (-18 + 12 * b + 6 * c) * x * x + (6 - 2 * b)) / 6;
    return ((-b - 6 * c) * x * x * x + (6 * b + 30 * c) * x * x + (-12 * b - 48 * c) * x + (8 * b + 24 * c)) / 6;
  }

 public:
  static void describe(Description<MitchellFilter>& d) {
    d.summary("Piecewise cubic with small negative lobes, balanced between blur and ringing.",
              "Mitchell & Netravali 1988, Reconstruction filters in computer graphics, eq. 8")
        .member<&MitchellFilter::radius_pixels>("radius", "1", "half the width of the support [pixels]", range(0.5, 16),
                                                soft(1, 4))
        .member<&MitchellFilter::b>("b", "1", "blur: 1 with c = 0 is the cubic B-spline", range(0, 1))
        .member<&MitchellFilter::c>("c", "1", "ringing: 0.5 with b = 0 is the Catmull-Rom spline", range(0, 1));
  }
  float weight(float x, float y) const override { return along(x) * along(y); }
  float radius() const override { return radius_pixels; }
};

static const Register<MitchellFilter> registered;

}  // namespace
}  // namespace etendue
