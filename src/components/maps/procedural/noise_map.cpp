// Perlin noise.

#include "components/maps/combining/blend.h"

namespace etendue {
namespace {

class NoiseMap final : public SolidMap {
 public:
  static void describe(Description<NoiseMap>& d) {
    d.summary("Smooth random bumps of one size between two maps.", noise_source);
    describe_solid(d, "size of the bumps");
  }

 private:
  float fraction(const SolidPoint& p) const override {
    const float remains = noise_remains(p.width);
    return remains > 0 ? 0.5f + 0.5f * remains * perlin_noise(p.at, seed) : 0.5f;
  }
};

const Register<NoiseMap> registered;

}  // namespace
}  // namespace etendue
