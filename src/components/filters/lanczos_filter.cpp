#include "etendue/filter.h"

namespace etendue {
namespace {

class LanczosFilter final : public Filter {
  float radius_pixels = 3;

  static float sinc(float x) {
    const float a = pi * x;
    return std::abs(a) < 1e-3f ? 1 - square(a) / 6 : std::sin(a) / a;
  }
  // The ideal low-pass filter sinc(x) = sin(pi x) / (pi x) times the main lobe of a wider one: sinc(x) sinc(x / r).
  float along(float x) const { return std::abs(x) >= radius_pixels ? 0 : sinc(x) * sinc(x / radius_pixels); }

 public:
  static void describe(Description<LanczosFilter>& d) {
    d.summary("The sinc function windowed by the main lobe of a wider one: sharp, with negative lobes.",
              "Duchon 1979, Lanczos filtering in one and two dimensions")
        .member<&LanczosFilter::radius_pixels>("radius", "1", "number of lobes to each side [pixels]", range(1, 16),
                                               soft(1, 4));
  }
  float weight(float x, float y) const override { return along(x) * along(y); }
  float radius() const override { return radius_pixels; }
};

static const Register<LanczosFilter> registered;

}  // namespace
}  // namespace etendue
