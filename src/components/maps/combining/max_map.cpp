// The greatest of maps.

#include "combination.h"

namespace etendue {
namespace {

class MaxMap final : public CombinedMap {
 public:
  MaxMap() : CombinedMap(0, 0) {}
  static void describe(Description<MaxMap>& d) {
    d.summary("The greatest of two or three maps, wavelength by wavelength.");
    describe_three(d, "the first map");
  }

 private:
  Spectrum apply(const Spectrum& a, const Spectrum& b) const override {
    return Spectrum(a.lanes() > b.lanes() ? a.lanes() : b.lanes());
  }
  float bound(float a, float b) const override { return std::max(a, b); }
};

const Register<MaxMap> registered;

}  // namespace
}  // namespace etendue
