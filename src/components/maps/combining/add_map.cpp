// A sum of maps.

#include "combination.h"

namespace etendue {
namespace {

class AddMap final : public CombinedMap {
 public:
  AddMap() : CombinedMap(0, 0) {}
  static void describe(Description<AddMap>& d) {
    d.summary("The sum of two or three maps, wavelength by wavelength.");
    describe_three(d, "the first map");
  }

 private:
  Spectrum apply(const Spectrum& a, const Spectrum& b) const override { return a + b; }
  float bound(float a, float b) const override { return a + b; }
};

const Register<AddMap> registered;

}  // namespace
}  // namespace etendue
