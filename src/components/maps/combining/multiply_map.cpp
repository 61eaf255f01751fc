// A product of maps.

#include "combination.h"

namespace etendue {
namespace {

class MultiplyMap final : public CombinedMap {
 public:
  MultiplyMap() : CombinedMap(1, 1) {}
  static void describe(Description<MultiplyMap>& d) {
    d.summary("The product of two or three maps, wavelength by wavelength.");
    describe_three(d, "the first map; where light is asked for, it is the light and the others are factors");
  }

 private:
  Spectrum apply(const Spectrum& a, const Spectrum& b) const override { return a * b; }
  ColorUse use_of_others(ColorUse use) const override { return use_of_factor(use); }
  float bound(float a, float b) const override { return a > 0 && b > 0 ? a * b : 0; }
};

const Register<MultiplyMap> registered;

}  // namespace
}  // namespace etendue
