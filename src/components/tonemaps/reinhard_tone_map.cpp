#include "reinhard.h"

namespace etendue {
namespace {

class ReinhardToneMap final : public ExposedToneMap {
  float white = 0;

 public:
  static void describe(Description<ReinhardToneMap>& d) {
    d.summary(
         "Compresses luminance as L (1 + L / white^2) / (1 + L), which leaves dark places as they are, and keeps "
         "chromaticities; "
         "colours that the RGB space does not hold are mixed with grey of their luminance until it does.",
         "Reinhard, Stark, Shirley & Ferwerda 2002, Photographic tone reproduction for digital images, equation 4")
        .group("Curve")
        .member<&ReinhardToneMap::white>("white", "1", reinhard_white_text, range(0, 1e9), Effect::retone, soft(0.5, 1000),
                                         logarithmic);
  }

 protected:
  void develop(Image& xyz) const override {
    develop_reinhard(xyz, rgb_space(color_space), reinhard_white(xyz, white),
                     [&](size_t pixel) { return xyz.values[3 * pixel + 1]; });
  }
};

static const Register<ReinhardToneMap> registered;

}  // namespace
}  // namespace etendue
