// Hypertexture, evaluated on a surface.

#include "components/maps/combining/blend.h"

namespace etendue {
namespace {

/// b(t) = t^(ln b / ln 1/2): keeps 0 and 1, and takes 1/2 to b (Perlin & Hoffert 1989, section 2.2).
float biased(float t, float exponent) { return t > 0 ? std::pow(t, exponent) : 0; }

// Perlin & Hoffert 1989: an object is a density D(x), 1 inside, 0 outside, falling in a soft region between, which is shaped by
// functions. Here the object is a ball whose surface is displaced along the radius by turbulence (their fractal sphere),
//   D(x) = density of the ball at x (1 + a sum_i gain^i |noise(lacunarity^i x)|),
// then bias and gain are applied to the density. The map is the density at the points of a surface: burnt or worn patches, a
// fringe of fire.
class HypertextureMap final : public FractalMap {
 public:
  HypertextureMap() { octaves = 6; }
  static void describe(Description<HypertextureMap>& d) {
    d.summary("The density of a soft ball with a turbulent border, where a surface cuts it.",
              "Perlin & Hoffert 1989, \"Hypertexture\"");
    describe_fractal(d, "size of the largest bumps of the border")
        .group("Ball")
        .member<&HypertextureMap::centre>("centre", "m", "centre of the ball")
        .member<&HypertextureMap::radius>("radius", "m", "radius where the density is a half before the border is disturbed",
                                          more_than(0), soft(0.01, 100), logarithmic)
        .member<&HypertextureMap::softness>("softness", "m", "width of the region where the density falls", more_than(0),
                                            soft(0.01, 100), logarithmic)
        .member<&HypertextureMap::disturbance>(
            "disturbance", "1", "how far turbulence moves the border inwards, over the radius", at_least(0), soft(0, 5))
        .member<&HypertextureMap::bias>("bias", "1", "what the density 1/2 becomes", range(0.01, 0.99))
        .member<&HypertextureMap::contrast>("contrast", "1", "Perlin's gain: above 1/2 the density falls faster in the middle",
                                            range(0.01, 0.99));
  }

  void prepare() override {
    FractalMap::prepare();
    if (!is_finite(centre)) fail("centre", "must be finite numbers");
    bias_ = std::log(bias) / std::log(0.5f);
    gain_ = std::log(1 - contrast) / std::log(0.5f);
  }

  Point3 centre{0, 0, 0};
  float radius = 1, softness = 0.5f, disturbance = 1, bias = 0.5f, contrast = 0.5f;

 private:
  float fraction(const SolidPoint& p) const override {
    const Vector3 from_centre = size * p.at - (centre - Point3{});
    const float r = length(from_centre) * (1 + disturbance * noise().turbulence(p.at, p.width));
    // As a filter, the soft region is made at least as wide as the footprint.
    const float t = clamp(0.5f + (radius - r) / std::max(softness, size * p.width), 0, 1), b = biased(t, bias_);
    return b < 0.5f ? 0.5f * biased(2 * b, gain_) : 1 - 0.5f * biased(2 - 2 * b, gain_);
  }

  float bias_ = 1, gain_ = 1;
};

const Register<HypertextureMap> registered;

}  // namespace
}  // namespace etendue
