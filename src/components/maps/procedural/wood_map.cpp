// Wood.

#include "components/maps/combining/blend.h"
#include "components/maps/periodic.h"

namespace etendue {
namespace {

// Rings around the z axis, disturbed by noise: a year's ring begins light and darkens as frac(r)^s, whose integral is
// frac(r)^(s+1) / (s+1), so that the mean over the footprint is exact. Fibres are noise that is stretched along the axis.
class WoodMap final : public FractalMap {
 public:
  WoodMap() {
    first = etendue::constant(0.5f);
    second = etendue::constant(0.15f);
    size = 0.02f;
    octaves = 3;
  }
  static void describe(Description<WoodMap>& d) {
    d.summary("Rings around the z axis, with fibres along it.", noise_source);
    describe_fractal(d, "width of a ring")
        .group("Rings")
        .member<&WoodMap::disturbance>("disturbance", "1", "how far the rings are from round, over their width", at_least(0),
                                       soft(0, 10))
        .member<&WoodMap::swell>("swell", "1", "size of what disturbs the rings, over their width", more_than(0),
                                 soft(0.1, 100), logarithmic, when("disturbance"))
        .member<&WoodMap::sharpness>("sharpness", "1", "how late in the year the wood darkens", range(0.1, 100), logarithmic)
        .member<&WoodMap::fibre>("fibre", "1", "what part of the contrast is fibre", range(0, 1));
  }

  float disturbance = 2, swell = 10, sharpness = 3, fibre = 0.15f;

 private:
  float fraction(const SolidPoint& p) const override {
    // The noise is stretched by a factor of ten along the trunk.
    const Vector3 along{p.at.x, p.at.y, 0.1f * p.at.z};
    const float r = std::hypot(p.at.x, p.at.y) + disturbance * noise().fbm((1 / swell) * along, p.width / swell);
    const float ring = periodic_mean(
        r, p.width, 1 / (sharpness + 1), [this](float t) { return std::pow(t, sharpness); },
        [this](float t) { return std::pow(t, sharpness + 1) / (sharpness + 1); });
    if (!(fibre > 0)) return ring;
    constexpr float finer = 12;  // fibres per width of a ring
    const float remains = noise_remains(finer * p.width);
    const float grain = remains > 0 ? remains * perlin_noise(finer * Vector3{p.at.x, p.at.y, 0.03f * p.at.z}, seed + 1) : 0;
    return (1 - fibre) * ring + fibre * (0.5f + 0.5f * grain);
  }
};

const Register<WoodMap> registered;

}  // namespace
}  // namespace etendue
