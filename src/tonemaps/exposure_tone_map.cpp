#include "etendue/tone_map.h"

namespace etendue {
namespace {

class ExposureToneMap final : public ToneMap {
  float stops = 0;

 public:
  static void describe(Description<ExposureToneMap>& d) {
    d.summary("Multiplies by a power of two, as a camera's exposure does; what exceeds white is clipped.")
        .member<&ExposureToneMap::stops>("stops", "1", "each doubles the light; at 0, luminance 1 is white", range(-64, 64),
                                         Effect::retone);
  }

 protected:
  void map(Image& xyz) const override {
    const double scale = std::exp2(double(stops));
    for (double& v : xyz.values) v *= scale;
  }
};

static const Register<ExposureToneMap> registered;

}  // namespace
}  // namespace etendue
