#include "etendue/tone_map.h"
#include "luminance.h"

namespace etendue {
namespace {

class NormalizeToneMap final : public ToneMap {
  float percentile = 100;

 public:
  static void describe(Description<NormalizeToneMap>& d) {
    d.summary("Divides by the largest luminance, or by a percentile of the luminances, which becomes white.")
        .group("Curve")
        .member<&NormalizeToneMap::percentile>("percentile", "1", "percentage of the pixels with light that stay below white",
                                               Range{0, 100, true}, Effect::retone, soft(50, 100));
  }

 protected:
  void map(Image& xyz) const override {
    map_luminance(xyz, white_luminance(xyz, double(percentile)), [](double x) { return x; });
  }
};

static const Register<NormalizeToneMap> registered;

}  // namespace
}  // namespace etendue
