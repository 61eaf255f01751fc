// A difference of maps.

#include "combination.h"

namespace etendue {
namespace {

class SubtractMap final : public CombinedMap {
 public:
  SubtractMap() : CombinedMap(0, 0) {}
  static void describe(Description<SubtractMap>& d) {
    d.summary("A map less another, wavelength by wavelength; as a colour never below 0.");
    describe_two(d, "what is subtracted from", "what is subtracted");
  }

 private:
  Spectrum apply(const Spectrum& a, const Spectrum& b) const override { return a - b; }
  float bound(float a, float b) const override { return a + b; }
};

const Register<SubtractMap> registered;

}  // namespace
}  // namespace etendue
