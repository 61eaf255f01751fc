// A mixture of two maps.

#include "blend.h"

namespace etendue {
namespace {

class MixMap final : public BlendMap {
 public:
  MixMap() : BlendMap(0, 1) {}
  static void describe(Description<MixMap>& d) {
    d.summary("A mixture of two maps (lerp), wavelength by wavelength: (1 - amount) first + amount second.")
        .member<&MixMap::first>("first", "1", "the map where the amount is 0")
        .member<&MixMap::second>("second", "1", "the map where it is 1")
        .member<&MixMap::amount>("amount", "1", "how much there is of the second, between 0 and 1; of a colour, its mean",
                                 Meaning::number);
  }

  void prepare() override {
    BlendMap::prepare();
    if (!amount) fail("amount", "a map or a number is needed");
  }

  Ref<ObjectMap> amount = etendue::constant(0.5f);

 private:
  float fraction(const SurfacePoint& p) const override {
    const float t = amount->scalar(p);
    return t > 0 ? std::min(t, 1.0f) : 0;  // NaN becomes 0
  }
};

const Register<MixMap> registered;

}  // namespace
}  // namespace etendue
