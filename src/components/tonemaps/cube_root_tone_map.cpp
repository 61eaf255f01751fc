#include "etendue/tone_map.h"
#include "luminance.h"

namespace etendue {
namespace {

class CubeRootToneMap final : public ToneMap {
  float percentile = 100;

 public:
  static void describe(Description<CubeRootToneMap>& d) {
    d.summary(
         "The cube root of the luminance relative to white, chromaticities kept: brings up dark places. The result is "
         "light, still to be encoded; to let the root itself stand for the encoding, set transfer to linear.")
        .group("Curve")
        .member<&CubeRootToneMap::percentile>("percentile", "1", "percentage of the pixels with light that stay below white",
                                              Range{0, 100, true}, Effect::retone, soft(50, 100));
  }

 protected:
  void map(Image& xyz) const override {
    map_luminance(xyz, white_luminance(xyz, double(percentile)), [](double x) { return std::cbrt(x); });
  }
};

static const Register<CubeRootToneMap> registered;

}  // namespace
}  // namespace etendue
