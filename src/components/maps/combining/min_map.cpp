// The least of maps.

#include "combination.h"

namespace etendue {
namespace {

class MinMap final : public CombinedMap {
 public:
  MinMap() : CombinedMap(1, 1) {}
  static void describe(Description<MinMap>& d) {
    d.summary("The least of two or three maps, wavelength by wavelength.");
    describe_three(d, "the first map");
  }

 private:
  Spectrum apply(const Spectrum& a, const Spectrum& b) const override {
    return Spectrum(a.lanes() < b.lanes() ? a.lanes() : b.lanes());
  }
  float bound(float a, float b) const override { return std::max(a, b); }
};

const Register<MinMap> registered;

}  // namespace
}  // namespace etendue
