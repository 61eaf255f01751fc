// A quotient of maps.

#include "combination.h"

namespace etendue {
namespace {

class DivideMap final : public CombinedMap {
 public:
  DivideMap() : CombinedMap(1, 1) {}
  static void describe(Description<DivideMap>& d) {
    d.summary("A map over another, wavelength by wavelength; 0 where the latter is 0.");
    describe_two(d, "what is divided; where light is asked for, it is the light", "what it is divided by");
  }

 private:
  Spectrum apply(const Spectrum& a, const Spectrum& b) const override { return safe_quotient(a, b); }
  ColorUse use_of_others(ColorUse use) const override { return use_of_factor(use); }
};

const Register<DivideMap> registered;

}  // namespace
}  // namespace etendue
