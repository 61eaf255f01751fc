// Turbulence.

#include "components/maps/combining/blend.h"

namespace etendue {
namespace {

class TurbulenceMap final : public FractalMap {
 public:
  static void describe(Description<TurbulenceMap>& d) {
    d.summary("Creased bumps of many sizes (Perlin's turbulence) between two maps.", noise_source);
    describe_fractal(d, "size of the largest bumps");
  }

 private:
  float fraction(const SolidPoint& p) const override { return noise().turbulence(p.at, p.width); }
};

const Register<TurbulenceMap> registered;

}  // namespace
}  // namespace etendue
