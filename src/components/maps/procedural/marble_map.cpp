// Marble.

#include "components/maps/combining/blend.h"

namespace etendue {
namespace {

// Perlin 1985: layers of colour(sin(x)), disturbed by x + turbulence(p). A layer is ((1 + sin(2 pi x)) / 2)^s, whose mean over
// a period is Gamma(s + 1/2) / (sqrt(pi) Gamma(s + 1)). Averaging over the footprint is taken to attenuate the difference from
// this mean by the same factor as the sine (wave_remains).
class MarbleMap final : public FractalMap {
 public:
  MarbleMap() {
    first = etendue::constant(0.85f);
    second = etendue::constant(0.1f);
  }
  static void describe(Description<MarbleMap>& d) {
    d.summary("Layers across the x axis, disturbed by turbulence.", noise_source);
    describe_fractal(d, "distance between two veins")
        .group("Layers")
        .member<&MarbleMap::disturbance>("disturbance", "1", "how far turbulence moves the layers, over their distance",
                                         at_least(0), soft(0, 20))
        .member<&MarbleMap::swell>("swell", "1", "size of what moves them, over their distance", more_than(0), soft(0.1, 100),
                                   logarithmic, when("disturbance"))
        .member<&MarbleMap::sharpness>("sharpness", "1", "1: veins as wide as what is between them; larger: narrower ones",
                                       range(0.1, 100), logarithmic);
  }

  void prepare() override {
    FractalMap::prepare();
    const double s = double(sharpness);
    mean_ = float(std::exp(std::lgamma(s + 0.5) - std::lgamma(s + 1)) / std::sqrt(M_PI));
  }

  float disturbance = 5, swell = 4, sharpness = 4;

 private:
  float fraction(const SolidPoint& p) const override {
    const float remains = wave_remains(p.width);
    if (remains == 0) return mean_;
    float x = p.at.x + disturbance * noise().turbulence((1 / swell) * p.at, p.width / swell);
    x -= std::floor(x);
    return mean_ + remains * (std::pow(0.5f + 0.5f * std::sin(2 * pi * x), sharpness) - mean_);
  }

  float mean_ = 0.5f;
};

const Register<MarbleMap> registered;

}  // namespace
}  // namespace etendue
