// Fractional Brownian motion.

#include "components/maps/combining/blend.h"

namespace etendue {
namespace {

class FbmMap final : public FractalMap {
 public:
  static void describe(Description<FbmMap>& d) {
    d.summary("Random bumps of many sizes (fractional Brownian motion, clouds) between two maps.", noise_source);
    describe_fractal(d, "size of the largest bumps");
  }

 private:
  float fraction(const SolidPoint& p) const override { return 0.5f + 0.5f * noise().fbm(p.at, p.width); }
};

const Register<FbmMap> registered;

}  // namespace
}  // namespace etendue
