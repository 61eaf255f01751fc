// A map to a power.

#include "combination.h"

namespace etendue {
namespace {

class PowerMap final : public ObjectMap {
 public:
  static void describe(Description<PowerMap>& d) {
    d.summary("A map to a power, wavelength by wavelength; 0 where the base is negative or the power would be infinite.")
        .member<&PowerMap::base>("base", "1", "the map")
        .member<&PowerMap::exponent>("exponent", "1", "the number it is raised to; of a colour, its mean", Meaning::number);
  }

  void prepare() override {
    if (!base) fail("base", "a map is needed");
    if (!exponent) fail("exponent", "a map or a number is needed");
  }
  Spectrum color(const SurfacePoint& p, const Wavelengths& w, ColorUse use) const override {
    const float e = exponent->scalar(p);
    return as_used(map(base->color(p, w, use), [e](float x) { return safe_power(x, e); }), use);
  }
  float scalar(const SurfacePoint& p) const override { return safe_power(base->scalar(p), exponent->scalar(p)); }

  Ref<ObjectMap> base = etendue::constant(1), exponent = etendue::constant(1);
};

const Register<PowerMap> registered;

}  // namespace
}  // namespace etendue
